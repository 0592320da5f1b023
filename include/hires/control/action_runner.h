#pragma once

#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/control/skill_thread.h"
#include "hires/control/stop.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"

namespace hires::control {

enum class ActionEnd { kSucceeded, kFailed, kPreempted };

/// How an action went, or goes.
struct ActionNews {
  int id{0};
  double elapsed{0.0};  ///< [s] since its first look
  std::string phase;
  bool has_base{false};                      ///< it is among the groups that the action needs
  std::optional<skills::DriveView> drive{};  ///< what it drives by, until it is broken off
};

struct RunnerParams {
  double time_limit{300.0};  ///< [s] of an action that brings none of its own
  double stale_after{0.3};   ///< [s] without a new observation: the robot is blind, and stops
  StopParams stop;
};

/// stale_observation, for people: how old the last complete state of the robot is, how old it may
/// be [s], and what to look at.
/// @param late  the topic that keeps it from being complete; empty: none alone does.
base::Failure Stale(double age, double limit, const std::string& late);

/// Runs skills side by side on one robot: those that need different groups of joints. Time and
/// observations are handed in; commands and ends go out through the hooks. One thread owns it.
///
///   Start(...); then, again and again, Look(now, seen); Collect() whenever `wake` was called.
///
/// A skill begins at the first look after its start; it is asked at its own period, as in a
/// rollout.
class ActionRunner {
 public:
  struct Hooks {
    std::function<void(const robot::Command&)> send;
    std::function<void(const ActionNews&, ActionEnd, const base::Failure&)> ended;
    std::function<void()> wake;  ///< from another thread: there is something to collect
    /// It is being broken off, and the robot stopped; may be empty.
    std::function<void(const ActionNews&)> broken_off{};
  };

  /// @pre the robot outlives the runner.
  ActionRunner(const robot::Robot& robot, const RunnerParams& params, Hooks hooks);
  ~ActionRunner();

  /// @param groups      of joints that it needs for itself, as actions::GroupsOf.
  /// @param time_limit  [s]; 0 takes the configured one.
  /// @param now         [s] the time of Look.
  /// @return why not, if the groups are taken: busy, "move_base(home) needs base".
  base::Failure Start(int id, const base::ActionCall& action, const std::set<std::string>& groups,
                      std::unique_ptr<skills::Skill> skill, double time_limit, double now);

  /// The action stops the robot and then ends as kPreempted; nothing happens if it has ended.
  void Cancel(int id);
  void CancelAll();

  /// All actions stop the robot and then end as kFailed with this. What is held stays held.
  void FailAll(const base::Failure& failure);

  /// There is a guard of the base, and this is what the base carries: stops that begin from now on
  /// heed it, and where the speed of the base is not observed any more, its stop is left to the
  /// guard.
  void SetBraking(const LoadBraking& braking) { stop_.braking = braking; }

  /// All that is known at `now` [s]; `seen.time` and the objects' times are on the same clock.
  void Look(double now, const robot::Observation& seen);

  /// Takes what skills made of their looks.
  void Collect();

  /// Ends all actions as failed with stale_observation if the last look is too long ago.
  /// @param late  the topic that keeps the state from being complete; empty: none alone does.
  void CheckFreshness(double now, const std::string& late = {});

  /// Ends what is being stopped without waiting until the robot stands: no observation would tell.
  void GiveUpStopping();
  bool is_stopping() const;

  int num_thinking() const;  ///< skills that have not made up their mind about their look
  bool is_thinking() const { return num_thinking() > 0; }
  bool is_idle() const { return sessions_.empty(); }
  std::vector<ActionNews> News() const;
  std::vector<std::string> Running() const;  ///< for people

 private:
  struct Session {
    int id;
    base::ActionCall action;
    std::set<std::string> groups;
    double time_limit;
    double accepted;              // [s]
    std::optional<double> start;  // [s] of the first look
    double next{0.0};             // [s] when the skill is due
    std::string phase;
    std::optional<skills::DriveView> drive;
    std::unique_ptr<SkillThread> skill;
    std::unique_ptr<Stop> stop;         // it is being broken off
    ActionEnd end{ActionEnd::kFailed};  // how it will have ended when it stands
    base::Failure failure;
  };
  void LookWith(Session* session, const robot::Observation& seen);
  void Ask(Session* session, robot::Observation seen);
  void TakeTurn(Session* session, const SkillTurn& turn);
  void BreakOff(Session* session, ActionEnd end, const base::Failure& failure);
  void KeepStopping(Session* session);
  void Finish(Session* session, ActionEnd end, const base::Failure& failure);
  void RemoveFinished();
  ActionNews NewsOf(const Session& session) const;

  const robot::Robot& robot_;
  const RunnerParams params_;
  StopParams stop_;  // as configured, and for the load
  const Hooks hooks_;
  double now_{0.0};                         // [s] of the last look
  std::optional<robot::Observation> seen_;  // at the last look
  std::list<Session> sessions_;
  std::list<std::unique_ptr<SkillThread>> leaving_;  // still thinking when their actions had ended
};

}  // namespace hires::control
