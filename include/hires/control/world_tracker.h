#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/actions/catalogue.h"
#include "hires/control/head_sweep.h"
#include "hires/knowledge/sparql.h"
#include "hires/sensing/floor_watch.h"
#include "hires/sensing/object_estimator.h"
#include "hires/sensing/robot_state_estimator.h"
#include "hires/translation/observed_fluents.h"

namespace hires::control {

/// Objects that are known, for those who ask where all of them are.
world::WorldState WorldOf(const std::vector<robot::SeenObject>& known);

/// Follows what the robot's sensors say, moment by moment: remembers objects, tells what is known
/// of them, turns the head to what the task is about, and says what was observed. Moments are those
/// of joint states and looks, in order, each once nothing can change any more what is known of it.
class WorldTracker {
 public:
  struct Hooks {
    /// Objects that are known: with each look, and every 0.1 s between.
    std::function<void(const sensing::RobotEstimate&, const std::vector<robot::SeenObject>&)> known;
    std::function<void(const robot::JointTrajectory&)> turn;  ///< the head
    std::function<void(double time, translation::ObservedWorld)> observed;
    std::function<void(const std::string&)> warn;  ///< of a look that was dropped
    std::function<void()> before_update{};  ///< of a moment whose state is known; may be empty
  };

  /// @param lockstep  tells of known objects with looks alone, so that a node that waits for them
  ///                  after each look sees the same however messages interleave.
  /// @param floor  what stands on the floor; null: nobody watches it.
  /// @pre `state`, `objects` and `floor` outlive this.
  WorldTracker(const sensing::RobotStateEstimator* state, sensing::ObjectEstimator* objects,
               sensing::FloorWatch* floor, HeadSweep sweep, bool lockstep, Hooks hooks);

  /// All moments that have become known; after each message.
  void Process();

  /// What others say of objects now, and which places tasks are about.
  /// @param context  without what the fluents say of areas.
  /// @return what could not be believed, and why.
  std::vector<std::string> OnView(const translation::TranslatorContext& context,
                                  const knowledge::FluentView& fluents);
  /// What a thermal camera says of objects, in degrees Celsius; holds until something newer comes.
  /// Objects that are only said to be somewhere are left out: what is warm there may be another.
  void OnTemperatures(const std::map<std::string, double>& degrees);
  /// What runs now: the head is others' while one of these actions may use it.
  void OnActions(const actions::Catalogue& catalogue, const std::vector<std::string>& names);

  const HeadSweep& sweep() const { return sweep_; }
  double time() const { return time_; }            ///< [s] of the last moment
  sensing::Missing lack() const { return lack_; }  ///< at the last moment
  std::uint64_t num_moments() const { return num_moments_; }
  std::uint64_t num_looks() const { return num_looks_; }
  std::uint64_t num_dropped() const { return num_dropped_; }  ///< moments

 private:
  std::optional<double> NextMoment() const;
  void Handle(double time);
  bool StandsOnFloor(const std::string& name) const;
  bool IsHearsay(const std::string& name) const;
  std::vector<robot::SeenObject> Known(const sensing::RobotEstimate& now) const;
  translation::ObservedWorld Observed(const sensing::RobotEstimate& now,
                                      const std::vector<robot::SeenObject>& known) const;

  const sensing::RobotStateEstimator& state_;
  sensing::ObjectEstimator& objects_;
  sensing::FloorWatch* const floor_;
  HeadSweep sweep_;
  const bool lockstep_;
  const Hooks hooks_;
  double time_;                                 // [s] of the last moment
  double published_;                            // [s] when known objects were told of
  std::map<std::string, double> temperatures_;  // [degrees Celsius] by object
  int restarts_{0};                             // of the clock
  sensing::Missing lack_{sensing::Missing::kNothing};
  std::uint64_t num_moments_{0}, num_looks_{0}, num_dropped_{0};
};

}  // namespace hires::control
