#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "hires/control/move_base_keeper.h"

namespace hires::control {

/// How far a MoveBaseTuner is.
struct TunerState {
  enum class Phase {
    kAtRest,     ///< the planner has its own values
    kApplying,   ///< on its way; do not drive yet
    kInForce,    ///< read back: `request` may drive
    kRestoring,  ///< on its way
    kFailed,     ///< `reason` says why; do not drive
  };
  Phase phase{Phase::kAtRest};
  std::uint64_t request{0};  ///< for which it is; 0: none
  std::string reason;        ///< empty unless kFailed
};

/// A MotionSetKeeper on a thread of its own, so that the guard of the base never waits for
/// move_base. What a former process left behind is put back at once when it starts; what cannot be
/// put back is tried again until it can.
///
///   tuner.Apply(request, "slow", limits);   // and drive once state() says kInForce for request
///   tuner.Restore();                        // the request has ended, or its sender died
///
/// Of calls that wait only the last one counts: what it asks for is what shall be.
class MoveBaseTuner {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param retry_period  between two attempts to put back.
  /// @param farewell      that the end may take.
  MoveBaseTuner(MotionSetKeeper keeper, std::chrono::milliseconds retry_period,
                std::chrono::milliseconds farewell);

  /// Puts back what is in force: ROS must still work. Gives up after `farewell`; the journal then
  /// tells the next process.
  ~MoveBaseTuner();
  MoveBaseTuner(const MoveBaseTuner&) = delete;
  MoveBaseTuner& operator=(const MoveBaseTuner&) = delete;

  void Apply(std::uint64_t request, const std::string& set_name, const robot::MotionSet& set);
  void Restore();

  /// The planner said what it has (topic `<server>/parameter_updates`). If that is not the set in
  /// force, the planner is asked, for what it said may be old; where another program has changed
  /// limits, the phase becomes kFailed.
  void OnUpdate(const PlannerValues& values);

  TunerState state() const;

 private:
  enum class Kind { kApply, kRestore, kVerify };
  struct Job {
    Kind kind;
    std::uint64_t request{0};
    std::string set_name;
    robot::MotionSet set;
    bool is_retry{false};
  };
  void Post(Job job, TunerState::Phase phase);
  void Run();
  std::optional<Job> NextJob();
  std::string WhyFailed(const Job& job);
  void End(const Job& job, const std::string& why_failed);
  TunerState StateAfter(const Job& job, const std::string& why_failed) const;

  MotionSetKeeper keeper_;  // of the thread
  const std::chrono::milliseconds retry_period_, farewell_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Job> waiting_;   // guarded
  TunerState state_;             // guarded
  PlannerValues in_force_;       // guarded
  bool is_restore_owed_{false};  // guarded: something may have to be put back yet
  bool is_working_{false};       // guarded
  bool is_ending_{false};        // guarded
  std::thread thread_;
};

}  // namespace hires::control
