#include "hires/planning/planner.h"

#include <utility>

#include "hires/base/error.h"
#include "hires/planning/datum_reader.h"
#include "planning/check/known_names.h"
#include "planning/proof/program.h"
#include "planning/search/passes.h"
#include "planning/search/search.h"

namespace hires::planning {

std::string_view ToString(PlanOutcome outcome) {
  switch (outcome) {
    case PlanOutcome::kFound:
      return "found";
    case PlanOutcome::kNoPlan:
      return "no_plan";
    case PlanOutcome::kLimitTime:
      return "limit_time";
    case PlanOutcome::kLimitMemory:
      return "limit_memory";
    case PlanOutcome::kCancelled:
      return "cancelled";
    case PlanOutcome::kLimitDepth:
      return "limit_depth";
    case PlanOutcome::kLimitCost:
      return "limit_cost";
  }
  return "";
}

StopQuestion WithMemoryLimit(std::size_t max_bytes, StopQuestion next) {
  return [max_bytes, next = std::move(next)](const Progress& progress) {
    const Stop answer = next ? next(progress) : Stop::kContinue;
    if (answer != Stop::kContinue) return answer;
    return progress.bytes > max_bytes ? Stop::kMemory : Stop::kContinue;
  };
}

namespace {

PlanResult FindPlans(const Program& program, TermTable* terms, const PlanRequest& request) {
  if (program.domain().language == Domain::Language::kHddl) {
    return FindHddlPlans(program, terms, request);
  }
  return Search(program, terms, request).Run();
}

std::vector<std::string> DoubtsAbout(const Domain& domain, const Problem& problem) {
  std::vector<std::string> doubts = domain.warnings;
  for (const auto& more : {problem.warnings, MisspeltPredicates(domain, problem)}) {
    doubts.insert(doubts.end(), more.begin(), more.end());
  }
  return doubts;
}

std::vector<Datum> TasksOf(const std::vector<TraceEntry>& entries) {
  std::vector<Datum> tasks;
  for (const TraceEntry& entry : entries) {
    if (!entry.task.empty()) tasks.push_back(ReadData(entry.task, "task").at(0));
  }
  return tasks;
}

}  // namespace

PlanResult FindPlans(const Domain& domain, const Problem& problem, const PlanRequest& request,
                     const Functions& functions) {
  TermTable terms;
  const Program program(domain, problem, functions, &terms);
  const std::vector<std::string> doubts = DoubtsAbout(domain, problem);
  for (const auto* warnings : {&program.warnings(), &doubts}) {
    if (request.strict && !warnings->empty()) throw base::ConfigError(warnings->front());
  }
  PlanResult result = FindPlans(program, &terms, request);
  if (request.explain && result.outcome == PlanOutcome::kNoPlan) {
    result.deepest = Search(program, &terms, request, {}, true).Run().deepest;
    result.unknown_names = UnknownSymbols(TasksOf(result.deepest), domain, problem);
  }
  result.warnings = program.warnings();
  result.doubts = doubts;
  return result;
}

}  // namespace hires::planning
