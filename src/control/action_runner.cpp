#include "hires/control/action_runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/log.h"
#include "hires/base/text.h"

namespace hires::control {
namespace {

using base::Failure;
using Code = base::FailureCode;
using robot::Observation;
using skills::Progress;

// Stamps and periods are sums of rounded numbers; a skill may come this much before its time [s].
constexpr double kEarly = 1e-4;

std::vector<std::string> Common(const std::set<std::string>& a, const std::set<std::string>& b) {
  std::vector<std::string> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common;
}

}  // namespace

ActionRunner::ActionRunner(const robot::Robot& robot, const RunnerParams& params, Hooks hooks)
    : robot_(robot), params_(params), stop_(params.stop), hooks_(std::move(hooks)) {}

ActionRunner::~ActionRunner() = default;

Failure ActionRunner::Start(int id, const base::ActionCall& action,
                            const std::set<std::string>& groups,
                            std::unique_ptr<skills::Skill> skill, double time_limit, double now) {
  Session session;
  session.id = id;
  session.action = action;
  session.groups = groups;
  for (const Session& other : sessions_) {
    const auto common = Common(session.groups, other.groups);
    if (!common.empty()) {
      return {Code::kBusy,
              {},
              fmt::format("{} needs {}", base::ToString(other.action), base::Join(common, ", "))};
    }
  }
  session.time_limit = time_limit > 0.0 ? time_limit : params_.time_limit;
  session.accepted = now;
  session.skill = std::make_unique<SkillThread>(std::move(skill), hooks_.wake);
  sessions_.push_back(std::move(session));
  return {};
}

void ActionRunner::Cancel(int id) {
  for (Session& session : sessions_) {
    if (session.id == id) BreakOff(&session, ActionEnd::kPreempted, {});
  }
  RemoveFinished();
}

void ActionRunner::CancelAll() {
  for (Session& session : sessions_) BreakOff(&session, ActionEnd::kPreempted, {});
  RemoveFinished();
}

void ActionRunner::FailAll(const Failure& failure) {
  for (Session& session : sessions_) BreakOff(&session, ActionEnd::kFailed, failure);
  RemoveFinished();
}

void ActionRunner::Look(double now, const Observation& seen) {
  now_ = now;
  seen_ = seen;
  for (Session& session : sessions_) LookWith(&session, seen);
  RemoveFinished();
}

void ActionRunner::LookWith(Session* session, const Observation& seen) {
  if (!session->start) session->start = session->next = now_;
  if (!session->stop && now_ - *session->start >= session->time_limit) {
    BreakOff(session, ActionEnd::kFailed, Code::kTimedOut);
    return;
  }
  if (session->stop) {
    KeepStopping(session);
  } else if (!session->skill->is_thinking() && now_ >= session->next - kEarly) {
    Ask(session, seen);
  }
}

void ActionRunner::Ask(Session* session, Observation seen) {
  seen.time = now_ - *session->start;
  for (robot::SeenObject& object : seen.objects) object.time -= *session->start;
  session->next += session->skill->period();
  // What was missed is missed: a late skill does not hurry after its clock.
  if (session->next < now_) session->next = now_ + session->skill->period();
  session->skill->Look(std::move(seen));
}

void ActionRunner::Collect() {
  for (Session& session : sessions_) {
    const auto turn = session.skill ? session.skill->Take() : std::nullopt;
    if (turn && !session.stop) TakeTurn(&session, *turn);
  }
  RemoveFinished();
}

void ActionRunner::TakeTurn(Session* session, const SkillTurn& turn) {
  session->phase = turn.phase;
  session->drive = turn.drive;
  if (!turn.error.empty()) {
    base::Log(base::LogLevel::kError,
              fmt::format("action={} error=\"{}\"", base::ToString(session->action), turn.error));
    BreakOff(session, ActionEnd::kFailed, {Code::kInternalError, {}, turn.error});
    return;
  }
  hooks_.send(turn.command);
  if (turn.status.progress == Progress::kSucceeded) Finish(session, ActionEnd::kSucceeded, {});
  if (turn.status.progress == Progress::kFailed) {
    BreakOff(session, ActionEnd::kFailed, turn.status.failure);
  }
}

void ActionRunner::BreakOff(Session* session, ActionEnd end, const Failure& failure) {
  if (session->skill == nullptr || session->stop) return;  // has ended, or will
  if (!session->start) {                                   // has not moved anything
    Finish(session, end, failure);
    return;
  }
  session->end = end;
  session->failure = failure;
  session->phase = "stopping";
  session->drive.reset();
  if (hooks_.broken_off) hooks_.broken_off(NewsOf(*session));
  session->stop = std::make_unique<Stop>(robot_, session->groups, stop_);
  KeepStopping(session);
}

void ActionRunner::KeepStopping(Session* session) {
  hooks_.send(session->stop->Update(now_, *seen_));
  if (session->stop->is_over()) Finish(session, session->end, session->failure);
}

void ActionRunner::Finish(Session* session, ActionEnd end, const Failure& failure) {
  // A skill that still thinks about its last look is let go; its answer is not used.
  if (session->skill->is_thinking()) {
    leaving_.push_back(std::move(session->skill));
  }
  session->skill.reset();
  hooks_.ended(NewsOf(*session), end, failure);
}

void ActionRunner::RemoveFinished() {
  sessions_.remove_if([](const Session& session) { return session.skill == nullptr; });
  leaving_.remove_if(
      [](const std::unique_ptr<SkillThread>& skill) { return skill->Take().has_value(); });
}

base::Failure Stale(double age, double limit, const std::string& late) {
  const std::string source =
      late.empty() ? "odometry, joint states and localisation are late together: look whether a "
                     "computer is overloaded, or the network slow"
                   : fmt::format("nothing current comes on {}: look at who publishes it", late);
  return {base::FailureCode::kStaleObservation,
          {},
          fmt::format("{:.2f} s without a complete state of the robot, at most {:g} s "
                      "(sensing.robot_state.stale_after); {} (`hires doctor --robot`)",
                      age, limit, source)};
}

void ActionRunner::CheckFreshness(double now, const std::string& late) {
  for (Session& session : sessions_) {
    const double last = std::max(session.accepted, session.start ? now_ : 0.0);
    if (now - last <= params_.stale_after) continue;
    if (session.start && !session.stop) {
      Stop stop(robot_, session.groups, stop_);
      Observation still = *seen_;
      still.V_B = {};  // without observations the robot stops at once, not along a ramp
      robot::Command command = stop.Update(now, still);
      // With a load the base is not told to stand at once: the permission to drive ends with the
      // action, and then the guard, who knows how fast the base is, brings it to a stand.
      if (stop_.braking) command.base_velocity.reset();
      hooks_.send(command);
    }
    Finish(&session, ActionEnd::kFailed, Stale(now - last, params_.stale_after, late));
  }
  RemoveFinished();
}

void ActionRunner::GiveUpStopping() {
  for (Session& session : sessions_) {
    if (session.stop) Finish(&session, session.end, session.failure);
  }
  RemoveFinished();
}

bool ActionRunner::is_stopping() const {
  return std::any_of(sessions_.begin(), sessions_.end(),
                     [](const Session& session) { return session.stop != nullptr; });
}

int ActionRunner::num_thinking() const {
  return static_cast<int>(std::count_if(
      sessions_.begin(), sessions_.end(),
      [](const Session& session) { return session.skill && session.skill->is_thinking(); }));
}

ActionNews ActionRunner::NewsOf(const Session& session) const {
  return {session.id, session.start ? now_ - *session.start : 0.0, session.phase,
          session.groups.count("base") > 0, session.drive};
}

std::vector<ActionNews> ActionRunner::News() const {
  std::vector<ActionNews> news;
  for (const Session& session : sessions_) news.push_back(NewsOf(session));
  return news;
}

std::vector<std::string> ActionRunner::Running() const {
  std::vector<std::string> names;
  for (const Session& session : sessions_) names.push_back(base::ToString(session.action));
  return names;
}

}  // namespace hires::control
