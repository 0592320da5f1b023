#include "hires/planning/substitution.h"

namespace hires::planning {

/// The rest of a list from some item on, seen through bound tails.
class Substitution::ListView {
 public:
  ListView(const Substitution& values, const Datum& list) : values_(values), list_(&list) {
    FollowTail();
  }

  bool HasItem() const { return at_ < list_->items.size(); }
  const Datum& item() const { return list_->items[at_]; }
  void Advance() {
    ++at_;
    FollowTail();
  }
  Datum Rest() const {
    if (!list_->IsList()) return *list_;
    Datum rest;
    rest.items.assign(list_->items.begin() + static_cast<std::ptrdiff_t>(at_), list_->items.end());
    rest.tail = list_->tail;
    return rest;
  }

 private:
  /// Ends on an item, on an empty list, or on a tail that is no list.
  void FollowTail() {
    while (list_->IsList() && !HasItem() && !list_->tail.empty()) {
      list_ = &values_.Walk(list_->tail.front());
      at_ = 0;
    }
  }

  const Substitution& values_;
  const Datum* list_;
  std::size_t at_{0};
};

void Substitution::Undo(std::size_t mark) {
  for (; trail_.size() > mark; trail_.pop_back()) values_.erase(trail_.back());
}

const Datum& Substitution::Walk(const Datum& datum) const {
  const Datum* at = &datum;
  while (at->kind == Datum::Kind::kVariable) {
    const auto found = values_.find(at->text);
    if (found == values_.end()) break;
    at = &found->second;
  }
  return *at;
}

Datum Substitution::ApplyToList(const Datum& list) const {
  Datum result;
  result.place = list.place;
  const Datum* part = &list;
  while (part->IsList()) {
    for (const Datum& item : part->items) result.items.push_back(Apply(item));
    if (part->tail.empty()) return result;
    part = &Walk(part->tail.front());
  }
  if (!part->IsNil()) result.tail.push_back(*part);
  return result;
}

Datum Substitution::Apply(const Datum& datum) const {
  const Datum& value = Walk(datum);
  return value.IsList() && !IsGround(value) ? ApplyToList(value) : value;
}

bool Substitution::Unify(const Datum& a, const Datum& b) {
  const std::size_t mark = Mark();
  if (Match(a, b)) return true;
  Undo(mark);
  return false;
}

bool Substitution::Match(const Datum& a, const Datum& b) {
  const Datum& x = Walk(a);
  const Datum& y = Walk(b);
  if (x.kind == Datum::Kind::kVariable) {
    return (y.kind == x.kind && x.text == y.text) || Bind(x.text, y);
  }
  if (y.kind == Datum::Kind::kVariable) return Bind(y.text, x);
  if (x.IsList() && y.IsList()) return MatchLists(x, y);
  return x == y;
}

bool Substitution::MatchLists(const Datum& a, const Datum& b) {
  ListView x(*this, a);
  ListView y(*this, b);
  for (; x.HasItem() && y.HasItem(); x.Advance(), y.Advance()) {
    if (!Match(x.item(), y.item())) return false;
  }
  const Datum rest_of_x = x.Rest();
  const Datum rest_of_y = y.Rest();
  const bool both_end = rest_of_x.IsNil() && rest_of_y.IsNil();
  const bool one_is_longer = rest_of_x.IsList() && rest_of_y.IsList();
  return both_end || (!one_is_longer && Match(rest_of_x, rest_of_y));
}

bool Substitution::Bind(const std::string& variable, const Datum& value) {
  if (Occurs(variable, value)) return false;
  // `value` may lie inside this substitution: copied before anything moves.
  values_.emplace(variable, Datum(value));
  trail_.push_back(variable);
  return true;
}

bool Substitution::Occurs(const std::string& variable, const Datum& datum) const {
  const Datum& value = Walk(datum);
  if (value.kind == Datum::Kind::kVariable) return value.text == variable;
  for (const Datum& item : value.items) {
    if (Occurs(variable, item)) return true;
  }
  return !value.tail.empty() && Occurs(variable, value.tail.front());
}

void CollectVariables(const Datum& datum, std::set<std::string>* names) {
  if (datum.kind == Datum::Kind::kVariable) names->insert(datum.text);
  for (const Datum& item : datum.items) CollectVariables(item, names);
  for (const Datum& tail : datum.tail) CollectVariables(tail, names);
}

Datum RenameVariables(const Datum& datum, const std::string& suffix) {
  if (IsGround(datum)) return datum;
  Datum renamed;
  renamed.kind = datum.kind;
  renamed.place = datum.place;
  if (datum.kind == Datum::Kind::kVariable) renamed.text = datum.text + suffix;
  for (const Datum& item : datum.items) renamed.items.push_back(RenameVariables(item, suffix));
  for (const Datum& tail : datum.tail) renamed.tail.push_back(RenameVariables(tail, suffix));
  return renamed;
}

}  // namespace hires::planning
