#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"

namespace hires::knowledge::sparql {

/// What a variable or constant stands for. Its place in the patterns tells which.
enum class Kind { kInstance, kConcept, kLiteral };

struct Instance {
  std::string key;  ///< its name in lower case: names compare without regard to case
};
using Value = std::variant<std::monostate, Instance, Ontology::ConceptId, Filler>;

/// As fillers compare on the Blackboard: text without regard to case, 1 and 1.0 are the same.
bool SameValue(const Value& a, const Value& b);

constexpr int kNoVariable = -1;

/// Subject or object of a pattern: a variable, or a constant of its kind.
struct Term {
  Kind kind{Kind::kInstance};
  int variable{kNoVariable};  ///< index into Query::variables; constants have none
  Value constant;             ///< variables have none

  bool IsVariable() const { return variable != kNoVariable; }
};

struct Pattern {
  enum class Verb {
    kType,            ///< rdf:type
    kSubclassDirect,  ///< rdfs:subClassOf: the nearest ones, none between
    kSubclassPlus,    ///< rdfs:subClassOf+
    kSubclassStar,    ///< rdfs:subClassOf*
    kRole,            ///< a relation of the ontology
  };
  Term subject;
  Verb verb{Verb::kType};
  std::string role;  ///< of kRole, as the ontology spells it
  Term object;
};

struct Group;

/// A pattern, or groups of which one has to hold.
struct Element {
  Pattern pattern;
  std::vector<Group> alternatives;  ///< empty: the pattern counts

  bool IsUnion() const { return !alternatives.empty(); }
};

/// All elements have to hold.
struct Group {
  std::vector<Element> elements;
};

struct Query {
  std::vector<std::string> variables;  ///< with `?`, in the order in which they first appear
  std::vector<Kind> kinds;             ///< of the variables
  std::vector<int> selected;           ///< variables; the first one is set by every solution
  Group where;

  int root() const { return selected.front(); }
};

/// @throws ConfigError "query 1:24: came ..., wanted ...".
Query ReadQuery(std::string_view text, const Ontology& ontology);

}  // namespace hires::knowledge::sparql
