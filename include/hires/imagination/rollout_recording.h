#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/imagination/evidence.h"
#include "hires/imagination/rollout.h"

namespace hires::imagination {

/// How everything is at one moment of a rollout.
struct RolloutSample {
  double time{0.0};      ///< [s] since the action began
  geometry::Pose3 X_MB;  ///< leaning and floor included
  geometry::Twist2 V_B;  ///< of the base, in its frame
  geometry::Twist2 A_B;  ///< its derivative [m/s^2], [rad/s^2]
  robot::JointPositions joints;
  std::vector<geometry::Pose3> X_MO;  ///< of each object
};

struct RolloutEvent {
  enum class Kind {
    kLateCycle,  ///< a control cycle comes late
    kTimedOut,   ///< no command came in time: the base brakes by itself
    kTips,       ///< something begins to lean, and then leans over 10 times shaking_tilt
    kLiftsOff,   ///< nothing touches it any more
    kFalls,      ///< as the world::StandingCriterion says
    kContact,    ///< the robot touches what it should not
    kStall,      ///< from here on it comes no further
    kEnd         ///< the action ended
  };
  Kind kind{Kind::kEnd};
  double time{0.0};  ///< [s] since the action began
  std::string text;  ///< for people: "peppermill1 lifts off"
};

/// One rollout to look at. It goes on for up to 3 s after the action, so that one sees how what
/// falls comes to lie; its result counts nothing of that.
struct RolloutRecording {
  base::ActionCall action;
  int index{0};
  std::uint64_t seed{0};
  std::vector<std::string> objects;    ///< their names, in the order of the samples' poses
  std::vector<RolloutSample> samples;  ///< every RolloutParams::sample_period, from the first on
  std::vector<RolloutEvent> events;    ///< in the order of time
  RolloutResult result;
};

/// Sees a rollout while it is recorded.
class RolloutWatcher {
 public:
  virtual ~RolloutWatcher() = default;
  virtual void OnBegin() = 0;  ///< it begins, perhaps once more: what came so far does not count
  virtual void OnSample(const simulation::RobotSimulator& simulator) = 0;  ///< of each sample
};

/// Writes a rollout to a file once it has been recorded.
class RolloutSaver : public RolloutWatcher {
 public:
  /// All or nothing.  @throws base::ConfigError if the file cannot be written.
  virtual void Save(const RolloutRecording& recording) = 0;
};

/// Plays one rollout again from its seed, and notes what happens. Nothing if it was cancelled.
/// @param watcher  may be null.
/// @pre as PlayRollout.
std::optional<RolloutRecording> RecordRollout(const RolloutSetup& setup,
                                              const base::ActionCall& action, int index,
                                              const std::function<bool()>& cancelled,
                                              RolloutWatcher* watcher = nullptr);

/// Whether the evidence has an entry like this rollout: its failure among the failures, or its
/// duration, to the last bit, among the durations.
bool IsAmong(const Evidence& evidence, const RolloutResult& result);

/// [m/s^3] of the base in the plane, since the sample before; 0 at the first.
double JerkAt(const std::vector<RolloutSample>& samples, std::size_t i);

/// A table for plotting, with units in its head: a line per sample with time, base pose, velocity,
/// acceleration and jerk of the base, for each object position and tilt, and what happened since
/// the line before.
std::string ToCsv(const RolloutRecording& recording);

}  // namespace hires::imagination
