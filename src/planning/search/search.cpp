#include "planning/search/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"

namespace hires::planning {
namespace {

constexpr std::uint64_t kQuestionEvery = 256;  // expansions

}  // namespace

Search::Search(const Program& program, TermTable* terms, const PlanRequest& request,
               bool left_recursion)
    : program_(program),
      terms_(*terms),
      request_(request),
      left_recursion_(left_recursion),
      bindings_(terms),
      instances_(terms, &bindings_),
      state_(terms),
      network_(terms),
      protections_(terms),
      prover_(program, terms, &bindings_, &instances_, &state_),
      root_methods_{&program.root()},
      protection_word_(terms->Symbol(":protection")),
      failure_word_(terms->Symbol("imagined_failure")) {
  prover_.set_interrupt([this] { return Ask(); });
  for (const Term fact : program.facts()) state_.Add(fact);
  for (const Datum& atom : program.problem().protections) protections_.Add(terms->FromDatum(atom));
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

// --- forward and backward ---

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
  if (!left_recursion_ && IsLeftRecursion(node, task)) {
    gave_up_recursion_ = true;
    if (tracing()) Note(task, "", "comes up again below itself without a step in between");
    return false;
  }
  return PushMethodFrame(node, methods);
}

/// Among the decompositions since the last step, one of an ancestor is of the same task.
bool Search::IsLeftRecursion(std::uint32_t node, Term task) const {
  for (std::size_t i = decompositions_.size(); i-- > 0;) {
    const Decomposition& above = decompositions_[i];
    if (above.num_steps != steps_.size()) return false;
    if (network_.node(above.node).task != task) continue;
    for (std::uint32_t parent = network_.node(node).parent; parent != Network::kNone;
         parent = network_.node(parent).parent) {
      if (parent == above.node) return true;
    }
  }
  return false;
}

// --- questions and messages ---

std::size_t Search::bytes() const {
  return terms_.bytes() + bindings_.bytes() + instances_.bytes() + state_.bytes() +
         network_.bytes() + visited_.bytes() + prover_.bytes() +
         frames_.capacity() * sizeof(Frame) + steps_.capacity() * sizeof(Step) +
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
  progress.best_cost = best_cost_;
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
