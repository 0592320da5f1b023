#pragma once

#include <functional>
#include <string>

#include "cli/report_output.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// Exit codes of `hires plan`; 1 is bad input and 130 interrupted, as with every verb.
enum PlanExitCode {
  kExitPlanFound = 0,    ///< all that was asked for
  kExitNoPlan = 2,       ///< there is none
  kExitLimit = 3,        ///< a limit ended the search; what was found until then is printed
  kExitInvalidPlan = 4,  ///< --validate refuses a plan: a defect of the planner
};

/// What was typed behind `hires plan`.
struct PlanOptions {
  std::string domain, problem, name, task;
  ReportOptions report;
  std::string which{"first"};
  std::string format;  ///< "shop2", "ipc"; empty: a table
  int limit{1000};     ///< plans, of `which` all
  int depth{0};        ///< decompositions and steps on one path; 0: the planner's own limit
  double time{0.0};    ///< [s] of search; 0: no limit
  double memory{0.0};  ///< [MB] held by the search; 0: no limit
  bool trace{false}, validate{false}, strict{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddPlanVerb(CLI::App* app, PlanOptions* options);

/// Reads, searches, prints, writes. With a format, standard output carries the bare plans (an empty
/// line between two) and standard error the rest.
/// @return PlanExitCode or kExitCancelled.  @throws base::ConfigError for bad input.
int RunPlanVerb(const PlanOptions& options, const std::function<bool()>& cancelled);

}  // namespace hires::cli
