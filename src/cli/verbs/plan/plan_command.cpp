#include "cli/verbs/plan/plan_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/exit_code.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/resource_use.h"
#include "hires/base/text.h"
#include "hires/planning/ipc_plan.h"
#include "hires/planning/plan_json.h"
#include "hires/planning/plan_order.h"
#include "hires/planning/plan_report.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/reasons.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/task_text.h"
#include "hires/planning/validator.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kTraceLength = 1000;     // entries, the latest ones
constexpr std::size_t kLongestStepText = 100;  // characters in the table

/// What is asked, and what came of it.
struct Session {
  planning::Domain domain;
  planning::Problem problem;
  planning::PlanRequest request;
  planning::PlanResult result;
  planning::SearchCosts costs;
  std::vector<std::vector<std::string>> violations;  ///< per plan, where --validate was given
};

/// The problem of that name; without a name the only one there is.
planning::Problem ChooseProblem(const std::vector<planning::Problem>& problems,
                                const PlanOptions& options) {
  if (!options.name.empty()) return planning::FindProblem(problems, options.name);
  if (problems.size() == 1) return problems[0];
  std::vector<std::string> names;
  for (const planning::Problem& problem : problems) names.push_back(problem.name);
  throw base::ConfigError(fmt::format("{}: has {} problems; choose one with --name: {}",
                                      options.problem.empty() ? options.domain : options.problem,
                                      problems.size(), base::Join(names, ", ")));
}

/// Another task from the same facts; what the problem itself wants in the end counts no more.
void ReplaceTasks(const std::string& task, const planning::Domain& domain,
                  planning::Problem* problem) {
  problem->tasks = planning::ReadTasks(task, "--task");
  problem->parameters = {};
  problem->goal.reset();
  problem->source = "--task";
  planning::CheckTasks(*problem, domain);
}

planning::StopQuestion StopQuestionFor(const PlanOptions& options,
                                       const std::function<bool()>& cancelled) {
  std::optional<SteadyClock::time_point> end;
  if (options.time > 0.0) {
    end = SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(
                                   std::chrono::duration<double>(options.time));
  }
  const planning::StopQuestion question = [cancelled, end](const planning::Progress&) {
    if (cancelled()) return planning::Stop::kCancelled;
    if (end && SteadyClock::now() >= *end) return planning::Stop::kTime;
    return planning::Stop::kContinue;
  };
  if (options.memory <= 0.0) return question;
  return planning::WithMemoryLimit(static_cast<std::size_t>(options.memory * 1e6), question);
}

planning::PlanRequest RequestOf(const PlanOptions& options) {
  planning::PlanRequest request;
  request.which = planning::ParseWhich(options.which);
  request.max_plans = static_cast<std::size_t>(options.limit);
  if (options.depth > 0) request.max_depth = options.depth;
  if (options.trace) request.max_trace = kTraceLength;
  request.strict = options.strict;
  request.explain = true;
  return request;
}

Session Read(const PlanOptions& options) {
  Session session;
  session.domain = planning::LoadDomain(options.domain);
  planning::CheckSidecar(options.domain, session.domain);
  const std::string& file = options.problem.empty() ? options.domain : options.problem;
  session.problem = ChooseProblem(planning::LoadProblems(file, session.domain), options);
  if (!options.task.empty()) ReplaceTasks(options.task, session.domain, &session.problem);
  session.request = RequestOf(options);
  return session;
}

/// Nothing but the search lies between the two looks at the clock.
void Search(Session* session) {
  const double begin = base::ThreadCpuSeconds();
  session->result = planning::FindPlans(session->domain, session->problem, session->request);
  session->costs.cpu_seconds = base::ThreadCpuSeconds() - begin;
  session->costs.peak_mb = base::PeakMegabytes();
}

void AddReasons(Session* session) {
  for (planning::Plan& plan : session->result.plans) {
    planning::AddReasons(session->domain, session->problem, &plan, planning::Functions::Standard());
  }
}

void Validate(Session* session) {
  for (const planning::Plan& plan : session->result.plans) {
    session->violations.push_back(planning::ValidatePlan(session->domain, session->problem, plan));
  }
}

std::string Shortened(const std::string& text) {
  return text.size() <= kLongestStepText ? text : text.substr(0, kLongestStepText) + " ...";
}

/// "0, 3": the steps that each step must wait for.
std::vector<std::string> WaitsFor(const planning::Plan& plan) {
  std::vector<std::vector<std::string>> before(plan.steps.size());
  for (const auto& [first, second] : planning::PartialOrder(plan)) {
    before[second].push_back(std::to_string(first));
  }
  std::vector<std::string> texts;
  for (const auto& steps : before) texts.push_back(base::Join(steps, ", "));
  return texts;
}

/// The two tasks next above a step; the whole path would not fit a terminal.
std::string Origin(const planning::Plan& plan, int step) {
  std::vector<std::string> names = base::Split(planning::DecompositionPath(plan, step), '/');
  if (names.size() > 2) names.erase(names.begin(), names.end() - 2);
  return base::Join(names, "/");
}

std::string PlanTable(const planning::Plan& plan) {
  const std::vector<std::string> waits_for = WaitsFor(plan);
  std::vector<std::vector<std::string>> rows{{"#", "step", "cost", "after", "part of"}};
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    rows.push_back({std::to_string(i), Shortened(planning::ToString(plan.steps[i].task)),
                    fmt::format("{}", plan.steps[i].cost), waits_for[i],
                    Origin(plan, static_cast<int>(i))});
  }
  return reports::FormatTable(rows);
}

void PrintTables(const std::vector<planning::Plan>& plans) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (plans.size() > 1) std::cout << fmt::format("plan {}, cost {}\n", i + 1, plans[i].cost);
    std::cout << PlanTable(plans[i]) << '\n';
  }
}

void PrintBare(const Session& session, const std::string& format) {
  for (std::size_t i = 0; i < session.result.plans.size(); ++i) {
    const planning::Plan& plan = session.result.plans[i];
    std::cout << (i > 0 ? "\n" : "")
              << (format == "ipc" ? planning::ToIpcPlan(session.domain, plan)
                                  : planning::ToShop2Plan(plan));
  }
}

void PrintTrace(const std::vector<planning::TraceEntry>& trace, std::ostream* out) {
  if (trace.empty()) return;
  std::vector<std::vector<std::string>> rows{{"depth", "task", "where", "given up because"}};
  for (const planning::TraceEntry& entry : trace) {
    rows.push_back({std::to_string(entry.depth), Shortened(entry.task), entry.where, entry.reason});
  }
  *out << reports::FormatTable(rows) << '\n';
}

void PrintViolations(const Session& session, std::ostream* out) {
  for (std::size_t i = 0; i < session.violations.size(); ++i) {
    if (session.violations[i].empty()) *out << fmt::format("plan {} is valid\n", i + 1);
    for (const std::string& violation : session.violations[i]) {
      *out << fmt::format("plan {} is not valid: {}\n", i + 1, violation);
    }
  }
}

void PrintWarnings(const Session& session) {
  for (const std::string& warning : session.result.warnings) {
    std::cerr << "warning, as nothing reached it: " << warning << '\n';
  }
  for (const std::string& warning : session.result.doubts) {
    std::cerr << "warning: " << warning << '\n';
  }
}

void PrintOutcome(const Session& session, std::ostream* out) {
  const planning::PlanResult& result = session.result;
  *out << fmt::format("{}: {}\n", planning::ToString(result.outcome),
                      planning::OutcomeSentence(result, session.request.which));
  *out << fmt::format("{} expansions, {} inferences, {:.2f} ms of processor time, {:.0f} MB\n",
                      result.progress.expansions, result.progress.inferences,
                      1e3 * session.costs.cpu_seconds, session.costs.peak_mb);
}

void Print(const Session& session, const std::string& format) {
  if (format.empty()) {
    PrintTables(session.result.plans);
  } else {
    PrintBare(session, format);
  }
  std::ostream* out = format.empty() ? &std::cout : &std::cerr;
  PrintTrace(session.result.trace, out);
  PrintViolations(session, out);
  PrintWarnings(session);
  PrintOutcome(session, out);
}

nlohmann::ordered_json SessionToJson(const Session& session) {
  nlohmann::ordered_json json = planning::ToJson(session.result, session.costs);
  for (std::size_t i = 0; i < session.violations.size(); ++i) {
    json["plans"][i]["violations"] = session.violations[i];
  }
  json["why"] = planning::OutcomeSentence(session.result, session.request.which);
  json["warnings"] = session.result.warnings;
  for (const std::string& doubt : session.result.doubts) json["warnings"].push_back(doubt);
  return json;
}

int ExitCodeFor(const Session& session) {
  for (const auto& violations : session.violations) {
    if (!violations.empty()) return kExitInvalidPlan;
  }
  switch (session.result.outcome) {
    case planning::PlanOutcome::kFound:
      return kExitPlanFound;
    case planning::PlanOutcome::kNoPlan:
      return kExitNoPlan;
    case planning::PlanOutcome::kCancelled:
      return kExitCancelled;
    default:
      return kExitLimit;
  }
}

}  // namespace

void AddPlanVerb(CLI::App* app, PlanOptions* options) {
  CLI::App* verb =
      app->add_subcommand("plan", "find the steps that do a task: SHOP2 and HDDL domains");
  verb->add_option("--domain", options->domain, "SHOP2 or HDDL file")->required();
  verb->add_option("--problem", options->problem,
                   "file of the problem, in the domain's language; default: the domain's file");
  verb->add_option("--name", options->name, "which problem, where the file has several");
  verb->add_option(
      "--task", options->task,
      "instead of the problem's tasks: 'serve_coffee_to_guest guest1', or a SHOP2 task network");
  verb->add_option("--which", options->which, "first, all, best (the cheapest); default: first")
      ->check(CLI::IsMember({"first", "all", "best"}));
  verb->add_option("--limit", options->limit, "plans, of --which all; default: 1000")
      ->check(NumberBetween(1, 1000000000));
  verb->add_option("--time", options->time, "[s] of search")->check(NumberBetween(0.001, 1e9));
  verb->add_option("--memory", options->memory, "[MB] held by the search")
      ->check(NumberBetween(0.001, 1e9));
  verb->add_option("--depth", options->depth, "decompositions and steps on one path")
      ->check(NumberBetween(1, 1000000000));
  verb->add_flag("--trace", options->trace, "say why ways were given up, the latest 1000");
  verb->add_flag("--strict", options->strict,
                 "refuse what would be warned of, such as unknown tasks that no way leads to");
  AddReportOptions(verb, &options->report);
  verb->add_option("--format", options->format,
                   "print the bare plan: shop2 (one operator a line) or ipc (as in IPC 2020)")
      ->check(CLI::IsMember({"shop2", "ipc"}));
  verb->add_flag("--validate", options->validate, "check each plan by an independent validator");
  options->verb = verb;
}

int RunPlanVerb(const PlanOptions& options, const std::function<bool()>& cancelled) {
  CheckReport(options.report, {{"domain", options.domain}, {"problem", options.problem}});
  ReportOrigin origin;
  origin.verb = "plan";
  if (IsWanted(options.report))
    origin.inputs = {{"domain", options.domain}, {"problem", options.problem}};
  Session session = Read(options);
  session.request.stop = StopQuestionFor(options, cancelled);
  Search(&session);
  if (options.format.empty() || IsWanted(options.report)) AddReasons(&session);
  if (options.validate) Validate(&session);
  Print(session, options.format);
  WriteReport(options.report, origin, SessionToJson(session));
  return ExitCodeFor(session);
}

}  // namespace hires::cli
