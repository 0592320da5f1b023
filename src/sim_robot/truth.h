#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/simulation/floor_places.h"
#include "hires/simulation/self_localisation.h"

namespace hires::sim_robot {

/// Two quantities that come together: the filling that makes a mill heavy makes it stand lower.
struct Correlation {
  std::string first, second;
  double coefficient{0.0};  ///< of their normal scores, -1 .. 1
};

/// Somebody bumps into the base now and then.
struct Bumps {
  double mean_interval{0.0};                     ///< [s] between two; 0: nobody does
  double least_speed{0.0}, greatest_speed{0.0};  ///< [m/s] that it gives a base on free wheels
  double duration{0.25};                         ///< [s]
};

/// Furniture that does not stand where the map says.
struct MovedBody {
  std::string body;    ///< of the world's static bodies
  geometry::Pose2 by;  ///< in the map, about the body's own origin
  double probability{1.0};
};

/// The error of localisation goes to and fro.
struct LocalisationWalk {
  double sd{0.0};      ///< [m] of x and of y
  double sd_yaw{0.0};  ///< [rad]
  double time{10.0};   ///< [s] after which 1/e of an error is left
};

/// How laser, camera and encoders err, and what tells which objects are seen.
enum class Sensing {
  kFitted,   ///< they err as drawn, the detector as its recogniser was found to
  kIdeal,    ///< they do not err
  kPictures  ///< they err as drawn, and objects are recognised in the camera's clouds
};

/// What tells the robot where it is.
enum class Localisation {
  kFitted,  ///< the truth, off as imagination has it (`localisation` of the scene)
  kIdeal,   ///< the truth
  kFilter,  ///< itself, by its wheels, inertial unit and laser
  kNothing  ///< nothing: it hands on what these measure, and others find its place
};

/// What a recogniser does wrong beside its noise. With `pictures` the recogniser is real and misses
/// what it misses; `bias` and `bias_yaw` are how the camera sits otherwise than the robot believes.
struct Recogniser {
  double bias{0.0};      ///< [m] sd, along x and y of each object, the same at every look
  double bias_yaw{0.0};  ///< [rad] likewise
  double missed{0.0};    ///< share of looks at which a visible object is not recognised
};

/// What robot and world are really like where a robot is played that tests imagination. Imagination
/// is told nothing of it. As it is made, it is `same`: imagination's own model, which tests that
/// all parts work together, and nothing else.
struct Truth {
  std::string name{"same"};  ///< as results name it

  /// The base's controller, where it is another than in the robot's profile.
  std::optional<bool> stops_at_timeout;
  std::map<std::string, double> controller;  ///< keys as in the profile's base_controller

  /// What all hidden quantities are drawn from; null: what imagination draws from.
  /// It lies over that, as far as it goes (imagination::LaidOver).
  std::shared_ptr<const imagination::Uncertainty> uncertainty;
  /// Quantities that are drawn from something else than `uncertainty` says.
  std::map<std::string, imagination::Distribution> changes;
  std::vector<Correlation> correlations;
  Sensing sensing{Sensing::kFitted};
  Localisation localisation{Localisation::kFitted};
  /// With kFilter and kNothing: how these err; null with the others.
  std::shared_ptr<const simulation::SelfLocalisationParams> self_localisation;

  // What imagination does not model at all.
  simulation::FloorPlaces floor;
  Bumps bumps;
  std::vector<MovedBody> moved;
  LocalisationWalk walk;
  Recogniser recogniser;
};

/// The file of a truth. @param name  of a file in `folder`, without .yaml; or a path. Empty: same.
/// @throws base::ConfigError for an unknown name, with names like it.
std::string TruthPath(const std::string& name, const std::string& folder);

/// Reads a file like config/truths/same.yaml; it is called as the file is, without .yaml.
/// @throws base::ConfigError naming file and key.
Truth ReadTruth(const std::string& path);

/// The truth of that name, or of a file of one's own: that is called by its path and a hash of its
/// text, whatever the file's name, so that nothing that was measured under it passes for another.
/// @param name, folder  as TruthPath.  @throws base::ConfigError as TruthPath and ReadTruth.
Truth FindTruth(const std::string& name, const std::string& folder);

/// Another way of sensing than the truth's own; its name says so. Empty: as it is.
/// @throws base::ConfigError for none of fitted, ideal, pictures.
Truth WithSensing(Truth truth, const std::string& sensing);

/// The same truth of a robot that does not find its place, but hands on what its wheels and its
/// inertial unit measure.
/// @param path  of a file like config/self_localisation.yaml: how they err, unless the truth says.
/// @throws base::ConfigError as simulation::LoadSelfLocalisation.
Truth WithoutPlace(Truth truth, const std::string& path);

/// `same: imagination's own model`, or the name: to stand beside whatever was measured with it.
std::string TruthNote(const std::string& name);

/// What a robot is played in under this truth: controller, distributions, floor and furniture.
/// @param imagined  what imagination has; it stays as it is.
/// @param X_MB  where the robot begins; no furniture is put within a metre of it.
/// @param rng  tells which furniture was moved.
/// @throws base::ConfigError for a static body that this world does not have, with names like it.
imagination::ImaginationSetup SetupOf(const Truth& truth,
                                      const imagination::ImaginationSetup& imagined,
                                      const geometry::Pose2& X_MB, const base::Rng& rng);

/// Draws all hidden quantities, correlated ones together.
/// @param uncertainty  of SetupOf.
simulation::Variation DrawVariation(const Truth& truth, const imagination::Uncertainty& uncertainty,
                                    const base::Rng& rng);

}  // namespace hires::sim_robot
