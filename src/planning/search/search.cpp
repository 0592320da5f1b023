#include "planning/search/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"

namespace hires::planning {

Search::Search(const Program& program, TermTable* terms, const PlanRequest& request,
               const SearchMode& mode, bool keep_deepest)
    : program_(program),
      mode_(mode),
      path_(program, terms),
      limits_(request, mode.budget),
      explored_(request, &path_, &limits_),
      trace_(program, &path_, request.max_trace, keep_deepest),
      plans_(request, &path_),
      decomposer_(program, request.loop_check, &path_, &limits_, &explored_, &trace_),
      applier_(program, request, &path_, &limits_, &plans_, &trace_),
      root_methods_{&program.root()} {
  path_.prover().set_interrupt([this] { return Ask(); });
  if (mode.most_repeats < SearchMode::kAnyNumber) path_.CountRepeats();
  if (!mode.interleaves) path_.FinishWhatIsBegun();
  if (mode.looks_ahead) decomposer_.LookAhead();
}

PlanResult Search::Run() {
  bool good = Decompose(Network::kRoot, root_methods_);
  while (good || Backward()) good = Forward();
  PlanResult result;
  result.outcome = limits_.Outcome(plans_.size() > 0);
  result.exhausted = limits_.none_reached() && !plans_.enough();
  result.progress = CurrentProgress();
  result.progress.bytes = std::max(limits_.most_bytes(), result.progress.bytes);
  result.plans = plans_.Take();
  result.trace.assign(trace_.entries().begin(), trace_.entries().end());
  result.deepest = trace_.deepest();
  return result;
}

/// One task further, or a plan. False: this path leads nowhere.
bool Search::Forward() {
  const Network& network = path_.network();
  if (network.done()) {
    if (GoalHolds()) plans_.Offer();
    return false;
  }
  if (limits_.IsTooDeep(path_.depth())) {
    trace_.Note(Term(), "", fmt::format("depth limit {} reached", path_.depth()));
    return false;
  }
  const std::uint32_t immediate = network.FirstImmediate();
  if (immediate != 1) return Process(immediate);
  const std::uint32_t fixed = FirstFixed();
  if (fixed != 0) return Process(fixed);
  const std::uint32_t ready = path_.FirstReady();
  const std::uint32_t focus = path_.focus();
  if (path_.NextReady(ready, focus) != 0)
    choices_.emplace_back(TaskChoice{path_.Now(), ready, focus});
  return Process(ready);
}

/// A task of which it makes no difference when it is decomposed, where any could come next; or 0.
/// In SHOP2 the first that is ready comes first, whatever it is.
std::uint32_t Search::FirstFixed() {
  const Network& network = path_.network();
  if (!mode_.interleaves || program_.domain().language != Domain::Language::kHddl) return 0;
  if (network.NextReady(network.FirstReady()) == 0) return 0;
  for (std::uint32_t ready = network.FirstReady(); ready != 0; ready = network.NextReady(ready)) {
    const Term task = network.node(ready).task;
    const auto& methods = program_.Methods(path_.terms().head(task));
    if (methods.size() == 1 && methods[0]->is_fixed) return ready;
  }
  return 0;
}

/// To the last place with another way, and into it.
bool Search::Backward() {
  if (plans_.enough()) return false;
  while (!limits_.stopped() && !choices_.empty()) {
    if (std::visit([this](auto& choice) { return TryNext(&choice); }, choices_.back())) return true;
  }
  return false;
}

bool Search::TryNext(TaskChoice* choice) {
  path_.ReturnTo(choice->moment);
  const std::uint32_t ready = path_.NextReady(choice->node, choice->focus);
  choice->node = ready;
  if (path_.NextReady(ready, choice->focus) == 0) choices_.pop_back();
  return Process(ready);
}

bool Search::TryNext(MethodChoice* choice) {
  const bool good = decomposer_.Next(choice);
  if (!good || !decomposer_.HasMore(*choice)) choices_.pop_back();
  return good;
}

bool Search::Decompose(std::uint32_t node, const std::vector<const CompiledMethod*>& methods) {
  choices_.emplace_back(decomposer_.Begin(node, methods));
  return TryNext(&std::get<MethodChoice>(choices_.back()));
}

bool Search::Process(std::uint32_t node) {
  if (limits_.CountExpansion() && Ask()) return false;
  const Term task = path_.Task(node);
  TermTable& terms = path_.terms();
  const Term name = task.IsPair() ? terms.head(task) : Term();
  if (name.IsNil() || name.kind() != Term::Kind::kSymbol) {
    throw base::ConfigError(
        fmt::format("{}: task {} has no name; a task is a list that begins with one",
                    program_.domain().source, terms.ToString(task)));
  }
  path_.GoDeeper();
  if (terms.text(name).front() == '!') return applier_.Apply(node) && !explored_.IsFutile();
  const auto& methods = MethodsOf(task);
  return !IsGivenUp(node, task) && Decompose(node, methods);
}

const std::vector<const CompiledMethod*>& Search::MethodsOf(Term task) {
  const TermTable& terms = path_.terms();
  const auto& methods = program_.Methods(terms.head(task));
  if (methods.empty()) {
    program_.FailUnhandled(std::string(terms.text(terms.head(task))), terms.ToString(task));
  }
  return methods;
}

bool Search::IsGivenUp(std::uint32_t node, Term task) {
  const bool is_bounded = mode_.most_repeats < SearchMode::kAnyNumber;
  if (!is_bounded || path_.NumRepeats(node, task, mode_.repeats_across_steps) <= mode_.most_repeats)
    return false;
  gave_up_recursion_ = true;
  trace_.Note(task, "", "comes up again below itself in the same state");
  return true;
}

/// What the problem asks for besides its tasks.
bool Search::GoalHolds() {
  if (program_.goal() == nullptr) return true;
  Prover& prover = path_.prover();
  const std::size_t floor = prover.num_choices();
  const std::uint32_t variables = path_.bindings().Make(program_.goal_slots());
  if (!prover.Solve(program_.goal(), variables, true)) {
    trace_.Note(Term(), program_.problem().source, "the problem's goal does not hold in the end");
    return false;
  }
  prover.Cut(floor);
  return true;
}

Progress Search::CurrentProgress() const {
  Progress progress;
  progress.expansions = limits_.expansions();
  progress.inferences = path_.prover().inferences();
  progress.depth = path_.depth();
  progress.cost = path_.cost();
  progress.bytes = path_.bytes() + explored_.bytes() + choices_.capacity() * sizeof(Choice);
  progress.plans = static_cast<int>(plans_.size());
  progress.best_cost = plans_.best_cost();
  return progress;
}

/// True to stop.
bool Search::Ask() { return limits_.Ask(CurrentProgress()); }

}  // namespace hires::planning
