#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "hires/base/param_reader.h"
#include "hires/navigation/base_guard.h"
#include "lab/src/experiment/report.h"

// How a loaded base comes to a stand, and what becomes of the load: along the guard's ramp, at the
// limit of the base's controller, harder, by its time-out, at once.
namespace hires::lab {

/// [m/s], [rad/s] of a base that stands.
inline constexpr double kStandingSpeed = 0.01;

struct ExperimentConfig;
struct ExperimentOverrides;
struct Stage;

/// How the base stops.
struct BrakingWay {
  enum class Kind {
    kRamp,      ///< led by navigation::BaseGuard, with limits for the load
    kConstant,  ///< velocity zero is commanded; the controller brakes at its limit
    kSilence,   ///< nothing is commanded any more; the controller stops at once at its time-out,
                ///< whatever the robot's profile says of it
    kAtOnce     ///< the wheels lock: from full speed to none within a step of physics
  };
  Kind kind{Kind::kRamp};
  double deceleration{0.0};  ///< [m/s^2] of kConstant; 0: the robot's own
  std::string name;          ///< as in the file: "ramp", "controller", "silence", "5" ...
};

/// What the base does before it stops.
struct BrakingMotion {
  double linear{0.0};   ///< [m/s]
  double angular{0.0};  ///< [rad/s]
};

/// Loads one at a time, motions and ways in all combinations, the same truths for all.
struct BrakingConfig {
  int rollouts{200};               ///< of each combination
  std::vector<std::string> loads;  ///< names of the catalogue
  std::vector<BrakingMotion> motions;
  std::vector<BrakingWay> ways;
  double run_up{0.5};  ///< [m/s^2] gentle: nothing shakes when the stop begins
  double cruise{1.0};  ///< [s] at full speed
  navigation::BaseGuardParams guard;
};

/// @param path  of the experiment, from which the guard's file is counted.
/// @throws base::ConfigError naming file and key.
BrakingConfig ReadBraking(base::ParamReader* in, const std::string& path,
                          const ExperimentOverrides& overrides);

/// One combination.
struct BrakingCell {
  std::string load;
  BrakingMotion motion;
  BrakingWay way;
  navigation::StandingLoad standing;  ///< the load, as its model says
  navigation::BrakingLimits limits;   ///< of the guard's ramp
  double deceleration{0.0};           ///< [m/s^2] largest of the wheels' target; infinite at once
  double stated_distance{0.0};        ///< [m] by the closed form, lags included
  double stated_time{0.0};            ///< [s] likewise
  bool is_comparable{false};          ///< closed forms speak of it: straight, constant, at once
  bool is_predicted_to_tip{false};    ///< ... an edge lifts
  bool is_predicted_to_fall{false};   ///< ... and does not come down again
};

/// What one stop did.
struct BrakingStop {
  bool fell{false};         ///< as simulation::FallWatch says, from the stop's beginning on
  double max_tilt{0.0};     ///< [rad] of the load, from the stop's beginning on
  double tilt_before{0.0};  ///< [rad] largest while driving
  double slide{0.0};        ///< [m] of the load on the tray
  double distance{0.0};     ///< [m] of the base, from the trigger to the stand
  double time{0.0};         ///< [s] likewise, until it is slower than kStandingSpeed
  double simulated{0.0};    ///< [s]
};

/// All stops of a cell; `ideal` has a base that follows exactly, a load that is exactly nominal and
/// does not slip: what closed forms speak of.
struct BrakingPlay {
  BrakingCell cell;
  std::vector<BrakingStop> stops;
  std::optional<BrakingStop> ideal;
};

/// The robot's controller as a way needs it. Motors that brake harder than a base on casters can
/// are those of one that has none.
robot::BaseControllerParams ControllerFor(robot::BaseControllerParams controller,
                                          const BrakingWay& way);

/// Cells without what is played.
/// @throws base::ConfigError for an unknown load, or one that cannot stand.
std::vector<BrakingPlay> BrakingCells(const BrakingConfig& braking, const Stage& stage);

/// @return nothing when cancelled.
std::optional<std::vector<BrakingPlay>> PlayBraking(const BrakingConfig& braking,
                                                    const ExperimentConfig& config,
                                                    const Stage& stage, const base::Crew& crew);
Findings SumUpBraking(const BrakingConfig& braking, const std::vector<BrakingPlay>& plays);

}  // namespace hires::lab
