#include "hires/planning/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"

namespace hires::planning {
namespace {

constexpr std::uint64_t kQuestionEvery = 256;  // expansions

std::uint64_t Mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t x = a * 0x9e3779b97f4a7c15ULL + b;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  return x ^ (x >> 32);
}

}  // namespace

Search::Search(const Program& program, TermTable* terms, const PlanRequest& request)
    : program_(program),
      terms_(*terms),
      request_(request),
      bindings_(terms),
      state_(terms),
      network_(terms),
      protections_(terms),
      prover_(program, terms, &bindings_, &state_),
      root_methods_{&program.root()},
      protection_word_(terms->Symbol(":protection")),
      failure_word_(terms->Symbol("imagined_failure")) {
  prover_.set_interrupt([this] { return Ask(); });
  for (const Term fact : program.facts()) state_.Add(fact);
}

PlanResult Search::Run() {
  bool good = PushMethodFrame(Network::kRoot, root_methods_);
  while (good || Backward()) good = Forward();
  PlanResult result;
  result.outcome = Outcome();
  result.exhausted = stop_ == Stop::kContinue && !enough_ && !too_deep_ && !too_dear_;
  result.plans = std::move(plans_);
  result.progress = CurrentProgress();
  result.progress.bytes = std::max(most_bytes_, bytes());
  result.progress.plans = static_cast<int>(result.plans.size());
  result.trace.assign(trace_.begin(), trace_.end());
  return result;
}

PlanOutcome Search::Outcome() const {
  switch (stop_) {
    case Stop::kTime:
      return PlanOutcome::kLimitTime;
    case Stop::kMemory:
      return PlanOutcome::kLimitMemory;
    case Stop::kCancelled:
      return PlanOutcome::kCancelled;
    case Stop::kContinue:
      break;
  }
  if (!plans_.empty()) return PlanOutcome::kFound;
  if (too_deep_) return PlanOutcome::kLimitDepth;
  if (too_dear_) return PlanOutcome::kLimitCost;
  return PlanOutcome::kNoPlan;
}

// --- forward and backward
// --------------------------------------------------------------------------

Search::Moment Search::Now() {
  return {bindings_.Remember(),
          prover_.Remember(),
          state_.Remember(),
          network_.Remember(),
          protections_.Remember(),
          visited_.Remember(),
          terms_.Mark(),
          network_.size(),
          steps_.size(),
          decompositions_.size(),
          prover_.num_choices(),
          depth_,
          cost_};
}

void Search::Return(const Moment& moment) {
  network_.Undo(moment.tasks, moment.nodes);
  state_.Undo(moment.state);
  protections_.Undo(moment.protections);
  visited_.Undo(moment.visited);
  steps_.resize(moment.num_steps);
  decompositions_.resize(moment.num_decompositions);
  depth_ = moment.depth;
  cost_ = moment.cost;
}

/// One task further, or a plan. False: this path leads nowhere.
bool Search::Forward() {
  if (network_.done()) return FoundPlan();
  if (depth_ >= request_.max_depth) {
    too_deep_ = true;
    Note(Term(), "", fmt::format("depth limit {} reached", request_.max_depth));
    return false;
  }
  const std::uint32_t immediate = network_.FirstImmediate();
  if (immediate != 1) return Process(immediate);
  const std::uint32_t ready = network_.FirstReady();
  if (network_.NextReady(ready) != 0) PushTaskFrame(ready);
  return Process(ready);
}

/// To the last place with another way, and into it.
bool Search::Backward() {
  if (enough_ || stop_ != Stop::kContinue) return false;
  while (!frames_.empty()) {
    if (ReturnTo(&frames_.back())) return true;
    if (stop_ != Stop::kContinue) return false;
  }
  return false;
}

bool Search::ReturnTo(Frame* frame) {
  if (!frame->choose_task) return NextWay(frame);
  Return(frame->moment);
  bindings_.Undo(frame->moment.bindings);
  terms_.Release(frame->moment.pairs);
  const std::uint32_t ready = network_.NextReady(frame->node);
  frame->node = ready;
  if (network_.NextReady(ready) == 0) frames_.pop_back();
  return Process(ready);
}

void Search::PushTaskFrame(std::uint32_t node) {
  Frame& frame = frames_.emplace_back();
  frame.moment = Now();
  frame.node = node;
  frame.choose_task = true;
}

bool Search::Process(std::uint32_t node) {
  if (++expansions_ % kQuestionEvery == 0 && Ask()) return false;
  const Term task = bindings_.Resolve(network_.node(node).task);
  const Term name = task.IsPair() ? terms_.head(task) : Term();
  if (name.IsNil() || name.kind() != Term::Kind::kSymbol) {
    throw base::ConfigError(
        fmt::format("{}: task {} has no name; a task is a list that begins with one",
                    program_.domain().source, terms_.ToString(task)));
  }
  ++depth_;
  if (terms_.text(name).front() == '!') return Apply(node);
  const auto& methods = program_.Methods(name);
  if (methods.empty()) {
    throw base::ConfigError(fmt::format("{}: task {} has no method in domain '{}'",
                                        program_.domain().source, terms_.ToString(task),
                                        program_.domain().name));
  }
  return PushMethodFrame(node, methods);
}

// --- methods
// ---------------------------------------------------------------------------------------

bool Search::PushMethodFrame(std::uint32_t node,
                             const std::vector<const CompiledMethod*>& methods) {
  Frame& frame = frames_.emplace_back();
  frame.moment = Now();
  frame.node = node;
  frame.methods = &methods;
  frame.branch = kNotEntered;
  frame.method = NextFitting(frame, 0);
  return NextWay(&frame);
}

/// Whether a head might match, without binding anything: constants and shapes agree.
bool Search::CouldMatch(const Pattern& pattern, Term term) const {
  term = bindings_.Deref(term);
  if (term.IsVariable()) return true;
  switch (pattern.kind) {
    case Pattern::Kind::kConstant:
      return pattern.constant == term || !terms_.IsGround(term);
    case Pattern::Kind::kPair:
      return term.IsPair() && CouldMatch(*pattern.head, terms_.head(term)) &&
             CouldMatch(*pattern.tail, terms_.tail(term));
    default:
      return true;
  }
}

std::uint32_t Search::NextFitting(const Frame& frame, std::uint32_t from) const {
  const Term task = network_.node(frame.node).task;
  while (from < frame.methods->size() && !CouldMatch(*(*frame.methods)[from]->head, task)) ++from;
  return from;
}

/// The next decomposition of the frame's task: another first task of the same reduction, another
/// binding of the same branch, another branch while none had a binding, another method. The frame
/// goes when it has no other.
bool Search::NextWay(Frame* frame) {
  for (;;) {
    if (frame->num_variants > frame->variant + 1) {
      ++frame->variant;
      Return(frame->solution);
      bindings_.Undo(frame->solution.bindings);
      terms_.Release(frame->solution.pairs);
      prover_.Release(frame->solution.prover);
      BuildTasks(*frame);
      if (Reduce(frame)) return true;
      continue;
    }
    frame->num_variants = frame->variant = 0;
    if (frame->branch != kNotEntered) {
      Return(frame->moment);
      if (NextSolution(frame)) {
        if (UseSolution(frame)) return true;
        continue;
      }
      if (stop_ != Stop::kContinue) return false;
      if (!frame->solved && NextBranch(frame)) {
        if (UseSolution(frame)) return true;
        continue;
      }
      if (stop_ != Stop::kContinue) return false;
      frame->method = NextFitting(*frame, frame->method + 1);
    }
    if (frame->method >= frame->methods->size()) {
      frames_.pop_back();
      return false;
    }
    Return(frame->moment);
    bindings_.Undo(frame->moment.bindings);
    terms_.Release(frame->moment.pairs);
    prover_.Release(frame->moment.prover);
    if (EnterMethod(frame) && NextBranch(frame)) {
      if (UseSolution(frame)) return true;
    }
    if (stop_ != Stop::kContinue) return false;
  }
}

bool Search::EnterMethod(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  frame->solved = false;
  frame->sorted = false;
  frame->solutions.clear();
  frame->tried.clear();
  frame->branch = static_cast<std::uint32_t>(method.branches.size());  // as if all had been tried
  frame->variables = bindings_.Make(method.num_slots);
  const Term task = bindings_.Resolve(network_.node(frame->node).task);
  if (!prover_.Match(*method.head, frame->variables, task)) {
    if (tracing()) Note(task, Where(method, 0), "the head does not match the task");
    return false;
  }
  frame->entered = bindings_.Remember();
  frame->branch = kNotEntered;
  return true;
}

/// The first binding of the next branch that has one.
bool Search::NextBranch(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  frame->branch = frame->branch == kNotEntered ? 0 : frame->branch + 1;
  for (; frame->branch < method.branches.size(); ++frame->branch) {
    bindings_.Undo(frame->entered);
    const CompiledPrecondition& precondition = method.branches[frame->branch].precondition;
    if (tracing()) prover_.set_tracing(&method.variables);
    bool found = false;
    if (precondition.order == Precondition::Order::kSortBy) {
      found = GatherSorted(frame, precondition, method.num_slots);
    } else {
      const bool first = precondition.order == Precondition::Order::kFirst;
      found = prover_.Solve(precondition.goals, frame->variables, first);
      if (found && first) prover_.Cut(frame->moment.choices);
    }
    prover_.set_tracing(nullptr);
    if (found) {
      frame->solved = true;
      return true;
    }
    if (prover_.interrupted()) return false;
    if (tracing()) {
      Note(network_.node(frame->node).task, Where(method, frame->branch),
           prover_.furthest().empty() ? "the precondition has no binding"
                                      : "no binding satisfies " + prover_.furthest());
    }
  }
  return false;
}

/// Another binding of the same branch.
bool Search::NextSolution(Frame* frame) {
  if (!frame->solved) return false;
  if (frame->sorted) {
    const std::size_t width = (*frame->methods)[frame->method]->num_slots;
    if (frame->next_solution * width >= frame->solutions.size()) return false;
    bindings_.Undo(frame->entered);
    const Term* values = &frame->solutions[frame->next_solution++ * width];
    for (std::uint32_t i = 0; i < width; ++i) {
      bindings_.Unify(Term(Term::Kind::kVariable, frame->variables + i), values[i]);
    }
    return true;
  }
  return prover_.num_choices() > frame->moment.choices && prover_.Next(frame->moment.choices);
}

/// All bindings of a :sort-by, in order; binds the first.
bool Search::GatherSorted(Frame* frame, const CompiledPrecondition& precondition,
                          std::uint32_t slots) {
  struct Entry {
    Term key;
    std::size_t first;
  };
  std::vector<Entry> entries;
  std::vector<Term> values;
  const std::size_t floor = prover_.num_choices();
  prover_.HoldPairs(true);
  bool found = prover_.Solve(precondition.goals, frame->variables, false);
  for (; found; found = prover_.num_choices() > floor && prover_.Next(floor)) {
    entries.push_back({prover_.Evaluate(*precondition.sort_key, frame->variables), values.size()});
    for (std::uint32_t i = 0; i < slots; ++i) {
      values.push_back(bindings_.Resolve(Term(Term::Kind::kVariable, frame->variables + i)));
    }
  }
  prover_.HoldPairs(false);
  if (entries.empty() || prover_.interrupted()) return false;
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    return !precondition.comparison->function(&terms_, {a.key, b.key}).IsNil();
  });
  frame->solutions.clear();
  for (const Entry& entry : entries) {
    frame->solutions.insert(frame->solutions.end(), values.begin() + entry.first,
                            values.begin() + entry.first + slots);
  }
  frame->moment.pairs = terms_.Mark();  // the solutions have to stay
  frame->sorted = frame->solved = true;
  frame->next_solution = 0;
  return NextSolution(frame);
}

/// Lays out the reduction for the binding just found, unless it has been tried already.
bool Search::UseSolution(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  const CompiledBranch& branch = method.branches[frame->branch];
  BuildTasks(*frame);
  const bool others = frame->sorted || prover_.num_choices() > frame->moment.choices;
  if (others || !frame->tried.empty()) {
    std::uint64_t key = tasks_.size();
    for (const Term task : tasks_) key = key * 0x9e3779b97f4a7c15ULL + terms_.Hash(task);
    if (std::find(frame->tried.begin(), frame->tried.end(), key) != frame->tried.end()) {
      return false;
    }
    frame->tried.push_back(key);
  }
  const bool free = program_.immediate_reductions() && frame->node != Network::kRoot &&
                    !branch.subtasks->first_is_immediate;
  frame->num_variants = free ? branch.subtasks->num_first : 0;
  frame->variant = 0;
  if (frame->num_variants > 1) frame->solution = Now();
  return Reduce(frame);
}

void Search::BuildTasks(const Frame& frame) {
  tasks_.clear();
  const CompiledMethod& method = *(*frame.methods)[frame.method];
  BuildTasks(*method.branches[frame.branch].subtasks, frame.variables);
}

void Search::BuildTasks(const CompiledNetwork& network, std::uint32_t variables) {
  for (const CompiledNetwork::Item& item : network.items) {
    if (item.network != nullptr) {
      BuildTasks(*item.network, variables);
    } else {
      tasks_.push_back(prover_.Build(*item.task, variables));
    }
  }
}

/// Lays out `tasks_`.
bool Search::Reduce(Frame* frame) {
  const CompiledMethod& method = *(*frame->methods)[frame->method];
  const CompiledNetwork& subtasks = *method.branches[frame->branch].subtasks;
  decompositions_.push_back({frame->node, &method, frame->branch, frame->variables, steps_.size()});
  const std::uint32_t node = frame->node;
  network_.Decompose(node, &subtasks, tasks_,
                     frame->num_variants > 0 ? static_cast<int>(frame->variant) : -1);
  if (request_.loop_check && WasHere()) {
    if (tracing()) {
      Note(network_.node(node).task, Where(method, frame->branch),
           "leads back to a state and tasks that this path has been through");
    }
    return false;
  }
  if (!HasMore(*frame)) frames_.pop_back();
  return true;
}

bool Search::WasHere() {
  if (!network_.all_ground()) return false;
  const std::uint64_t key = state_.hash() + 0x9e3779b97f4a7c15ULL * network_.hash() +
                            0xd6e8feb86659fd93ULL * protections_.hash();
  return !visited_.Insert(key);
}

bool Search::HasMore(const Frame& frame) const {
  return frame.num_variants > frame.variant + 1 ||
         (frame.sorted && frame.next_solution * (*frame.methods)[frame.method]->num_slots <
                              frame.solutions.size()) ||
         prover_.num_choices() > frame.moment.choices ||
         NextFitting(frame, frame.method + 1) < frame.methods->size();
}

// --- operators
// -------------------------------------------------------------------------------------

bool Search::Apply(std::uint32_t node) {
  const Term task = bindings_.Resolve(network_.node(node).task);
  const CompiledOperator* applied = program_.FindOperator(terms_.head(task));
  if (applied == nullptr) {
    throw base::ConfigError(fmt::format("{}: step {} has no operator in domain '{}'",
                                        program_.domain().source, terms_.ToString(task),
                                        program_.domain().name));
  }
  const std::uint32_t variables = bindings_.Make(applied->num_slots);
  if (!prover_.Match(*applied->head, variables, task)) {
    if (tracing()) Note(task, Where(*applied), "the head does not match the step");
    return false;
  }
  if (tracing()) prover_.set_tracing(&applied->variables);
  const bool found = FindBinding(applied->precondition, variables, applied->num_slots);
  prover_.set_tracing(nullptr);
  if (!found) {
    if (tracing() && !prover_.interrupted()) {
      Note(task, Where(*applied), "no binding satisfies " + prover_.furthest());
    }
    return false;
  }
  const Term ground = bindings_.Resolve(network_.node(node).task);
  if (IsExcluded(ground)) {
    if (tracing()) Note(ground, Where(*applied), "the state says imagined_failure of this step");
    return false;
  }
  const double cost = CostOf(*applied, variables);
  if (TooDear(cost_ + cost)) {
    if (tracing()) Note(ground, Where(*applied), fmt::format("cost {} is too high", cost_ + cost));
    return false;
  }
  deletes_.clear();
  adds_.clear();
  Collect(applied->deletes, variables, &deletes_);
  Collect(applied->adds, variables, &adds_);
  if (BreaksProtection() || !Change(*applied)) {
    if (tracing()) Note(ground, Where(*applied), "a protected fact would not hold any more");
    return false;
  }
  cost_ += cost;
  steps_.push_back({node, applied, variables, cost});
  network_.Finish(node);
  return true;
}

/// One binding: the newest fact first, or the first in the order of a :sort-by.
bool Search::FindBinding(const CompiledPrecondition& precondition, std::uint32_t variables,
                         std::uint32_t slots) {
  const std::size_t floor = prover_.num_choices();
  const Prover::Mark mark = prover_.Remember();
  if (precondition.order == Precondition::Order::kSortBy) {
    Frame frame;
    frame.variables = variables;
    frame.moment = Now();
    frame.entered = bindings_.Remember();
    if (!GatherSorted(&frame, precondition, slots)) return false;
    return true;
  }
  if (!prover_.Solve(precondition.goals, variables, true)) return false;
  prover_.Cut(floor);
  prover_.Release(mark);
  return true;
}

bool Search::IsExcluded(Term task) const {
  if (state_.Candidates(failure_word_, nullptr, 0).oldest == State::kNone) return false;
  const std::string& name = terms_.text(terms_.head(task));
  const std::string plain = name.substr(name.find_first_not_of('!'));
  for (const std::string& spelling : {name, plain, "!" + plain}) {
    const Term call = terms_.Pair(terms_.Symbol(spelling), terms_.tail(task));
    if (state_.Holds(terms_.FindPair(failure_word_, call))) return true;
  }
  return false;
}

double Search::CostOf(const CompiledOperator& applied, std::uint32_t variables) {
  if (applied.cost == nullptr) return applied.fixed_cost;
  const Term value = prover_.Evaluate(*applied.cost, variables);
  const double cost = value.IsNumber() ? terms_.number(value) : 1.0;
  if (cost < 0.0 && request_.which == Which::kBest) {
    throw base::ConfigError(fmt::format(
        "{}: cost {} is below 0; the cheapest plan can only be found where no step earns anything",
        Where(applied), cost));
  }
  return cost;
}

bool Search::TooDear(double cost) {
  if (cost > request_.max_cost) {
    too_dear_ = true;
    return true;
  }
  return request_.which == Which::kBest && cost >= best_cost_;
}

/// The atoms an operator adds or deletes, in the order of the file.
void Search::Collect(const std::vector<CompiledEffect>& effects, std::uint32_t variables,
                     std::vector<Term>* atoms) {
  for (const CompiledEffect& effect : effects) {
    switch (effect.kind) {
      case Effect::Kind::kForall:
        CollectForAll(effect, variables, atoms);
        break;
      case Effect::Kind::kAtom:
        atoms->push_back(prover_.Build(*effect.pattern, variables));
        break;
      case Effect::Kind::kProtection:
        atoms->push_back(terms_.Pair(
            protection_word_, terms_.Pair(prover_.Build(*effect.pattern, variables), Term())));
        break;
      case Effect::Kind::kList: {
        Term list = prover_.Build(*effect.pattern, variables);
        for (; list.IsPair(); list = terms_.tail(list)) atoms->push_back(terms_.head(list));
        break;
      }
    }
  }
}

void Search::CollectForAll(const CompiledEffect& effect, std::uint32_t variables,
                           std::vector<Term>* atoms) {
  const std::size_t floor = prover_.num_choices();
  const Prover::Mark mark = prover_.Remember();
  const Bindings::Mark bindings = bindings_.Remember();
  prover_.HoldPairs(true);
  bool found = prover_.Solve(effect.condition, variables, false);
  for (; found; found = prover_.num_choices() > floor && prover_.Next(floor)) {
    Collect(effect.effects, variables, atoms);
  }
  prover_.HoldPairs(false);
  bindings_.Undo(bindings);
  prover_.Release(mark);
}

bool Search::IsProtection(Term atom) const {
  return atom.IsPair() && terms_.head(atom) == protection_word_;
}

void Search::RequireGround(const CompiledOperator& applied, Term atom) const {
  if (atom.IsPair() && terms_.IsGround(atom) && terms_.head(atom).kind() == Term::Kind::kSymbol) {
    return;
  }
  throw base::ConfigError(fmt::format(
      "{}: operator {} adds {}, which is no fact without variables; bind them in its precondition",
      Where(applied), terms_.ToString(terms_.Symbol(applied.source->head.Head())),
      terms_.ToString(atom)));
}

/// Without changing anything: a protected fact would go for good.
bool Search::BreaksProtection() const {
  if (protections_.empty() || std::any_of(deletes_.begin(), deletes_.end(), [this](Term atom) {
        return IsProtection(atom);  // it might be the one that protects
      })) {
    return false;
  }
  return std::any_of(deletes_.begin(), deletes_.end(), [this](Term atom) {
    return protections_.Count(atom) > 0 && program_.Axioms(terms_.head(atom)).empty() &&
           std::find(adds_.begin(), adds_.end(), atom) == adds_.end();
  });
}

/// Deletes, then adds (the last one listed first, so it is the oldest), then protections.
bool Search::Change(const CompiledOperator& applied) {
  for (const Term atom : deletes_) {
    if (IsProtection(atom)) {
      protections_.Remove(terms_.head(terms_.tail(atom)));
    } else {
      state_.Remove(atom);
    }
  }
  for (std::size_t i = adds_.size(); i-- > 0;) {
    RequireGround(applied, adds_[i]);
    if (!IsProtection(adds_[i])) state_.Add(adds_[i]);
  }
  return (protections_.empty() || ProtectionsHold()) && Protect();
}

bool Search::ProtectionsHold() {
  const bool lost = std::any_of(deletes_.begin(), deletes_.end(), [&](Term atom) {
    return protections_.Count(atom) > 0 && !state_.Holds(atom) &&
           program_.Axioms(terms_.head(atom)).empty();
  });
  if (lost) return false;
  return protections_.AllOf([&](Term atom) {
    return program_.Axioms(terms_.head(atom)).empty() || prover_.Proves(atom);
  });
}

bool Search::Protect() {
  for (std::size_t i = adds_.size(); i-- > 0;) {
    if (!IsProtection(adds_[i])) continue;
    const Term atom = terms_.head(terms_.tail(adds_[i]));
    if (!state_.Holds(atom) && !prover_.Proves(atom)) return false;
    protections_.Add(atom);
  }
  return true;
}

// --- plans
// -----------------------------------------------------------------------------------------

bool Search::FoundPlan() {
  if (program_.goal() != nullptr) {
    const std::size_t floor = prover_.num_choices();
    const std::uint32_t variables = bindings_.Make(program_.goal_slots());
    if (!prover_.Solve(program_.goal(), variables, true)) {
      Note(Term(), program_.problem().source, "the problem's goal does not hold in the end");
      return false;
    }
    prover_.Cut(floor);
  }
  if (request_.which == Which::kAll && !plan_keys_.insert(PlanKey()).second) return false;
  if (request_.which == Which::kBest) {
    plans_.clear();
    best_cost_ = cost_;
  }
  plans_.push_back(Extract());
  enough_ = request_.which == Which::kFirst ||
            (request_.which == Which::kAll && plans_.size() >= request_.max_plans);
  return false;
}

/// The same for plans with the same steps in the same order and the same decomposition: those that
/// differ only in when a task was found to need no step are one plan.
std::uint64_t Search::PlanKey() {
  std::vector<std::uint64_t> way(network_.size(), 0);
  for (const Decomposition& decomposition : decompositions_) {
    way[decomposition.node] =
        1 + 64 * static_cast<std::uint64_t>(decomposition.method->index + 1) + decomposition.branch;
  }
  std::uint64_t key = 0;
  for (std::uint32_t node = Network::kRoot; node < network_.size(); ++node) {
    const Network::Node& source = network_.node(node);
    const std::uint64_t parent = source.parent == Network::kNone ? 0 : way[source.parent];
    const std::uint64_t task = terms_.Hash(bindings_.Resolve(source.task));
    way[node] = Mix(Mix(Mix(parent, source.item), way[node]), task);
    key += Mix(way[node], 0);
  }
  for (const Step& step : steps_) key = Mix(key, way[step.node]);
  return key;
}

std::vector<std::pair<std::string, Datum>> Search::Values(const std::vector<std::string>& names,
                                                          std::uint32_t first,
                                                          std::uint32_t variables) {
  std::vector<std::pair<std::string, Datum>> values;
  for (std::uint32_t i = first; i < names.size(); ++i) {
    const Term value = bindings_.Resolve(Term(Term::Kind::kVariable, variables + i));
    if (terms_.IsGround(value)) values.emplace_back(names[i], terms_.ToDatum(value));
  }
  return values;
}

Plan Search::Extract() {
  Plan plan;
  plan.cost = cost_;
  plan.steps.reserve(steps_.size());
  std::vector<int> number(network_.size(), -1);
  if (request_.decomposition) ExtractNodes(&plan, &number);
  for (const Step& step : steps_) {
    PlanStep& fresh = plan.steps.emplace_back();
    fresh.task = terms_.ToDatum(bindings_.Resolve(network_.node(step.node).task));
    fresh.cost = step.cost;
    fresh.node = number[step.node];
    fresh.bindings = Values(step.applied->variables, step.applied->num_head_slots, step.variables);
    if (fresh.node >= 0) plan.nodes[fresh.node].step = static_cast<int>(plan.steps.size()) - 1;
  }
  return plan;
}

int Search::AddNode(std::uint32_t node, int parent, Plan* plan, std::vector<int>* number) {
  const int self = static_cast<int>(plan->nodes.size());
  (*number)[node] = self;
  PlanNode& fresh = plan->nodes.emplace_back();
  if (node != Network::kRoot) {
    fresh.task = terms_.ToDatum(bindings_.Resolve(network_.node(node).task));
  }
  fresh.parent = parent;
  if (parent >= 0) plan->nodes[parent].children.push_back(self);
  return self;
}

void Search::ExtractNodes(Plan* plan, std::vector<int>* number) {
  plan->nodes.reserve(network_.size());
  std::vector<std::pair<std::uint32_t, int>> open{
      {Network::kRoot, -1}};  // node, parent in the plan
  while (
      !open.empty()) {  // not by recursion: methods that call themselves nest as deep as plans go
    auto [node, self] = open.back();
    open.pop_back();
    const Network::Node& source = network_.node(node);
    if (node == Network::kRoot || !source.task.IsNil()) self = AddNode(node, self, plan, number);
    if (source.first_child == Network::kNone) continue;
    for (auto i = static_cast<std::uint32_t>(source.subtasks->items.size()); i-- > 0;) {
      open.emplace_back(source.first_child + i, self);
    }
  }
  for (const Decomposition& decomposition : decompositions_) {
    PlanNode& node = plan->nodes[(*number)[decomposition.node]];
    node.method = decomposition.method->index;
    node.branch = static_cast<int>(decomposition.branch);
    const Branch& branch = *decomposition.method->branches[decomposition.branch].source;
    node.label = branch.label;
    if (node.label.empty() && decomposition.method->source != nullptr) {
      node.label = decomposition.method->source->name;
    }
    node.at_step = static_cast<int>(decomposition.num_steps);
    node.bindings = Values(decomposition.method->variables, decomposition.method->num_head_slots,
                           decomposition.variables);
  }
}

// --- questions and messages
// ------------------------------------------------------------------------

std::size_t Search::bytes() const {
  return terms_.bytes() + bindings_.bytes() + state_.bytes() + network_.bytes() + visited_.bytes() +
         prover_.bytes() + frames_.capacity() * sizeof(Frame) + steps_.capacity() * sizeof(Step) +
         decompositions_.capacity() * sizeof(Decomposition);
}

Progress Search::CurrentProgress() const {
  Progress progress;
  progress.expansions = expansions_;
  progress.inferences = prover_.inferences();
  progress.depth = depth_;
  progress.cost = cost_;
  progress.bytes = bytes();
  progress.plans = static_cast<int>(plans_.size());
  for (const Plan& plan : plans_) progress.best_cost = std::min(progress.best_cost, plan.cost);
  return progress;
}

/// True to stop.
bool Search::Ask() {
  const Progress progress = CurrentProgress();
  most_bytes_ = std::max(most_bytes_, progress.bytes);
  if (request_.stop && stop_ == Stop::kContinue) stop_ = request_.stop(progress);
  return stop_ != Stop::kContinue;
}

std::string Search::Where(const CompiledMethod& method, std::uint32_t branch) const {
  if (method.source == nullptr) return program_.problem().source;
  const Branch& tried = *method.branches[branch].source;
  return fmt::format("{}:{}: method {}, branch {}{}", program_.domain().source, tried.place.line,
                     method.source->head.Head(), branch + 1,
                     tried.label.empty() ? "" : " '" + tried.label + "'");
}

std::string Search::Where(const CompiledOperator& applied) const {
  return fmt::format("{}:{}: operator {}", program_.domain().source, applied.source->place.line,
                     applied.source->head.Head());
}

void Search::Note(Term task, const std::string& where, const std::string& reason) {
  if (!tracing()) return;
  if (trace_.size() == request_.max_trace) trace_.pop_front();
  trace_.push_back(
      {depth_, task.IsNil() ? "" : terms_.ToString(bindings_.Resolve(task)), where, reason});
}

}  // namespace hires::planning
