#include "planning/proof/instantiator.h"

namespace hires::planning {
namespace {

/// The variables of a frame, for expressions.
class FrameValues : public VariableValues {
 public:
  FrameValues(Bindings* bindings, std::uint32_t frame) : bindings_(*bindings), frame_(frame) {}
  Term Value(int slot) override {
    return bindings_.Resolve(Instantiator::Variable(frame_, static_cast<std::uint32_t>(slot)));
  }

 private:
  Bindings& bindings_;
  std::uint32_t frame_;
};

}  // namespace

Term Instantiator::Evaluate(const Expression& expression, std::uint32_t frame) {
  FrameValues values(&bindings_, frame);
  return expression.Evaluate(&terms_, &values);
}

Term Instantiator::Build(const Pattern& pattern, std::uint32_t frame) {
  switch (pattern.kind) {
    case Pattern::Kind::kConstant:
      return pattern.constant;
    case Pattern::Kind::kSlot: {
      const Term value = bindings_.Deref(Variable(frame, pattern.slot));
      return terms_.IsGround(value) ? value : bindings_.Resolve(value);
    }
    case Pattern::Kind::kCall:
      return Evaluate(*pattern.call, frame);
    case Pattern::Kind::kPair:
      break;
  }
  const std::size_t first = items_.size();
  const Pattern* rest = &pattern;
  for (; rest->kind == Pattern::Kind::kPair; rest = rest->tail) {
    const Term item = Build(*rest->head, frame);
    items_.push_back(item);
  }
  Term list = Build(*rest, frame);
  while (items_.size() > first) {
    list = terms_.Pair(items_.back(), list);
    items_.pop_back();
  }
  return list;
}

bool Instantiator::Match(const Pattern& pattern, std::uint32_t frame, Term term) {
  const Pattern* rest = &pattern;
  for (; rest->kind == Pattern::Kind::kPair; rest = rest->tail) {
    term = bindings_.Deref(term);
    if (!term.IsPair()) return term.IsVariable() && bindings_.Unify(term, Build(*rest, frame));
    if (!Match(*rest->head, frame, terms_.head(term))) return false;
    term = terms_.tail(term);
  }
  switch (rest->kind) {
    case Pattern::Kind::kConstant:
      return rest->constant == term || bindings_.Unify(rest->constant, term);
    case Pattern::Kind::kSlot:
      return bindings_.Unify(Variable(frame, rest->slot), term);
    default:
      return bindings_.Unify(Build(*rest, frame), term);
  }
}

bool Instantiator::CouldMatch(const Pattern& pattern, Term term) const {
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

}  // namespace hires::planning
