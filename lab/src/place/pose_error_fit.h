#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "hires/base/rng.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/place/place_moment.h"
#include "hires/simulation/pose_error.h"

namespace hires::lab {

/// How the place errs at which a robot takes itself to be that finds it by itself, from drives of
/// simulated robots, to be played quickly (simulation::PoseErrorWalk).
struct PoseErrorOrder {
  ExperimentConfig drives;  ///< of kind legs, with `self_localisation`; its seed is the first
  int series{4};            ///< of legs that the fit is made from, each of one seed more
  int held_out{4};          ///< more of them, to try the fit on
};

/// What errors of some drives are like.
struct PoseErrorFigures {
  double median{0.0}, most{0.0}, largest{0.0};  ///< [m] of the position; `most`: 95 %
  double rms{0.0};                              ///< [m]
  double rms_yaw{0.0};                          ///< [rad]
  double jump{0.0};                             ///< [m] rms by which a correction moves the robot
  double alike_after_1m{0.0}, alike_after_4m{0.0};  ///< correlation of positions' errors
};

struct PoseErrorReport {
  std::string drives;     ///< name of the experiment
  std::uint64_t seed{0};  ///< of the first series
  int series{0}, held_out{0};
  int num_legs{0}, num_corrections{0};  ///< of the fit
  simulation::PoseErrorFile fit;
  PoseErrorFigures found, played;  ///< of the held-out drives: the filter's, the fit's along them
};

/// How often the laser corrected.
int NumCorrections(const std::vector<PlaceTrail>& trails);

/// @param update_distance, update_turn  as the filter's.
/// @throws base::ConfigError for fewer than 100 corrections, or errors that do not fade.
simulation::PoseErrorParams FitPoseError(const std::vector<PlaceTrail>& trails,
                                         double update_distance, double update_turn);

/// Errors that the fit has along the same true ways, each from the error that the trail has at
/// first.
std::vector<PlaceTrail> PlayPoseError(const simulation::PoseErrorParams& params,
                                      const std::vector<PlaceTrail>& trails, const base::Rng& rng);

/// @pre there are moments
PoseErrorFigures FiguresOf(const std::vector<PlaceTrail>& trails);

/// The same bits for any number of threads.
/// @return nothing when it was cancelled.  @throws base::ConfigError for an experiment of another
/// kind or whose robot is told its place, and as FitPoseError.
std::optional<PoseErrorReport> FitPoseError(const PoseErrorOrder& order, const base::Crew& crew);

std::string ReportText(const PoseErrorReport& report);
nlohmann::ordered_json ToJson(const PoseErrorReport& report);
/// A file like config/localisation_error.yaml, with a head that says where it comes from.
std::string ToYaml(const PoseErrorReport& report);

}  // namespace hires::lab
