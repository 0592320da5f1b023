#include "hires/ros/planning/plan_request.h"

#include <fmt/format.h>

#include <cmath>
#include <new>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/resource_use.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/planning/plan_order.h"
#include "hires/planning/plan_report.h"
#include "hires/planning/reasons.h"
#include "hires/planning/request.h"
#include "hires/planning/task_text.h"
#include "hires/ros/planning/plan_nodes.h"
#include "hires/ros/values/atom_messages.h"

namespace hires_ros {
namespace {

namespace planning = hires::planning;
using hires::base::ConfigError;
using planning::Datum;

constexpr std::uint32_t kMaxTrace = 100'000;  // entries

/// The problem that the goal names; else the first one, for what it knows.
planning::Problem KnownProblem(const hires::PlanGoal& goal,
                               const planning::PlanningKnowledge& knowledge) {
  if (!goal.problem.empty()) return planning::FindProblem(knowledge.problems, goal.problem);
  if (goal.task.empty()) {
    throw ConfigError("task and problem are both empty; name a task, or a problem with its tasks");
  }
  return knowledge.problems.empty() ? planning::Problem{} : knowledge.problems[0];
}

planning::Problem ProblemOf(const hires::PlanGoal& goal,
                            const planning::PlanningKnowledge& knowledge) {
  planning::Problem problem = KnownProblem(goal, knowledge);
  if (!goal.task.empty()) planning::SetTasks(goal.task, knowledge.domain, &problem);
  if (!goal.state.empty()) problem.facts.clear();
  planning::AppendFacts(FromMsg(goal.state), "state", &problem);
  planning::AppendFacts(FromMsg(goal.more_facts), "more_facts", &problem);
  return problem;
}

planning::Which WhichOf(const hires::PlanGoal& goal) {
  switch (goal.which) {
    case hires::PlanGoal::FIRST:
      return planning::Which::kFirst;
    case hires::PlanGoal::ALL:
      return planning::Which::kAll;
    case hires::PlanGoal::BEST:
      return planning::Which::kBest;
  }
  throw ConfigError(
      fmt::format("which is {}, wanted FIRST (0), ALL (1) or BEST (2)", int{goal.which}));
}

/// What the goal wants of a quantity of which the planner allows `at_most`; 0: all of it.
double LimitOf(const char* field, double wanted, double at_most, const char* unit) {
  if (wanted == 0.0) return at_most;
  if (wanted > 0.0 && wanted <= at_most) return wanted;  // false for no number
  throw ConfigError(
      fmt::format("{} is {}{}, wanted at most {}{} (this planner's own limit), or 0 "
                  "for that",
                  field, wanted, unit, at_most, unit));
}

std::size_t MemoryLimitOf(const hires::PlanGoal& goal, const planning::PlannerConfig& config) {
  return static_cast<std::size_t>(
      1e6 * LimitOf("memory_limit", goal.memory_limit, config.memory_limit, " MB"));
}

hires::Atom AtomToMsg(const Datum& atom) {
  hires::Atom message;
  message.predicate = atom.IsList() ? std::string(atom.Head()) : planning::ToString(atom);
  for (std::size_t i = 1; i < atom.items.size(); ++i) {
    message.arguments.push_back(planning::ToString(atom.items[i]));
  }
  return message;
}

std::vector<hires::Atom> AtomsToMsg(const std::vector<Datum>& atoms) {
  std::vector<hires::Atom> messages;
  for (const Datum& atom : atoms) messages.push_back(AtomToMsg(atom));
  return messages;
}

/// The index of what the link supports; `place` is where it stands among the links.
std::uint32_t PreconditionOf(const planning::PlanStep& step, std::size_t place) {
  const planning::Literal& literal = step.links[place].literal;
  const auto is_it = [&](std::size_t i) {
    return i < step.preconditions.size() && step.preconditions[i] == literal;
  };
  if (is_it(place)) return static_cast<std::uint32_t>(place);
  std::size_t i = 0;
  while (i < step.preconditions.size() && !is_it(i)) ++i;
  return static_cast<std::uint32_t>(i);
}

void SetTask(const Datum& task, hires::PlanStep* message) {
  const hires::Atom call = AtomToMsg(task);
  message->action.name =
      call.predicate.substr(std::min(call.predicate.find_first_not_of('!'), call.predicate.size()));
  message->action.arguments = call.arguments;
  message->bookkeeping = call.predicate.rfind("!!", 0) == 0;
  message->task = planning::ToString(task);
}

void SetReasons(const planning::PlanStep& step, hires::PlanStep* message) {
  for (const planning::Literal& literal : step.preconditions) {
    hires::PlanLiteral precondition;
    precondition.atom = AtomToMsg(literal.atom);
    precondition.holds = literal.holds;
    message->preconditions.push_back(std::move(precondition));
  }
  message->deletes = AtomsToMsg(step.deletes);
  message->adds = AtomsToMsg(step.adds);
  for (std::size_t i = 0; i < step.links.size(); ++i) {
    hires::CausalLink link;
    link.producer = step.links[i].producer;
    link.precondition = PreconditionOf(step, i);
    message->links.push_back(link);
  }
}

int OutcomeOf(planning::PlanOutcome outcome) {
  switch (outcome) {
    case planning::PlanOutcome::kFound:
      return hires::PlanResult::FOUND;
    case planning::PlanOutcome::kNoPlan:
      return hires::PlanResult::NO_PLAN;
    case planning::PlanOutcome::kLimitTime:
      return hires::PlanResult::LIMIT_TIME;
    case planning::PlanOutcome::kLimitMemory:
      return hires::PlanResult::LIMIT_MEMORY;
    case planning::PlanOutcome::kCancelled:
      return hires::PlanResult::CANCELLED;
    case planning::PlanOutcome::kLimitDepth:
      return hires::PlanResult::LIMIT_DEPTH;
    case planning::PlanOutcome::kLimitCost:
      return hires::PlanResult::LIMIT_COST;
  }
  return hires::PlanResult::INVALID;
}

std::string TraceLine(const planning::TraceEntry& entry) {
  return fmt::format("depth {}: {}: {}: {}", entry.depth, entry.task, entry.where, entry.reason);
}

hires::PlanResult WithoutPlans(const planning::PlanResult& found, planning::Which which) {
  hires::PlanResult result = ResultWithout(OutcomeOf(found.outcome), OutcomeSentence(found, which));
  result.exhausted = found.exhausted;
  for (const planning::TraceEntry& entry : found.trace) result.trace.push_back(TraceLine(entry));
  result.expansions = found.progress.expansions;
  result.inferences = found.progress.inferences;
  return result;
}

/// Adding reasons and sending many plans takes time, and a cancelled request is answered at once.
bool AddPlans(const planning::Domain& domain, const PlanRequest& request,
              const planning::StopQuestion& stop, planning::PlanResult* found,
              hires::PlanResult* result) {
  for (planning::Plan& plan : found->plans) {
    if (stop(found->progress) == planning::Stop::kCancelled) return false;
    planning::AddReasons(domain, request.problem, &plan, planning::Functions::Standard());
    result->plans.push_back(ToMsg(plan));
  }
  return true;
}

hires::PlanResult Plan(const PlanRequest& request, const planning::Domain& domain,
                       const planning::StopQuestion& stop) {
  const double begin = hires::base::ThreadCpuSeconds();
  planning::PlanResult found = planning::FindPlans(domain, request.problem, request.search);
  const double cpu_seconds = hires::base::ThreadCpuSeconds() - begin;
  for (const std::string& warning : found.doubts) {
    hires::base::Log(hires::base::LogLevel::kWarn, warning);
  }
  hires::PlanResult result = WithoutPlans(found, request.search.which);
  result.cpu_seconds = cpu_seconds;
  if (!AddPlans(domain, request, stop, &found, &result)) {
    found.outcome = planning::PlanOutcome::kCancelled;
    result = WithoutPlans(found, request.search.which);
    result.cpu_seconds = cpu_seconds;
  }
  return result;
}

}  // namespace

PlanRequest RequestOf(const hires::PlanGoal& goal, const planning::PlanningKnowledge& knowledge,
                      const planning::PlannerConfig& config) {
  PlanRequest request;
  request.search.which = WhichOf(goal);
  request.search.max_plans =
      static_cast<std::size_t>(LimitOf("max_plans", goal.max_plans, config.max_plans, ""));
  request.search.max_depth = config.max_depth;
  LimitOf("max_trace", goal.max_trace, kMaxTrace, "");
  request.search.max_trace = goal.max_trace;
  request.search.explain = true;
  TimeLimitOf(goal, config);
  MemoryLimitOf(goal, config);
  request.problem = ProblemOf(goal, knowledge);
  return request;
}

double TimeLimitOf(const hires::PlanGoal& goal, const planning::PlannerConfig& config) {
  return LimitOf("time_limit", goal.time_limit.toSec(), config.time_limit, " s");
}

hires::PlanResult AnswerTo(const hires::PlanGoal& goal,
                           const planning::PlanningKnowledge& knowledge,
                           const planning::PlannerConfig& config,
                           const planning::StopQuestion& stop) {
  try {
    PlanRequest request = RequestOf(goal, knowledge, config);
    request.search.stop = planning::WithMemoryLimit(MemoryLimitOf(goal, config), stop);
    return Plan(request, knowledge.domain, stop);
  } catch (const std::bad_alloc&) {
    return ResultWithout(hires::PlanResult::LIMIT_MEMORY,
                         "this computer has no more memory; ask for less at once");
  } catch (const std::exception& error) {  // one bad request must not end the others
    return ResultWithout(hires::PlanResult::INVALID, error.what());
  }
}

hires::PlanResult ResultWithout(int outcome, const std::string& why) {
  hires::PlanResult result;
  result.outcome = static_cast<std::uint8_t>(outcome);
  result.why = hires::base::Shortened(why);
  return result;
}

hires::Plan ToMsg(const planning::Plan& plan) {
  hires::Plan message;
  message.cost = plan.cost;
  message.steps.resize(plan.steps.size());
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    SetTask(plan.steps[i].task, &message.steps[i]);
    SetReasons(plan.steps[i], &message.steps[i]);
    message.steps[i].cost = plan.steps[i].cost;
    message.steps[i].path = planning::DecompositionPath(plan, static_cast<int>(i));
  }
  for (const auto& [first, second] : planning::PartialOrder(plan)) {
    message.steps[second].after.push_back(static_cast<std::uint32_t>(first));
  }
  message.nodes = NodesToMsg(plan);
  return message;
}

}  // namespace hires_ros
