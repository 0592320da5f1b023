#include "knowledge/sparql/sparql_plan.h"

#include <algorithm>
#include <cstdint>

namespace hires::knowledge::sparql {
namespace {

/// A set of variables, one bit each.
using Variables = std::uint64_t;

/// How much a pattern leaves to search; only the order counts.
enum Cost {
  kCheck = 0,
  kOfKnownSubject = 1,
  kOfKnownConcept = 2,
  kByLink = 3,
  kByConceptOrText = 4,
  kByNumber = 6,  // no view has an index of numbers
  kAllConcepts = 7,
  kAllFluents = 8,
  kNotJoined = 10,  // on top: multiplies the rows instead of thinning them out
};

Variables Bit(const Term& term) {
  return term.IsVariable() ? Variables{1} << static_cast<unsigned>(term.variable) : 0;
}

Variables BitsOf(const Pattern& pattern) { return Bit(pattern.subject) | Bit(pattern.object); }

bool IsKnown(const Term& term, Variables known) {
  return !term.IsVariable() || (Bit(term) & known) != 0;
}

int TypeCost(bool subject, bool object) {
  if (subject) return object ? kCheck : kOfKnownSubject;
  return object ? kByConceptOrText : kAllFluents;
}

int SubclassCost(bool subject, bool object) {
  if (subject && object) return kCheck;
  return subject || object ? kOfKnownConcept : kAllConcepts;
}

int RoleCost(const Pattern& pattern, bool subject, bool object) {
  if (subject) return object ? kCheck : kOfKnownSubject;
  if (!object) return kAllFluents;
  if (pattern.object.kind == Kind::kInstance) return kByLink;
  const auto* literal = std::get_if<Filler>(&pattern.object.constant);
  const bool is_text = literal != nullptr && std::holds_alternative<std::string>(*literal);
  return is_text ? kByConceptOrText : kByNumber;
}

int CostOf(const Pattern& pattern, Variables known) {
  const bool subject = IsKnown(pattern.subject, known);
  const bool object = IsKnown(pattern.object, known);
  int cost = 0;
  if (pattern.verb == Pattern::Verb::kType) {
    cost = TypeCost(subject, object);
  } else if (pattern.verb == Pattern::Verb::kRole) {
    cost = RoleCost(pattern, subject, object);
  } else {
    cost = SubclassCost(subject, object);
  }
  const bool is_joined = known == 0 || BitsOf(pattern) == 0 || (BitsOf(pattern) & known) != 0;
  return is_joined ? cost : cost + kNotJoined;
}

/// An alternative costs what its cheapest element does, a union what its dearest alternative does.
int CostOf(const Element& element, Variables known) {
  if (!element.IsUnion()) return CostOf(element.pattern, known);
  int dearest = kCheck;
  for (const Group& group : element.alternatives) {
    int cheapest = kAllFluents + kNotJoined;
    for (const Element& inner : group.elements) cheapest = std::min(cheapest, CostOf(inner, known));
    dearest = std::max(dearest, cheapest);
  }
  return dearest;
}

/// The variables that every solution sets.
Variables SetBy(const Element& element) {
  if (!element.IsUnion()) return BitsOf(element.pattern);
  Variables common = ~Variables{0};
  for (const Group& group : element.alternatives) {
    Variables set = 0;
    for (const Element& inner : group.elements) set |= SetBy(inner);
    common &= set;
  }
  return common;
}

Plan PlanGroup(const Group& group, Variables known);

Step PlanElement(const Element& element, Variables known) {
  Step step;
  if (!element.IsUnion()) step.pattern = &element.pattern;
  for (const Group& group : element.alternatives) {
    step.alternatives.push_back(PlanGroup(group, known));
  }
  return step;
}

Plan PlanGroup(const Group& group, Variables known) {
  std::vector<const Element*> left;
  for (const Element& element : group.elements) left.push_back(&element);
  Plan plan;
  while (!left.empty()) {
    const auto best = std::min_element(left.begin(), left.end(), [&](const auto* a, const auto* b) {
      return CostOf(*a, known) < CostOf(*b, known);
    });
    plan.push_back(PlanElement(**best, known));
    known |= SetBy(**best);
    left.erase(best);
  }
  return plan;
}

}  // namespace

Plan MakePlan(const Query& query, bool root_is_known) {
  const Variables root = Variables{1} << static_cast<unsigned>(query.root());
  return PlanGroup(query.where, root_is_known ? root : 0);
}

}  // namespace hires::knowledge::sparql
