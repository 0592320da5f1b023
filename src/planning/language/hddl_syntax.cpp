#include "planning/language/hddl_syntax.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"

namespace hires::planning::hddl {
namespace {

/// What the published domains write, misspellings and all.
const std::vector<std::string>& KnownRequirements() {
  static const std::vector<std::string> known{":action-costs",
                                              ":adl",
                                              ":conditional-effects",
                                              ":disjunctive-preconditions",
                                              ":equality",
                                              ":hierarchy",
                                              ":htn",
                                              ":existential-preconditions",
                                              ":hierachie",
                                              ":hierarchie",
                                              ":htn-method-prec",
                                              ":method-constraints",
                                              ":method-preconditions",
                                              ":partial-order",
                                              ":quantified-preconditions",
                                              ":negative-preconditions",
                                              ":strips",
                                              ":total-order",
                                              ":typeof-predicate",
                                              ":typing",
                                              ":universal-effects",
                                              ":universal-preconditions"};
  return known;
}

/// Also in the singular, as in `:method-precondition`.
bool IsKnownRequirement(const std::string& name) {
  const std::vector<std::string>& known = KnownRequirements();
  return std::any_of(known.begin(), known.end(), [&name](const std::string& candidate) {
    return candidate == name || candidate == name + "s";
  });
}

bool CanBeName(const Datum& datum) {
  if (datum.kind != Datum::Kind::kSymbol || datum.text.empty()) return false;
  static const std::set<std::string> reserved{"-", "=", "<", "quote", "unquote", "backquote"};
  return reserved.count(datum.text) == 0 &&
         std::string_view("!%:").find(datum.text[0]) == std::string_view::npos;
}

bool IsForm(const Datum& datum, std::string_view kind) {
  return datum.IsList() && datum.Head() == "define" && datum.items.size() >= 2 &&
         datum.items[1].IsList() && datum.items[1].Head() == kind;
}

std::vector<std::string> ReadTypes(const HddlSpot& spot, const Datum& type) {
  if (!type.IsList()) return {RequireName(spot, type, "a type")};
  if (type.Head() != "either" || type.items.size() < 2) {
    spot.Fail(type,
              fmt::format("{} stands for a type; write a type or (either a b)", Excerpt(type)));
  }
  std::vector<std::string> types;
  for (std::size_t i = 1; i < type.items.size(); ++i) {
    types.push_back(RequireName(spot, type.items[i], "a type"));
  }
  return types;
}

/// An entry of a list whose entries are separated by commas, which are no part of HDDL.
const Datum& WithoutComma(const Datum& item) {
  return item.Head() == "unquote" && item.items.size() == 2 ? item.items[1] : item;
}

/// `-`, or glued to what follows, as in `?p -plate`.
bool IsDash(const Datum& item) {
  return item.kind == Datum::Kind::kSymbol && item.text.compare(0, 1, "-") == 0;
}

/// What stands behind the dash at `*index`, to which that moves.
Datum TypeBehindDash(const HddlSpot& spot, const Datum& list, std::size_t* index) {
  Datum dash = WithoutComma(list.items[*index]);
  if (dash.text.size() == 1) {
    if (++*index == list.items.size()) spot.Fail(dash, "a '-' has no type behind it; add one");
    return WithoutComma(list.items[*index]);
  }
  dash.text.erase(0, 1);
  ++dash.place.column;
  return dash;
}

void RequireKind(const HddlSpot& spot, const Datum& datum, Datum::Kind kind) {
  if (kind == Datum::Kind::kSymbol) {
    RequireName(spot, datum, "a name");
  } else if (datum.kind != Datum::Kind::kVariable) {
    spot.Fail(datum, fmt::format("{} stands among the parameters; write a variable such as ?x",
                                 Excerpt(datum)));
  }
}

/// More would make work that grows with the square of their number felt.
constexpr std::size_t kMaxVariables = 1000;

void RequireFew(const HddlSpot& spot, const Datum& list, std::size_t count) {
  if (count <= kMaxVariables) return;
  spot.Fail(list, fmt::format("{} variables are declared here, at most {} are read", count,
                              kMaxVariables));
}

void RequireUnique(const HddlSpot& spot, const std::vector<HddlTyped>& typed) {
  std::set<std::string> seen;
  for (const HddlTyped& entry : typed) {
    if (!seen.insert(entry.datum->text).second) {
      spot.Fail(*entry.datum, fmt::format("'{}' stands twice; keep one", entry.datum->text));
    }
  }
}

}  // namespace

void HddlSpot::Fail(const Datum& at, const std::string& text) const {
  FailAt(source, at.place, construct + ": " + text);
}

const Datum& RequireList(const HddlSpot& spot, const Datum& datum, std::string_view wanted) {
  if (!datum.IsList()) spot.Fail(datum, fmt::format("{} came, wanted {}", Excerpt(datum), wanted));
  if (!datum.tail.empty()) {
    spot.Fail(datum, fmt::format("{} has a dot, which HDDL does not know; wanted {}",
                                 Excerpt(datum), wanted));
  }
  return datum;
}

const std::string& RequireName(const HddlSpot& spot, const Datum& datum, std::string_view what) {
  if (!CanBeName(datum)) {
    spot.Fail(datum, fmt::format("{} stands where {} is wanted; names begin with a letter",
                                 Excerpt(datum), what));
  }
  return datum.text;
}

std::vector<HddlTyped> ReadTypedList(const HddlSpot& spot, const Datum& list, std::size_t begin,
                                     Datum::Kind kind, bool unique) {
  std::vector<HddlTyped> typed;
  std::size_t untyped = 0;  // first entry whose type is still to come
  for (std::size_t i = begin; i < list.items.size(); ++i) {
    const Datum& item = WithoutComma(list.items[i]);
    if (!IsDash(item)) {
      RequireKind(spot, item, kind);
      typed.push_back({&item, {}, item.place});
      continue;
    }
    if (untyped == typed.size()) spot.Fail(item, "a '-' has no name before it; take it away");
    const Datum type = TypeBehindDash(spot, list, &i);
    const std::vector<std::string> types = ReadTypes(spot, type);
    for (; untyped < typed.size(); ++untyped) {
      typed[untyped].types = types;
      typed[untyped].type_place = type.place;
    }
  }
  if (kind == Datum::Kind::kVariable) RequireFew(spot, list, typed.size());
  if (unique) RequireUnique(spot, typed);
  return typed;
}

HddlFields::HddlFields(HddlSpot spot, const Datum& form, std::size_t begin,
                       const std::vector<std::string>& known)
    : spot_(std::move(spot)), form_(&form) {
  for (std::size_t i = begin; i < form.items.size(); i += 2) {
    const Datum& name = form.items[i];
    if (name.kind != Datum::Kind::kSymbol || name.text[0] != ':') {
      spot_.Fail(name, fmt::format("{} came, wanted one of {}; is a parenthesis missing?",
                                   Excerpt(name), base::Join(known, " ")));
    }
    if (std::find(known.begin(), known.end(), name.text) == known.end()) {
      spot_.Fail(name, base::UnknownName("field", name.text, known));
    }
    if (i + 1 == form.items.size()) {
      spot_.Fail(name, fmt::format("{} has no value; write {} (...)", name.text, name.text));
    }
    if (!values_.emplace(name.text, &form.items[i + 1]).second) {
      spot_.Fail(name, fmt::format("{} stands twice; keep one", name.text));
    }
  }
}

const Datum* HddlFields::Find(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : found->second;
}

const Datum& HddlFields::Require(const std::string& name) const {
  const Datum* value = Find(name);
  if (value == nullptr) spot_.Fail(*form_, fmt::format("{} is missing; add it", name));
  return *value;
}

const Datum* HddlFields::FindOneOf(const std::vector<std::string>& names) const {
  const Datum* found = nullptr;
  for (const std::string& name : names) {
    const Datum* value = Find(name);
    if (value == nullptr) continue;
    if (found != nullptr) {
      spot_.Fail(*value, fmt::format("two of {} stand here; keep one", base::Join(names, ", ")));
    }
    found = value;
  }
  return found;
}

bool LacksAnd(const Datum& datum) {
  return datum.IsList() && !datum.items.empty() && datum.items[0].IsList() &&
         !datum.items[0].items.empty();
}

std::vector<const Datum*> Conjuncts(const HddlSpot& spot, const Datum& datum) {
  RequireList(spot, datum, "(and ...) or ()");
  if (datum.items.empty()) return {};
  if (datum.Head() != "and" && !LacksAnd(datum)) return {&datum};
  std::vector<const Datum*> parts;
  for (std::size_t i = LacksAnd(datum) ? 0 : 1; i < datum.items.size(); ++i)
    parts.push_back(&datum.items[i]);
  return parts;
}

HddlDefinition ReadDefinition(std::string_view text, const std::string& source,
                              std::string_view kind) {
  std::vector<Datum> data = ReadData(text, source);
  const HddlSpot spot{source, fmt::format("HDDL {}", kind)};
  Datum* found = nullptr;
  for (Datum& datum : data) {
    if (!IsForm(datum, "domain") && !IsForm(datum, "problem")) {
      spot.Fail(datum,
                fmt::format("{} stands outside of (define ({} ...) ...)", Excerpt(datum), kind));
    }
    if (!IsForm(datum, kind)) continue;
    if (found != nullptr) {
      spot.Fail(datum, fmt::format("a second (define ({} ...) ...) stands here, the first in line "
                                   "{}; keep one in a file",
                                   kind, found->place.line));
    }
    found = &datum;
  }
  if (found == nullptr) {
    FailAt(source, {1, 1},
           fmt::format("there is no (define ({0} ...) ...) here; is it the file of "
                       "a {1}?",
                       kind, kind == "domain" ? "problem" : "domain"));
  }
  const Datum& head = RequireList(spot, found->items[1], fmt::format("({} name)", kind));
  if (head.items.size() != 2) {
    spot.Fail(head, fmt::format("{} came, wanted ({} name)", Excerpt(head), kind));
  }
  std::string name = RequireName(spot, head.items[1], "a name");
  return {std::move(*found), std::move(name)};
}

void CheckRequirements(const HddlSpot& spot, const Datum& section,
                       std::vector<std::string>* warnings) {
  std::vector<std::string> unknown;
  Place first;
  for (std::size_t i = 1; i < section.items.size(); ++i) {
    const Datum& item = section.items[i];
    if (item.kind != Datum::Kind::kSymbol || item.text.rfind(':', 0) != 0) {
      spot.Fail(item, fmt::format("{} came, wanted keywords such as {}", Excerpt(item),
                                  base::Join(KnownRequirements(), " ")));
    }
    if (IsKnownRequirement(item.text)) continue;
    if (unknown.empty()) first = item.place;
    unknown.push_back(Excerpt(item));
  }
  if (unknown.empty()) return;
  warnings->push_back(Located(
      spot.source, first,
      fmt::format("{}: {} {} not supported, and refused where the file makes use of it; take it "
                  "away if it does without",
                  spot.construct, base::Join(unknown, " "), unknown.size() == 1 ? "is" : "are")));
}

}  // namespace hires::planning::hddl
