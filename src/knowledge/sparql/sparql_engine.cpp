#include "knowledge/sparql/sparql_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/overloaded.h"
#include "hires/base/text.h"

namespace hires::knowledge::sparql {
namespace {

using ConceptId = Ontology::ConceptId;

constexpr int kMaxRows = 1'000'000;
constexpr std::size_t kMaxCells = 4'000'000;

/// Exact also where a double cannot hold the integer.
bool SameNumber(double real, std::int64_t integer) {
  constexpr double kTwoTo63 = 9223372036854775808.0;
  if (!(real >= -kTwoTo63 && real < kTwoTo63) || std::trunc(real) != real) return false;
  return static_cast<std::int64_t>(real) == integer;
}

bool SameLiteral(const Filler& a, const Filler& b) {
  return std::visit(base::Overloaded{
                        [](const std::string& x, const std::string& y) {
                          return base::ToLower(x) == base::ToLower(y);
                        },
                        [](double x, double y) { return x == y; },
                        [](std::int64_t x, std::int64_t y) { return x == y; },
                        [](double x, std::int64_t y) { return SameNumber(x, y); },
                        [](std::int64_t x, double y) { return SameNumber(y, x); },
                        [](bool x, bool y) { return x == y; },
                        [](const auto&, const auto&) { return false; },
                    },
                    a, b);
}

std::string TextOf(const Filler& literal) {
  return std::visit(
      base::Overloaded{[](const std::string& text) { return text; },
                       [](bool value) { return std::string(value ? "true" : "false"); },
                       [](double value) { return fmt::format("{}", value + 0.0); },
                       [](std::int64_t value) { return fmt::format("{}", value); }},
      literal);
}

/// The value of a property, as a pattern's object sees it; monostate where it is of another kind.
Value ValueOf(const Property& property, Kind wanted) {
  if (property.IsLink() != (wanted == Kind::kInstance)) return {};
  if (wanted == Kind::kLiteral) return property.filler;
  const auto* name = std::get_if<std::string>(&property.filler);
  return name == nullptr ? Value() : Value(Instance{base::ToLower(*name)});
}

bool HasRole(const Fluent& fluent, const std::string& role) {
  return std::any_of(fluent.properties.begin(), fluent.properties.end(),
                     [&](const Property& property) { return property.role == role; });
}

/// Finds solutions depth first, so that only one row is held at a time. Functions that return bool
/// say whether to go on.
class Solver {
 public:
  using Next = std::function<bool()>;

  /// @param view  Null: only what is supposed is known, every relation is taken to hold.
  Solver(const Query& query, const Ontology& ontology, const FluentView* view)
      : query_(query), ontology_(ontology), view_(view), row_(query.variables.size()) {}

  void BindRoot(Value value) { row_[static_cast<std::size_t>(query_.root())] = std::move(value); }
  void Suppose(int variable, ConceptId concept_id) {
    supposed_variable_ = variable;
    supposed_concept_ = concept_id;
  }
  const std::vector<Value>& row() const { return row_; }

  void ForEach(const Plan& plan, const Next& visit) {
    visit_ = &visit;
    Solve({&plan, 0, nullptr});
  }

 private:
  /// How far a plan is worked through, and what comes behind its end.
  struct Progress {
    const Plan* plan;
    std::size_t next;
    const Progress* outer;
  };

  bool Solve(const Progress& progress);
  bool SolveUnion(const Step& step, const Progress& rest);
  bool Match(const Pattern& pattern, const Next& next);
  bool MatchRelaxed(const Pattern& pattern, const Next& next);
  bool MatchType(const Pattern& pattern, const Next& next);
  bool MatchTypeOf(const Fluent& fluent, const Pattern& pattern, const Next& next);
  bool MatchSubclass(const Pattern& pattern, const Next& next);
  bool MatchAbove(ConceptId below, const Pattern& pattern, const Next& next);
  bool MatchBelow(ConceptId above, const Pattern& pattern, const Next& next);
  bool MatchRole(const Pattern& pattern, const Next& next);
  bool MatchRoleOf(const Fluent& fluent, const Pattern& pattern, const Next& next);
  void SearchRole(const Pattern& pattern, const std::function<bool(const Fluent&)>& visit);
  bool IsSubclass(ConceptId below, ConceptId above, Pattern::Verb verb) const;

  const Value* Known(const Term& term) const;
  bool Unify(const Term& term, const Value& value, const Next& next);

  const Query& query_;
  const Ontology& ontology_;
  const FluentView* view_;
  std::vector<Value> row_;
  int supposed_variable_{kNoVariable};
  ConceptId supposed_concept_{Ontology::kUnknown};
  const Next* visit_{nullptr};
  int num_rows_{0};
};

bool Solver::Solve(const Progress& progress) {
  if (progress.next == progress.plan->size()) {
    return progress.outer == nullptr ? (*visit_)() : Solve(*progress.outer);
  }
  const Step& step = (*progress.plan)[progress.next];
  const Progress rest{progress.plan, progress.next + 1, progress.outer};
  if (step.pattern == nullptr) return SolveUnion(step, rest);
  return Match(*step.pattern, [this, &rest] { return Solve(rest); });
}

bool Solver::SolveUnion(const Step& step, const Progress& rest) {
  return std::all_of(step.alternatives.begin(), step.alternatives.end(), [&](const Plan& plan) {
    return Solve({&plan, 0, &rest});
  });
}

bool Solver::Match(const Pattern& pattern, const Next& next) {
  if (view_ == nullptr &&
      (pattern.verb == Pattern::Verb::kType || pattern.verb == Pattern::Verb::kRole)) {
    return MatchRelaxed(pattern, next);
  }
  if (pattern.verb == Pattern::Verb::kType) return MatchType(pattern, next);
  if (pattern.verb == Pattern::Verb::kRole) return MatchRole(pattern, next);
  return MatchSubclass(pattern, next);
}

bool Solver::MatchRelaxed(const Pattern& pattern, const Next& next) {
  const bool is_supposed =
      pattern.verb == Pattern::Verb::kType && pattern.subject.variable == supposed_variable_;
  return is_supposed ? Unify(pattern.object, supposed_concept_, next) : next();
}

const Value* Solver::Known(const Term& term) const {
  const Value& value =
      term.IsVariable() ? row_[static_cast<std::size_t>(term.variable)] : term.constant;
  return std::holds_alternative<std::monostate>(value) ? nullptr : &value;
}

bool Solver::Unify(const Term& term, const Value& value, const Next& next) {
  if (const Value* known = Known(term)) return SameValue(*known, value) ? next() : true;
  if (++num_rows_ > kMaxRows) {
    throw base::ConfigError(
        fmt::format("query: came more than {} intermediate rows, wanted fewer; name concepts or "
                    "relations that join its variables",
                    kMaxRows));
  }
  Value& place = row_[static_cast<std::size_t>(term.variable)];
  place = value;
  const bool go_on = next();
  place = std::monostate();
  return go_on;
}

bool Solver::MatchType(const Pattern& pattern, const Next& next) {
  const auto visit = [&](const Fluent& fluent) { return MatchTypeOf(fluent, pattern, next); };
  if (const Value* subject = Known(pattern.subject)) {
    const Fluent* fluent = view_->Find(std::get<Instance>(*subject).key);
    return fluent == nullptr || visit(*fluent);
  }
  bool go_on = true;
  const auto search = [&](const Fluent& fluent) { return go_on = visit(fluent); };
  if (const Value* object = Known(pattern.object)) {
    view_->OfConcept(ontology_.Name(std::get<ConceptId>(*object)), search);
  } else {
    view_->All(search);
  }
  return go_on;
}

bool Solver::MatchTypeOf(const Fluent& fluent, const Pattern& pattern, const Next& next) {
  const ConceptId stated = ontology_.Find(fluent.concept_name);
  if (stated == Ontology::kUnknown) return true;
  return Unify(pattern.subject, Instance{base::ToLower(fluent.instance)},
               [&] { return Unify(pattern.object, stated, next); });
}

bool Solver::MatchSubclass(const Pattern& pattern, const Next& next) {
  if (const Value* subject = Known(pattern.subject)) {
    return MatchAbove(std::get<ConceptId>(*subject), pattern, next);
  }
  if (const Value* object = Known(pattern.object)) {
    return MatchBelow(std::get<ConceptId>(*object), pattern, next);
  }
  for (ConceptId below = 0; below < ontology_.num_concepts(); ++below) {
    if (!Unify(pattern.subject, below, [&] { return MatchAbove(below, pattern, next); })) {
      return false;
    }
  }
  return true;
}

bool Solver::MatchAbove(ConceptId below, const Pattern& pattern, const Next& next) {
  if (const Value* object = Known(pattern.object)) {
    return !IsSubclass(below, std::get<ConceptId>(*object), pattern.verb) || next();
  }
  for (const ConceptId above : ontology_.Above(below)) {
    if (IsSubclass(below, above, pattern.verb) && !Unify(pattern.object, above, next)) return false;
  }
  return true;
}

bool Solver::MatchBelow(ConceptId above, const Pattern& pattern, const Next& next) {
  for (const ConceptId below : ontology_.Below(above)) {
    if (IsSubclass(below, above, pattern.verb) && !Unify(pattern.subject, below, next))
      return false;
  }
  return true;
}

bool Solver::IsSubclass(ConceptId below, ConceptId above, Pattern::Verb verb) const {
  if (!ontology_.IsA(below, above)) return false;
  if (verb == Pattern::Verb::kSubclassStar) return true;
  if (below == above) return false;
  if (verb == Pattern::Verb::kSubclassPlus) return true;
  const auto& between = ontology_.Above(below);
  return std::none_of(between.begin(), between.end(), [&](ConceptId other) {
    return other != below && other != above && ontology_.IsA(other, above);
  });
}

bool Solver::MatchRole(const Pattern& pattern, const Next& next) {
  if (const Value* subject = Known(pattern.subject)) {
    const Fluent* fluent = view_->Find(std::get<Instance>(*subject).key);
    return fluent == nullptr || MatchRoleOf(*fluent, pattern, next);
  }
  bool go_on = true;
  SearchRole(pattern, [&](const Fluent& fluent) {
    if (!HasRole(fluent, pattern.role)) return true;  // no row: it counts for nothing
    return go_on = Unify(pattern.subject, Instance{base::ToLower(fluent.instance)},
                         [&] { return MatchRoleOf(fluent, pattern, next); });
  });
  return go_on;
}

void Solver::SearchRole(const Pattern& pattern, const std::function<bool(const Fluent&)>& visit) {
  const Value* object = Known(pattern.object);
  if (object == nullptr) return view_->All(visit);
  const auto* instance = std::get_if<Instance>(object);
  // A copy: the value may be unset and set again below.
  const Filler filler = instance != nullptr ? Filler(instance->key) : std::get<Filler>(*object);
  view_->WithFiller(pattern.role, filler, visit);
}

bool Solver::MatchRoleOf(const Fluent& fluent, const Pattern& pattern, const Next& next) {
  for (const Property& property : fluent.properties) {
    if (property.role != pattern.role) continue;
    const Value value = ValueOf(property, pattern.object.kind);
    if (std::holds_alternative<std::monostate>(value)) continue;
    if (!Unify(pattern.object, value, next)) return false;
  }
  return true;
}

std::string NameOf(const Value& value, const FluentView& view, const Ontology& ontology) {
  if (const auto* concept_id = std::get_if<ConceptId>(&value)) return ontology.Name(*concept_id);
  if (const auto* literal = std::get_if<Filler>(&value)) return TextOf(*literal);
  const auto* instance = std::get_if<Instance>(&value);
  if (instance == nullptr) return "";
  const Fluent* fluent = view.Find(instance->key);
  return fluent != nullptr ? fluent->instance : instance->key;
}

[[noreturn]] void FailTooLarge() {
  throw base::ConfigError(fmt::format(
      "query: came an answer of more than {} names, wanted fewer; select less", kMaxCells));
}

}  // namespace

bool SameValue(const Value& a, const Value& b) {
  return std::visit(base::Overloaded{
                        [](const Instance& x, const Instance& y) { return x.key == y.key; },
                        [](ConceptId x, ConceptId y) { return x == y; },
                        [](const Filler& x, const Filler& y) { return SameLiteral(x, y); },
                        [](const auto&, const auto&) { return false; },
                    },
                    a, b);
}

Engine::Engine(std::string_view text, std::shared_ptr<const Ontology> ontology)
    : ontology_(std::move(ontology)),
      query_(ReadQuery(text, *ontology_)),
      search_(MakePlan(query_, false)),
      check_(MakePlan(query_, true)) {}

std::vector<std::vector<std::string>> Engine::Select(const FluentView& view) const {
  std::set<std::vector<std::string>> rows;
  Solver solver(query_, *ontology_, &view);
  solver.ForEach(search_, [&] {
    std::vector<std::string> row;
    for (const int variable : query_.selected) {
      row.push_back(NameOf(solver.row()[static_cast<std::size_t>(variable)], view, *ontology_));
    }
    rows.insert(std::move(row));
    if (rows.size() * query_.selected.size() > kMaxCells) FailTooLarge();
    return true;
  });
  return {rows.begin(), rows.end()};
}

std::vector<std::string> Engine::Instances(const FluentView& view) const {
  const auto root = static_cast<std::size_t>(query_.root());
  std::set<std::string> names;
  Solver solver(query_, *ontology_, &view);
  solver.ForEach(search_, [&] {
    names.insert(NameOf(solver.row()[root], view, *ontology_));
    return true;
  });
  return {names.begin(), names.end()};
}

bool Engine::Accepts(const FluentView& view, const std::string& candidate) const {
  bool is_accepted = false;
  Solver solver(query_, *ontology_, &view);
  solver.BindRoot(Instance{base::ToLower(candidate)});
  solver.ForEach(check_, [&] {
    is_accepted = true;
    return false;
  });
  return is_accepted;
}

bool Engine::MayBe(int variable, Ontology::ConceptId concept_id) const {
  bool may = false;
  Solver solver(query_, *ontology_, nullptr);
  solver.Suppose(variable, concept_id);
  solver.ForEach(check_, [&] {
    may = true;
    return false;
  });
  return may;
}

}  // namespace hires::knowledge::sparql
