#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reports/experience/topple_monitor.h"
#include "lab/src/experiment/places.h"
#include "lab/src/experiment/stage.h"

namespace hires::lab {

/// One drive of a chain of drives.
struct Leg {
  std::string from, to;
  geometry::Pose2 X_MStart;  ///< where the robot really stood
  imagination::RolloutResult result;
  std::string touched;    ///< "part / obstacle" where the robot touched something, or empty
  double distance{0.0};   ///< [m] from the goal, where it really stands in the end
  double yaw_error{0.0};  ///< [rad] the same, not negative
  double clearance{0.0};  ///< [m] the smallest to anything, at most kFarClearance; at 20 Hz
  PlaceTrail places;      ///< at 20 Hz, where the robot finds its place by itself
  imagination::OutcomeCounts counts_10hz;  ///< every other sample
  std::vector<reports::ToppleSample> samples;       ///< at 20 Hz, where wanted; of the chain's own time
  bool was_put_back{false};   ///< afterwards something carried was put back to its place
  bool was_restarted{false};  ///< afterwards the robot was put to the goal, as it could not go on
};

constexpr double kFarClearance = 1.0;  // [m] what is farther away does not matter

/// A robot that drives one leg after the other: each starts where the last one really ended, with
/// the load where it really stands (upright and at rest: it settles before each leg). What lies or
/// has slid away is put back to its place between two legs. A robot that stands in an obstacle is
/// put to the goal of its leg.
class Chain {
 public:
  struct Options {
    std::string motion_set;
    std::uint64_t seed{0};
    bool put_back{false};   ///< also during a leg
    bool one_truth{false};  ///< the same truth for all legs
    bool record{false};     ///< samples of what the first thing on the tray goes through are kept
  };
  Chain(std::shared_ptr<const Stage> stage, const std::string& start, const Options& options);

  /// The next leg; nothing when cancelled.  @throws base::ConfigError for an unknown goal.
  std::optional<Leg> Drive(const std::string& goal, const std::function<bool()>& cancelled);

 private:
  std::optional<imagination::RolloutResult> Play(const std::string& goal, Leg* leg,
                                                 const std::function<bool()>& cancelled);
  void Record(const simulation::RobotSimulator& simulator, Leg* leg) const;
  void Measure(const std::string& goal, Leg* leg) const;
  void GoOn(const std::string& goal, Leg* leg);
  bool SettleLoad(const world::WorldState& final_world, const geometry::Pose2& X_MB);

  std::shared_ptr<const Stage> stage_;
  Options options_;
  imagination::RolloutSetup setup_;  // where the next leg starts
  std::vector<geometry::Pose3> X_BO_nominal_;
  std::vector<std::string> down_;  // at the end of the last leg
  std::string at_;
  int next_index_{0};
  double time_{0.0};  // [s] at the end of the last leg
};

}  // namespace hires::lab
