#include "loop/imagination_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/overloaded.h"
#include "hires/imagination/imagine_answer.h"
#include "hires/imagination/report.h"

namespace hires::loop {
namespace {

using execution::ImagineAnswered;
using imagination::Assign;
using imagination::Report;
using Outcome = ImagineAnswered::Outcome;

ImaginedOutcome ImaginedOutcomeOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kRanked:
      return ImaginedOutcome::kRanked;
    case Outcome::kAllFailed:
      return ImaginedOutcome::kAllFailed;
    case Outcome::kUndecided:
      return ImaginedOutcome::kUndecided;
    case Outcome::kNoWorker:
      return ImaginedOutcome::kNoWorker;
    case Outcome::kNothingFinished:
      return ImaginedOutcome::kNothingFinished;
    case Outcome::kInvalid:
      return ImaginedOutcome::kInvalid;
    case Outcome::kUnavailable:
      return ImaginedOutcome::kUnavailable;
  }
  return ImaginedOutcome::kInvalid;
}

std::vector<std::string> NamesIn(const world::WorldState& world) {
  std::vector<std::string> names;
  for (const world::ObjectState& object : world.objects) names.push_back(object.name);
  return names;
}

}  // namespace

struct ImaginationDesk::Played {
  RolloutPool::Result rollout;
  bool is_kept{false};  // of an earlier request
};

struct ImaginationDesk::Session {
  execution::StartImagination command;
  std::size_t step;  // its place among the steps
  bool is_over{false};
  std::shared_ptr<std::atomic<bool>> unwanted{std::make_shared<std::atomic<bool>>(false)};

  // Once the state is geometry.
  std::shared_ptr<const imagination::RolloutSetup> setup;
  std::vector<base::ActionCall> actions;
  std::vector<std::string> things;  // names of what is imagined with
  std::unique_ptr<imagination::Scheduler> scheduler;
  std::map<std::pair<int, int>, Played> rollouts;  // by index and alternative
};

ImaginationDesk::ImaginationDesk(const imagination::ImaginationSetup& setup,
                                 const translation::TranslatorContext& context,
                                 const imagination::ClientConfig& config,
                                 const execution::ImaginingParams& imagining,
                                 const ImaginationPace& pace, VirtualClock* clock,
                                 Blackboard* blackboard, RolloutPool* pool, OnAnswer on_answer)
    : setup_(setup),
      context_(context),
      scheduler_(config.scheduler),
      imagining_(imagining),
      pace_(pace),
      clock_(*clock),
      blackboard_(*blackboard),
      pool_(*pool),
      on_answer_(std::move(on_answer)),
      kept_(config.kept_rollouts),
      free_from_(static_cast<std::size_t>(pace.workers), 0.0) {}

ImaginationDesk::~ImaginationDesk() { CancelAll(); }

ImaginationDesk::SessionPtr ImaginationDesk::Find(int request) const {
  const auto found = sessions_.find(request);
  return found == sessions_.end() ? nullptr : found->second;
}

void ImaginationDesk::Start(const execution::StartImagination& command) {
  auto session = std::make_shared<Session>();
  session->command = command;
  session->step = steps_.size();
  sessions_[command.request] = session;
  ImaginedStep step;
  step.plan = command.plan;
  step.step = command.step;
  step.action = command.action;
  step.requested = clock_.now();
  step.deadline = command.deadline;
  steps_.push_back(std::move(step));
  clock_.In(pace_.translation, [this, session] {
    if (!session->is_over) Begin(session);
  });
  Move({command.request, command.deadline});
}

void ImaginationDesk::Move(const execution::MoveDeadline& command) {
  const SessionPtr session = Find(command.request);
  if (!session) return;  // answered just now
  session->command.deadline = command.deadline;
  steps_[session->step].deadline = command.deadline;
  if (!std::isfinite(command.deadline)) return;
  clock_.At(command.deadline, [this, session, deadline = command.deadline] {
    if (session->is_over || session->command.deadline != deadline) return;
    if (!session->scheduler) {
      return Refuse(session, Outcome::kNothingFinished,
                    "its time was over before the state was translated");
    }
    CarryOut(session, session->scheduler->Cancel(clock_.now()));
  });
}

void ImaginationDesk::Cancel(const execution::CancelImagination& command) {
  const SessionPtr session = Find(command.request);
  if (session) BreakOff(session);
}

void ImaginationDesk::CancelAll() {
  while (!sessions_.empty()) BreakOff(sessions_.begin()->second);
}

/// Nobody wants the answer; what was played for it was played all the same.
void ImaginationDesk::BreakOff(const SessionPtr& session) {
  if (session->scheduler) {
    session->scheduler->Cancel(clock_.now());
    Book(session);
  }
  End(session, ImaginedOutcome::kCancelled);
}

/// @throws nothing: what cannot be imagined is answered so.
void ImaginationDesk::Begin(const SessionPtr& session) {
  try {
    const auto context = translation::WithKnowledge(context_, blackboard_.view());
    const auto state = translation::StateOf(context, &blackboard_.view(), session->command.state);
    session->things = NamesIn(state.world);
    session->actions = base::Combinations(session->command.action);
    imagination::RolloutSetup setup = imagination::MakeRolloutSetup(
        setup_, {state.world, state.robot}, session->command.SeedFrom(imagining_.seed));
    setup.uncertainty = imagination::UncertaintyFrom(setup.uncertainty, state.robot.X_MB, believed_,
                                                     "the robot's localisation");
    session->setup = std::make_shared<const imagination::RolloutSetup>(std::move(setup));
    imagination::CheckSetupForAll(*session->setup, session->actions);
    imagination::SchedulerParams params = scheduler_;
    params.rollouts = imagining_.rollouts;
    params.deadline = 0.0;  // it is kept here, because it moves
    if (session->command.min_success != 0.0) {
      params.criteria.min_success = session->command.min_success;
    }
    if (!imagining_.ranking.empty()) {
      params.criteria.rule = imagination::ParseRankingRule(imagining_.ranking);
    }
    params.criteria.prices.time_limit = session->setup->params.time_limit;
    session->scheduler = std::make_unique<imagination::Scheduler>(
        params, static_cast<int>(session->actions.size()), clock_.now());
  } catch (const base::ConfigError& error) {
    return Refuse(session, Outcome::kInvalid, error.what());
  }
  // All are played up to the first look at least: threads need not wait for virtual workers.
  const int first = std::min(scheduler_.first_look, imagining_.rollouts);
  for (int index = 0; index < first; ++index) {
    for (std::size_t i = 0; i < session->actions.size(); ++i) {
      Rollout(session, static_cast<int>(i), index);
    }
  }
  for (int worker = 0; worker < pace_.workers && !session->is_over; ++worker) {
    Handle(session, imagination::WorkerJoined{worker});
  }
}

const ImaginationDesk::Played& ImaginationDesk::Rollout(const SessionPtr& session, int alternative,
                                                        int index) {
  const auto [known, is_new] = session->rollouts.try_emplace({index, alternative});
  if (!is_new) return known->second;
  const base::ActionCall& action = session->actions.at(static_cast<std::size_t>(alternative));
  if (auto kept = kept_.Find(*session->setup, action, index)) {
    std::promise<imagination::RolloutResult> promise;
    promise.set_value(*std::move(kept));
    known->second = {promise.get_future().share(), true};
  } else {
    known->second.rollout = pool_.Play(session->setup, action, index, session->unwanted);
  }
  return known->second;
}

void ImaginationDesk::Handle(const SessionPtr& session, const imagination::Event& event) {
  if (session->is_over) return;
  CarryOut(session, session->scheduler->Handle(event, clock_.now()));
}

/// Assignments that are taken back are played in vain: the scheduler heeds no event of theirs.
void ImaginationDesk::CarryOut(const SessionPtr& session,
                               const std::vector<imagination::Command>& commands) {
  std::vector<Assign> assigned;
  for (const imagination::Command& command : commands) {
    if (const auto* assign = std::get_if<Assign>(&command)) assigned.push_back(*assign);
  }
  for (const Assign& assign : assigned) {
    for (int i = 0; i < assign.count; ++i) {
      Rollout(session, assign.alternative, assign.first_index + i);
    }
  }
  for (const Assign& assign : assigned) Play(session, assign);
  if (!session->is_over && session->scheduler->finished()) Finish(session);
}

/// A worker plays one assignment after the other, whoever gave it.
void ImaginationDesk::Play(const SessionPtr& session, const Assign& assign) {
  double& free_from = free_from_.at(static_cast<std::size_t>(assign.worker));
  free_from = std::max(free_from, clock_.now());
  for (int i = assign.first_index; i < assign.first_index + assign.count; ++i) {
    const Played& played = Rollout(session, assign.alternative, i);
    if (!played.is_kept) free_from += played.rollout.get().simulated / pace_.speed;
    clock_.At(free_from,
              [this, session, assign, i, &played] { Finished(session, assign, i, played); });
  }
  clock_.At(free_from, [this, session, assign] {
    Handle(session, imagination::AssignmentFinished{assign.worker, assign.assignment});
  });
}

void ImaginationDesk::Finished(const SessionPtr& session, const Assign& assign, int index,
                               const Played& played) {
  if (session->is_over) return;
  const imagination::RolloutResult& rollout = played.rollout.get();
  const base::ActionCall& action =
      session->actions.at(static_cast<std::size_t>(assign.alternative));
  if (!played.is_kept) kept_.Keep(session->setup, action, index, rollout);
  Handle(session, imagination::RolloutFinished{assign.worker, assign.assignment, assign.alternative,
                                               index, rollout});
}

/// What was played, and what it came to.  @pre the scheduler has finished.
Report ImaginationDesk::Book(const SessionPtr& session) {
  ImaginedStep& step = steps_[session->step];
  const double took = clock_.now() - step.requested;
  std::set<std::pair<int, int>> kept;
  for (const auto& [place, rollout] : session->rollouts) {
    if (rollout.is_kept) kept.insert({place.second, place.first});
  }
  const Report report =
      imagination::MakeReport(*session->scheduler, session->actions, session->setup->seed, took,
                              kept, session->setup->uncertainty->quantities.empty());
  base::Log(base::LogLevel::kInfo,
            fmt::format("imagination={} rollouts={} kept={}", session->command.request,
                        session->rollouts.size(), kept.size()));
  step.wall_seconds = took;
  step.simulated_seconds = report.played_seconds();
  step.predictions = report.ranking;
  return report;
}

void ImaginationDesk::Finish(const SessionPtr& session) {
  ImaginedStep& step = steps_[session->step];
  const Report report = Book(session);
  step.recommended = report.recommended;
  // What cuts it short is its time alone: whoever cancels it wants no answer.
  const ImagineAnswered answer = AnswerOf(session->command.request, report, true, session->things);
  step.why = answer.why;
  End(session, ImaginedOutcomeOf(answer.outcome));
  on_answer_(answer);
}

void ImaginationDesk::Refuse(const SessionPtr& session, Outcome outcome, const std::string& why) {
  ImagineAnswered answer;
  answer.request = session->command.request;
  answer.outcome = outcome;
  answer.why = why;
  steps_[session->step].why = why;
  End(session, ImaginedOutcomeOf(outcome));
  on_answer_(answer);
}

void ImaginationDesk::End(const SessionPtr& session, ImaginedOutcome outcome) {
  session->is_over = true;
  *session->unwanted = true;
  steps_[session->step].outcome = outcome;
  steps_[session->step].answered = clock_.now();
  sessions_.erase(session->command.request);
}

}  // namespace hires::loop
