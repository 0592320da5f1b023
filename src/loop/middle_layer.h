#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "hires/control/action_runner.h"
#include "hires/sensing/ground_watch.h"
#include "hires/sensing/observation_maker.h"
#include "hires/sensing/scan_obstacles.h"
#include "hires/simulation/laser_scanner.h"
#include "hires/world/world.h"
#include "loop/robot_senses.h"

namespace hires::loop {

/// The middle layer in one process with its robot: skills look at every tick, and what they want is
/// there before the next one. Skills think on threads of their own; the world waits for all of
/// them, so that the same looks give the same commands.
class MiddleLayer {
 public:
  struct Hooks {
    std::function<void(const robot::Command&)> send;
    /// @param activity  as given to Start.
    std::function<void(int activity, control::ActionEnd, const base::Failure&)> ended;
  };

  /// @pre `setup` outlives this.
  MiddleLayer(const imagination::ImaginationSetup& setup, const sensing::FrameNames& frames,
              const control::RunnerParams& runner, const sensing::ScanParams& scan, Hooks hooks);

  /// An action that cannot begin ends at once.
  void Start(int activity, const base::ActionCall& action, double time_limit);
  /// Why the action makes no sense to this robot in this world; nothing where it does.
  base::Failure Refusal(const base::ActionCall& action) const;
  void Cancel(int activity);
  void CancelAll() { runner_.CancelAll(); }
  void FailAll(const base::Failure& failure) { runner_.FailAll(failure); }

  void Hear(const SensorNews& news, const simulation::LaserParams& laser);
  /// What the tracker remembers of objects, as of `stamp`.
  void OnKnownObjects(double stamp, world::WorldState known);
  /// Lets skills look at the moment of the last tick that was heard of.
  void Look(double stamp);

  bool is_idle() const { return runner_.is_idle(); }
  const std::map<int, base::ActionCall>& running() const { return running_; }  ///< by activity

 private:
  struct Known {
    double stamp;  // [s]
    world::WorldState objects;
  };
  robot::Observation ObservationOf(const sensing::RobotEstimate& now);
  void AwaitSkills();

  const imagination::ImaginationSetup& setup_;
  const Hooks hooks_;
  RobotSenses senses_;
  sensing::ObservationMaker observations_;
  std::optional<sensing::GroundWatch> ground_;
  std::optional<Known> known_;  // not taken into account yet
  double looked_;               // [s]
  std::map<int, base::ActionCall> running_;

  std::mutex mutex_;
  std::condition_variable woken_;
  int num_answers_{0};            // guarded: of skills, to be collected
  control::ActionRunner runner_;  // last: its threads end first
};

}  // namespace hires::loop
