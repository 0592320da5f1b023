#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "hires/control/world_tracker.h"
#include "hires/perception/warm_objects.h"
#include "hires/skills/action_set.h"
#include "hires/world/world.h"
#include "loop/blackboard.h"
#include "loop/robot_senses.h"
#include "loop/virtual_clock.h"

namespace hires::loop {

/// How what is observed becomes what the Blackboard says.
struct TrackerParams {
  control::SweepParams sweep;
  perception::WarmParams warm;
  translation::ChangeParams changes;
  sensing::FloorWatchParams floor;
  double write_period{0.05};  ///< [s] between two writes
};

/// The world tracker in one process with its robot and its Blackboard.
class Tracker {
 public:
  struct Hooks {
    std::function<void(double stamp, world::WorldState known)> known;
    std::function<void(const robot::JointTrajectory&)> turn;  ///< the head
    std::function<void(double time)> observed_until;          ///< what was written
  };

  /// @pre setup, context, clock and blackboard outlive this.
  Tracker(const imagination::ImaginationSetup& setup, const translation::TranslatorContext& context,
          const sensing::FrameNames& frames, const TrackerParams& params, VirtualClock* clock,
          Blackboard* blackboard, Hooks hooks);

  /// @param laser  that the scan is of.
  void Hear(const SensorNews& news, const simulation::LaserParams& laser);
  void See(double stamp, const perception::Sighting& seen);
  /// Measures what is known in the picture of a thermal camera.
  void See(const perception::HeatView& heat);
  void OnView() { is_view_new_ = true; }  ///< the Blackboard says something else
  /// What runs now: the head is others' while one of them may use it.
  void OnActions(const std::map<int, base::ActionCall>& running);
  void SetEpisode(std::int64_t episode) { episode_ = episode; }

 private:
  void Post(double time, translation::ObservedWorld observed);
  void Write();

  const translation::TranslatorContext& context_;
  const actions::Catalogue& actions_;
  const TrackerParams params_;
  VirtualClock& clock_;
  Blackboard& blackboard_;
  const Hooks hooks_;
  const std::shared_ptr<const perception::Surroundings> surroundings_;
  RobotSenses senses_;
  std::optional<sensing::FloorWatch> floor_;  // of a robot with a laser, or clouds of the floor
  control::WorldTracker tracker_;
  world::WorldState known_;  // as it was told last
  bool is_view_new_{true};
  std::int64_t episode_{0};

  struct Posted {
    double time;  // [s]
    translation::ObservedWorld observed;
  };
  std::optional<Posted> posted_;  // and not written yet
  bool is_write_due_{false};      // the clock has been asked
  double written_{-1e9};          // [s] when
};

}  // namespace hires::loop
