#include "loop/planning_desk.h"

#include <utility>

#include "hires/base/error.h"
#include "hires/planning/plan_report.h"
#include "hires/planning/planner.h"
#include "hires/planning/reasons.h"
#include "hires/planning/request.h"

namespace hires::loop {
namespace {

using execution::PlanArrived;
using execution::StartPlanning;

constexpr std::uint64_t kMaxExpansions = 2'000'000;  // a limit that every computer reaches alike

planning::Problem ProblemOf(const StartPlanning& command, const planning::Domain& domain) {
  planning::Problem problem;
  planning::SetTasks(command.tasks, domain, &problem);
  planning::AppendFacts(command.state, "state", &problem);
  planning::AppendFacts(command.facts, "facts", &problem);
  return problem;
}

PlanArrived::Outcome OutcomeOf(planning::PlanOutcome outcome) {
  switch (outcome) {
    case planning::PlanOutcome::kFound:
      return PlanArrived::Outcome::kFound;
    case planning::PlanOutcome::kNoPlan:
      return PlanArrived::Outcome::kNoPlan;
    default:
      return PlanArrived::Outcome::kLimit;
  }
}

}  // namespace

PlanningDesk::PlanningDesk(const planning::PlanningKnowledge& knowledge, double duration,
                           VirtualClock* clock, OnAnswer on_answer)
    : knowledge_(knowledge),
      duration_(duration),
      clock_(*clock),
      on_answer_(std::move(on_answer)) {}

void PlanningDesk::Start(const StartPlanning& command) {
  const int number = ++num_searches_;
  awaited_[command.request] = number;
  clock_.In(duration_, [this, number, answer = Search(command)] {
    const auto awaited = awaited_.find(answer.request);
    if (awaited == awaited_.end() || awaited->second != number) return;
    awaited_.erase(awaited);
    on_answer_(answer);
  });
}

PlanArrived PlanningDesk::Search(const StartPlanning& command) const {
  PlanArrived answer;
  answer.request = command.request;
  try {
    const planning::Problem problem = ProblemOf(command, knowledge_.domain);
    planning::PlanRequest request;
    request.explain = true;
    request.stop = [](const planning::Progress& progress) {
      return progress.expansions > kMaxExpansions ? planning::Stop::kTime
                                                  : planning::Stop::kContinue;
    };
    planning::PlanResult result = planning::FindPlans(knowledge_.domain, problem, request);
    answer.outcome = OutcomeOf(result.outcome);
    answer.why = planning::OutcomeSentence(result, request.which);
    if (answer.outcome != PlanArrived::Outcome::kFound) return answer;
    answer.plan = std::move(result.plans.front());
    planning::AddReasons(knowledge_.domain, problem, &answer.plan);
  } catch (const base::ConfigError& error) {
    answer.outcome = PlanArrived::Outcome::kInvalid;
    answer.why = error.what();
  }
  return answer;
}

}  // namespace hires::loop
