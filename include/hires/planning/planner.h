#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/functions.h"
#include "hires/planning/plan.h"

namespace hires::planning {

/// How far a search is; the caller sees it with every question.
struct Progress {
  std::uint64_t expansions{0};  ///< tasks decomposed or applied
  std::uint64_t inferences{0};  ///< goals taken up by the prover
  int depth{0};                 ///< decompositions and steps on the current path
  double cost{0.0};             ///< of the current path
  std::size_t bytes{0};         ///< memory held by the search
  int plans{0};                 ///< found so far
  double best_cost{std::numeric_limits<double>::infinity()};  ///< of the plans found so far
};

/// The caller's answer to "shall I go on?".
enum class Stop { kContinue, kTime, kMemory, kCancelled };
using StopQuestion = std::function<Stop(const Progress&)>;

/// Stops when the search holds more than `max_bytes`; `next` is asked first.
StopQuestion WithMemoryLimit(std::size_t max_bytes, StopQuestion next = {});

enum class Which { kFirst, kAll, kBest };

struct PlanRequest {
  Which which{Which::kFirst};
  std::size_t max_plans{1000};                               ///< kAll stops there
  int max_depth{200'000};                                    ///< longer paths are given up
  double max_cost{std::numeric_limits<double>::infinity()};  ///< dearer paths are given up
  bool decomposition{true};  ///< plans carry their nodes; otherwise steps say node -1
  bool loop_check{true};     ///< give up paths that come back to a state and task network
  bool strict{false};        ///< a warning or doubt is an error
  std::size_t max_trace{0};  ///< reasons kept, the latest ones; 0 keeps none
  /// Where there is no plan, the search is repeated to say which way led furthest and why it ended
  /// (PlanResult::deepest); it takes about twice the time then.
  bool explain{false};
  StopQuestion stop;  ///< asked at least every 256 expansions or 4096 inferences
};

enum class PlanOutcome {
  kFound,   ///< kFirst: a plan; kAll: all there are, or max_plans; kBest: the cheapest
  kNoPlan,  ///< there is none, proven by exhausting the search
  kLimitTime,
  kLimitMemory,
  kCancelled,  ///< stopped by the caller; plans found so far are given
  kLimitDepth,
  kLimitCost,  ///< none found, and paths were given up for that reason
};
std::string_view ToString(PlanOutcome outcome);  ///< "found", "no_plan", "limit_time", ...

/// Why a path was given up.
struct TraceEntry {
  int depth{0};
  std::string task;    ///< as instantiated
  std::string where;   ///< operator or method with its branch, and the line in the domain
  std::string reason;  ///< "no fact or axiom matches goal 3 (on ?x b2) with ?x = b1"
};

struct PlanResult {
  PlanOutcome outcome{PlanOutcome::kNoPlan};
  bool exhausted{false};    ///< the whole search space was seen, so there are no other plans
  std::vector<Plan> plans;  ///< kBest: the cheapest alone
  Progress progress;        ///< at the end; bytes: the most that were ever held
  std::vector<TraceEntry> trace;
  /// Ends of the ways that led furthest, of which there may be several equally far, at most five.
  std::vector<TraceEntry> deepest;
  /// Names in the tasks where these ended that neither a fact nor the domain knows: "'gest1' (did
  /// you mean 'guest1'?)".
  std::vector<std::string> unknown_names;
  std::vector<std::string> warnings;  ///< unknown tasks and functions, none of which was reached
  /// What can hardly be meant: warnings of domain and problem, and predicates asked for that
  /// nothing gives, with what is meant.
  std::vector<std::string> doubts;
};

/// Searches for plans with SHOP2's semantics: tasks are decomposed in the order in which their
/// steps will be executed, so that the state is known at every moment. Deterministic: the same
/// domain, problem and request give the same result. The steps of the plans carry task, cost,
/// bindings and node; AddReasons (reasons.h) fills in preconditions, effects and causal links. A
/// step that matches a fact (imagined_failure action arguments...) of its state is refused.
/// @throws ConfigError where domain and problem do not fit (unknown task or function that is
/// reached, wrong number of arguments, a function that fails), naming file and line.
/// In a file that computes by (call ...) alone, as JSHOP2's do, `functions`, too, are called so.
/// Plans of an HDDL domain are sought without left recursion at first (planner.cpp).
/// Source: Nau et al. 2003, J. Artif. Intell. Res. 20:379-404; order of bindings as SHOP3 4.3.
PlanResult FindPlans(const Domain& domain, const Problem& problem, const PlanRequest& request = {},
                     const Functions& functions = Functions::Standard());

}  // namespace hires::planning
