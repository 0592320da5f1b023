#include "planning/proof/solution_collector.h"

#include <fmt/format.h>

#include <utility>

namespace hires::planning {

SolutionCollector::SolutionCollector(const Program& program, TermTable* terms,
                                     Instantiator* instances, Bindings* bindings, ProofStack* stack)
    : program_(program),
      terms_(*terms),
      instances_(*instances),
      bindings_(*bindings),
      stack_(*stack) {}

std::vector<std::uint32_t> SolutionCollector::Unbound(const Goal* goal) {
  std::vector<std::uint32_t> slots;
  for (const std::uint32_t slot : goal->slots) {
    const Term variable = Instantiator::Variable(stack_.at().frame, slot);
    if (!terms_.IsGround(bindings_.Resolve(variable))) slots.push_back(slot);
  }
  return slots;
}

void SolutionCollector::Start(const Goal* goal) {
  Collection fresh;
  fresh.goal = goal;
  fresh.frame = stack_.at().frame;
  if (goal->kind != Goal::Kind::kCollect) fresh.unbound = Unbound(goal);
  stack_.Push(Choice::Kind::kCollect, goal);
  collections_.push_back(std::move(fresh));
  stack_.HoldPairs(true);  // what is gathered has to survive
  stack_.at().newest_first = false;
  stack_.PushContinuation(ProofStack::Continuation::Kind::kCollect, nullptr,
                          stack_.num_choices() - 1);
}

void SolutionCollector::SetPart(const Goal* goal, std::uint32_t disjunct) {
  if (collections_.empty()) return;
  Collection& newest = collections_.back();
  if (newest.goal == goal && newest.frame == stack_.at().frame) newest.part = disjunct;
}

void SolutionCollector::Record(const Choice& choice) {
  Collection& collection = collections_.back();
  const Goal* goal = collection.goal;
  const std::size_t first = collection.values.size();
  if (goal->kind == Goal::Kind::kCollect) {
    collection.values.push_back(instances_.Build(*goal->patterns[0], collection.frame));
  }
  for (const std::uint32_t slot : collection.unbound) {
    collection.values.push_back(bindings_.Resolve(Instantiator::Variable(collection.frame, slot)));
  }
  std::uint64_t hash = collection.part;
  for (std::size_t i = first; i < collection.values.size(); ++i) {
    const Term value = collection.values[i];
    const bool outer = value.IsVariable() && value.index() < choice.bindings.variables;
    if (!terms_.IsGround(value) && !outer) {
      program_.Fail(*goal->source,
                    fmt::format("a solution leaves a variable unbound in {}; bind it inside",
                                terms_.ToString(value)));
    }
    hash = hash * 0x9e3779b97f4a7c15ULL + terms_.Hash(value);
  }
  if (!goal->bag && !collection.seen.insert(hash).second) collection.values.resize(first);
}

SolutionCollector::Collection SolutionCollector::TakeNewest() {
  Collection collection = std::move(collections_.back());
  collections_.pop_back();
  stack_.HoldPairs(false);
  stack_.Pop();
  return collection;
}

bool SolutionCollector::Finish() {
  const Collection collection = TakeNewest();
  const Goal* goal = collection.goal;
  stack_.at().goal = goal->next;
  if (collection.values.empty()) return false;
  if (goal->kind == Goal::Kind::kCollect) {
    const Term list =
        terms_.List(collection.values.data(), collection.values.data() + collection.values.size());
    return bindings_.Unify(instances_.Build(*goal->patterns[1], stack_.at().frame), list);
  }
  std::vector<Term>& tuples = stack_.tuples();
  const auto first = static_cast<std::uint32_t>(tuples.size());
  tuples.insert(tuples.end(), collection.values.begin(), collection.values.end());
  Choice& choice = stack_.Push(Choice::Kind::kTuples, goal);  // the tuples stay with it
  choice.tuples = first;
  choice.next =
      static_cast<std::uint32_t>(collection.values.size() / collection.unbound.size()) - 1;
  return NextTuple();
}

bool SolutionCollector::NextTuple() {
  Choice& choice = stack_.top();
  const Goal* goal = choice.goal;
  const std::vector<std::uint32_t> slots = Unbound(goal);
  const std::size_t first = choice.tuples + choice.next * slots.size();
  if (choice.next-- == 0) stack_.Pop();
  stack_.at().goal = goal->next;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Term variable = Instantiator::Variable(stack_.at().frame, slots[i]);
    if (!bindings_.Unify(variable, stack_.tuples()[first + i])) return false;
  }
  return true;
}

void SolutionCollector::Clear() {
  for (; !collections_.empty(); collections_.pop_back()) stack_.HoldPairs(false);
}

}  // namespace hires::planning
