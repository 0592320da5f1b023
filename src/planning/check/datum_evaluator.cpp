#include "hires/planning/datum_evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "hires/base/error.h"

namespace hires::planning {

/// Numbers for the variables of one expression, and for the unbound ones that their values hold.
class DatumEvaluator::Slots : public VariableValues {
 public:
  Slots(DatumEvaluator* evaluator, const Substitution& values)
      : evaluator_(evaluator), values_(values) {}

  int Number(const std::string& variable) {
    const auto found = std::find(names_.begin(), names_.end(), variable);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
    names_.push_back(variable);
    return static_cast<int>(names_.size()) - 1;
  }

  Term Value(int slot) override {
    return evaluator_->ToTerm(values_.Apply(MakeVariable(names_[slot])), this);
  }

  const std::string& Name(Term variable) const { return names_.at(variable.index()); }

 private:
  DatumEvaluator* evaluator_;
  const Substitution& values_;
  std::vector<std::string> names_;
};

DatumEvaluator::DatumEvaluator(const Functions& functions, std::string source)
    : functions_(functions), source_(std::move(source)) {}

Term DatumEvaluator::ToTerm(const Datum& datum, Slots* slots) {
  if (datum.kind == Datum::Kind::kVariable) {
    return Term(Term::Kind::kVariable, static_cast<std::uint32_t>(slots->Number(datum.text)));
  }
  if (!datum.IsList()) return terms_.FromDatum(datum);
  Term list = datum.tail.empty() ? Term() : ToTerm(datum.tail.front(), slots);
  for (auto item = datum.items.rbegin(); item != datum.items.rend(); ++item) {
    list = terms_.Pair(ToTerm(*item, slots), list);
  }
  return list;
}

Datum DatumEvaluator::ToDatum(Term term, const Slots& slots) const {
  if (term.IsVariable()) return MakeVariable(slots.Name(term));
  if (!term.IsPair()) return terms_.ToDatum(term);
  Datum list;
  for (; term.IsPair(); term = terms_.tail(term)) {
    list.items.push_back(ToDatum(terms_.head(term), slots));
  }
  if (!term.IsNil()) list.tail.push_back(ToDatum(term, slots));
  return list;
}

Datum DatumEvaluator::Evaluate(const Datum& expression, const Substitution& values) {
  const std::size_t mark = terms_.Mark();
  Slots slots(this, values);
  const auto slot_of = [&slots](const std::string& name) { return slots.Number(name); };
  Datum value;
  {
    const Expression ready(expression, slot_of, functions_, &terms_, source_);
    value = ToDatum(ready.Evaluate(&terms_, &slots), slots);
  }
  terms_.Release(mark);
  return value;
}

double DatumEvaluator::EvaluateCost(const Datum& expression, const Substitution& values) {
  if (expression.IsNil()) return 1.0;
  const Datum cost = Evaluate(expression, values);
  if (cost.kind == Datum::Kind::kInteger) return static_cast<double>(cost.integer);
  if (cost.kind == Datum::Kind::kReal) return cost.real;
  throw base::ConfigError(fmt::format("{}:{}:{}: the cost {} has the value {}, wanted a number",
                                      source_, expression.place.line, expression.place.column,
                                      ToString(expression), ToString(cost)));
}

Datum DatumEvaluator::Instantiate(const Datum& pattern, const Substitution& values) {
  if (!HasCall(pattern)) return values.Apply(pattern);
  if (pattern.Head() == "call") {
    Datum expression = pattern;
    expression.items.erase(expression.items.begin());
    return Evaluate(expression, values);
  }
  Datum result = pattern;
  for (Datum& item : result.items) item = Instantiate(item, values);
  return values.Apply(result);
}

bool HasCall(const Datum& pattern) {
  return pattern.Head() == "call" ||
         std::any_of(pattern.items.begin(), pattern.items.end(), HasCall);
}

}  // namespace hires::planning
