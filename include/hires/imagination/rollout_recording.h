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
  double time{0.0};      ///< [s] since the robot was put there; the action begins after settling
  geometry::Pose3 X_MB;  ///< leaning and floor included
  geometry::Twist2 V_B;  ///< of the base, in its frame
  geometry::Twist2 A_B;  ///< its derivative [m/s^2], [rad/s^2]
  robot::JointPositions joints;
  std::vector<geometry::Pose3> X_MO;  ///< of each object
};

struct RolloutEvent {
  double time{0.0};  ///< [s] as of samples
  std::string text;  ///< "peppermill1 leans by more than 0.01 rad"
};

/// One rollout to look at.
struct RolloutRecording {
  base::ActionCall action;
  int index{0};
  std::uint64_t seed{0};
  std::vector<std::string> objects;    ///< their names, in the order of the samples' poses
  std::vector<RolloutSample> samples;  ///< 20 Hz
  std::vector<RolloutEvent> events;    ///< in the order of time
  RolloutResult result;
};

/// Sees a rollout while it is recorded, and then the recording.
class RolloutWatcher {
 public:
  virtual ~RolloutWatcher() = default;
  /// 20 times a simulated second. A time that does not increase: it begins again, and what came so
  /// far does not count.
  virtual void OnSample(const simulation::RobotSimulator& simulator) = 0;
  virtual void OnEnd(const RolloutRecording& recording) = 0;
};

/// Which rollout of which alternative.
struct RolloutChoice {
  enum class Kind { kWorst, kMedian, kFirstFailed, kIndex };
  Kind kind{Kind::kWorst};
  int index{0};  ///< kIndex
  int rank{1};   ///< of the alternative in the ranking, from 1
};

/// "worst", "median", "first_fall" (the first that is no success) or a number from 0; of the first
/// alternative of the ranking, or of another: "worst@3".
/// @throws base::ConfigError naming what came and what was wanted.
RolloutChoice ParseRolloutChoice(const std::string& text);

/// @throws base::ConfigError if there is no such rollout among those played.
int IndexOf(const RolloutChoice& choice, const Evidence& evidence);

/// Plays one rollout again from its seed, and notes what happens. Nothing if it was cancelled.
/// @param watcher  told of each sample; the end is the caller's to tell. May be null.
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

/// A table for plotting: a line per sample with time, base pose (x, y, z [m]; roll, pitch, yaw
/// [rad]), speed, acceleration and jerk of the base, for each object position and tilt, and what
/// happened.
std::string ToCsv(const RolloutRecording& recording);

}  // namespace hires::imagination
