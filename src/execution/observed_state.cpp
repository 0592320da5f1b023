#include "execution/observed_state.h"

#include <algorithm>

#include "execution/step_effects.h"
#include "hires/base/text.h"

namespace hires::execution {
namespace {

void CollectNames(const base::Atom& atom, std::set<std::string>* names) {
  for (const std::string& argument : atom.arguments) names->insert(base::ToLower(argument));
}

}  // namespace

ObservedState::ObservedState(const planning::Domain& domain)
    : changing_(ChangingPredicates(domain)) {}

void ObservedState::Observe(const StateObserved& state) {
  observed_ = Facts(state.atoms);
  facts_ = observed_;
  for (const planning::PlanStep& step : bookkeeping_) ApplyEffects(step, &facts_);
  for (const base::Atom& atom : state.atoms) CollectNames(atom, &instances_);
  is_known_ = true;
  ++revision_;
}

void ObservedState::ObserveUntil(double time) {
  observed_until_ = std::max(observed_until_.value_or(time), time);
}

void ObservedState::Note(const planning::PlanStep& bookkeeping) {
  bookkeeping_.push_back(bookkeeping);
  ApplyEffects(bookkeeping, &facts_);
  ++revision_;
}

void ObservedState::ForgetNotes() {
  bookkeeping_.clear();
  facts_ = observed_;
}

void ObservedState::Know(const std::set<std::string>& instances) {
  instances_.insert(instances.begin(), instances.end());
}

}  // namespace hires::execution
