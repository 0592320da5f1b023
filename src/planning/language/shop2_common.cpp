#include <fmt/format.h>

#include <map>
#include <utility>

#include "hires/planning/datum_reader.h"
#include "planning/language/shop2_parts.h"

namespace hires::planning::shop2 {
namespace {

bool BindsVariables(const Datum& datum) {
  const std::string_view head = datum.Head();
  return (head == "forall" || head == "shop-forall" || head == "exists") && datum.items.size() >= 3;
}

/// Walks through an item once; what a quantifier binds gets a new name below it.
class Renamer {
 public:
  void Rename(Datum* datum) {
    if (datum->kind == Datum::Kind::kVariable) return RenameVariable(datum);
    std::vector<std::pair<std::string, std::string>> hidden;
    if (BindsVariables(*datum)) hidden = Bind(datum->items[1]);
    for (Datum& item : datum->items) Rename(&item);
    for (Datum& item : datum->tail) Rename(&item);
    for (auto it = hidden.rbegin(); it != hidden.rend(); ++it) Restore(it->first, it->second);
  }

 private:
  static bool IsAnonymous(const std::string& name) {
    return name == "?" || name.compare(0, 2, "?_") == 0;
  }

  std::string Fresh(const std::string& name) { return fmt::format("{}#{}", name, ++count_); }

  void RenameVariable(Datum* variable) {
    const auto found = names_.find(variable->text);
    if (found != names_.end()) {
      variable->text = found->second;
    } else if (IsAnonymous(variable->text)) {
      variable->text = Fresh("?_");
    }
  }

  /// What stood for each name before, in the order of binding.
  std::vector<std::pair<std::string, std::string>> Bind(const Datum& variables) {
    std::vector<std::string> names;
    CollectVariables(variables, &names);
    std::vector<std::pair<std::string, std::string>> hidden;
    for (const std::string& name : names) {
      std::string& current = names_[name];
      hidden.emplace_back(name, current);
      current = Fresh(name);
    }
    return hidden;
  }

  void Restore(const std::string& name, const std::string& before) {
    if (before.empty()) {
      names_.erase(name);
    } else {
      names_[name] = before;
    }
  }

  std::map<std::string, std::string> names_;
  int count_{0};
};

/// (f a b) out of (call f a b), (call #'f a b) and (call 'f a b).
void RemoveCall(Datum* call) {
  call->items.erase(call->items.begin());
  const Datum& function = call->items[0];
  const bool is_quoted = function.Head() == "function" || function.Head() == "quote";
  if (is_quoted && function.items.size() == 2) call->items[0] = Datum(function.items[1]);
}

void RemoveCalls(Datum* expression) {
  if (expression->Head() == "quote") return;
  if (expression->Head() == "call" && expression->items.size() >= 2) RemoveCall(expression);
  for (Datum& item : expression->items) RemoveCalls(&item);
}

}  // namespace

void Fail(const Construct& in, Place place, const std::string& text) {
  FailAt(in.source, place, in.name + ": " + text);
}

void FailAbout(const Construct& in, const Datum& datum, std::string_view wanted) {
  Fail(in, datum.place, fmt::format("came {}, wanted {}", Excerpt(datum), wanted));
}

Datum WithOwnNames(Datum item) {
  Renamer().Rename(&item);
  return item;
}

void CheckTerm(const Construct& in, const Datum& datum, std::string_view wanted) {
  const std::string_view head = datum.Head();
  if (head.empty() || head[0] == ':') FailAbout(in, datum, wanted);
}

void CheckAtom(const Construct& in, const Datum& datum, std::string_view wanted) {
  CheckTerm(in, datum, wanted);
  const std::string_view head = datum.Head();
  if (!IsLogicalWord(head)) return;
  Fail(in, datum.place,
       fmt::format("'{}' is a logical word and cannot be a name; wanted {}", head, wanted));
}

Datum ReadExpression(Datum datum) {
  RemoveCalls(&datum);
  return datum;
}

Datum Unquoted(Datum term) {
  if (term.Head() == "call") return term;
  if (term.Head() == "quote" && term.items.size() == 2) return Unquoted(Datum(term.items[1]));
  for (Datum& item : term.items) item = Unquoted(std::move(item));
  for (Datum& tail : term.tail) tail = Unquoted(std::move(tail));
  return term;
}

void CollectVariables(const Datum& datum, std::vector<std::string>* variables) {
  if (datum.kind == Datum::Kind::kVariable) variables->push_back(datum.text);
  for (const Datum& item : datum.items) CollectVariables(item, variables);
  for (const Datum& item : datum.tail) CollectVariables(item, variables);
}

}  // namespace hires::planning::shop2
