#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/knowledge/sparql.h"
#include "knowledge/support/memory_view.h"
#include "knowledge/support/random_world.h"
#include "support/property.h"

namespace hires::knowledge::sparql_properties_test {
namespace {

using test_support::kNumNames;
using test_support::MemoryView;
using test_support::Pick;
using test_support::PickFluent;
using test_support::PickOf;
using test_support::RestaurantOntology;

constexpr test_support::PropertyCases kPropertyCases{400};

/// A pattern in words. Instances are "n0"..., concepts and values as they are written; variables of
/// instances are "?v0"..., of concepts "?c0"....
struct Triple {
  std::string subject, verb, object;
};
using Triples = std::vector<Triple>;

/// What the variables stand for.
using Row = std::map<std::string, std::string>;

std::string PickInstance() {
  return Pick(6) == 0 ? "n" + std::to_string(Pick(kNumNames)) : "?v" + std::to_string(Pick(3));
}

std::string PickConcept() {
  if (Pick(2) == 0) return "?c" + std::to_string(Pick(2));
  return PickOf<std::string>({"Mug", "Area", "FloorArea", "Pose", "TabletopObject", "On"});
}

Triple PickTriple() {
  switch (Pick(5)) {
    case 0:
    case 1:
      return {PickInstance(), "a", PickConcept()};
    case 2:
      return {PickConcept(), PickOf<std::string>({"sub", "sub+", "sub*"}), PickConcept()};
    case 3:
      return {PickInstance(), "hasZ", PickOf<std::string>({"0", "1"})};
    default:
      return {PickInstance(),
              PickOf<std::string>({"hasBoundingBox", "hasPose", "hasPhysicalEntity", "hasArea"}),
              PickInstance()};
  }
}

Triples PickTriples(int at_least, int at_most) {
  Triples triples;
  for (int i = at_least + Pick(at_most - at_least + 1); i > 0; --i) triples.push_back(PickTriple());
  return triples;
}

std::string Written(const std::string& term) {
  if (term[0] == '?') return term;
  if (term == "0" || term == "1") return "\"" + term + ".0\"^^xsd:float";
  if (term[0] == 'n') return "race:" + term;
  return RestaurantOntology()->Qualified(term);
}

std::string Written(const Triple& triple) {
  std::string verb = triple.verb;
  if (verb.compare(0, 3, "sub") == 0) {
    verb = "rdfs:subClassOf" + verb.substr(3);
  } else if (verb != "a") {
    verb = RestaurantOntology()->Qualified(verb);
  }
  return Written(triple.subject) + " " + verb + " " + Written(triple.object) + " . ";
}

std::string Written(const Triples& triples) {
  std::string text;
  for (const Triple& triple : triples) text += Written(triple);
  return text;
}

bool IsDirect(const Ontology& ontology, Ontology::ConceptId below, Ontology::ConceptId above) {
  for (Ontology::ConceptId other = 0; other < ontology.num_concepts(); ++other) {
    if (other == below || other == above) continue;
    if (ontology.IsA(below, other) && ontology.IsA(other, above)) return false;
  }
  return below != above && ontology.IsA(below, above);
}

bool HoldsOfConcepts(const Triple& triple) {
  const Ontology& ontology = *RestaurantOntology();
  const auto below = ontology.Find(triple.subject);
  const auto above = ontology.Find(triple.object);
  if (triple.verb == "sub") return IsDirect(ontology, below, above);
  return ontology.IsA(below, above) && (triple.verb == "sub*" || below != above);
}

/// Whether a triple without variables holds.
bool Holds(const Triple& triple, const MemoryView& view) {
  if (triple.verb.compare(0, 3, "sub") == 0) return HoldsOfConcepts(triple);
  const Fluent* fluent = view.Find(triple.subject);
  if (fluent == nullptr) return false;
  if (triple.verb == "a") return fluent->concept_name == triple.object;
  return std::any_of(fluent->properties.begin(), fluent->properties.end(), [&](const Property& p) {
    const auto* number = std::get_if<double>(&p.filler);
    const std::string filler =
        number != nullptr ? (*number == 0 ? "0" : "1") : std::get<std::string>(p.filler);
    return p.role == triple.verb && filler == triple.object;
  });
}

std::vector<std::string> Domain(const std::string& variable) {
  if (variable[1] == 'c') return RestaurantOntology()->ConceptNames();
  std::vector<std::string> names;
  for (int i = 0; i < kNumNames; ++i) names.push_back("n" + std::to_string(i));
  return names;
}

std::string In(const Row& row, const std::string& term) {
  const auto found = row.find(term);
  return found == row.end() ? term : found->second;
}

/// Tries every value of every variable, and looks at a triple as soon as it has no variable left.
void TryAll(const Triples& triples, const MemoryView& view, Row* row,
            const std::function<void()>& visit) {
  std::string open;
  for (const Triple& triple : triples) {
    const Triple known{In(*row, triple.subject), triple.verb, In(*row, triple.object)};
    if (known.subject[0] == '?') {
      open = known.subject;
    } else if (known.object[0] == '?') {
      open = known.object;
    } else if (!Holds(known, view)) {
      return;
    }
  }
  if (open.empty()) return visit();
  for (const std::string& value : Domain(open)) {
    (*row)[open] = value;
    TryAll(triples, view, row, visit);
  }
  row->erase(open);
}

bool Names(const Triples& triples, const std::string& variable) {
  return std::any_of(triples.begin(), triples.end(), [&](const Triple& triple) {
    return triple.subject == variable || triple.object == variable;
  });
}

HIRES_PROPERTY(SparqlProperty, JoinsGiveWhatTryingEveryValueGives, ()) {
  std::vector<Fluent> fluents;
  for (int i = 0; i < kNumNames; ++i) {
    if (Pick(5) > 0) fluents.push_back(PickFluent("n" + std::to_string(i)));
  }
  const MemoryView view(fluents);
  const Triples common = PickTriples(1, 3);
  const std::vector<Triples> alternatives{PickTriples(1, 2), PickTriples(1, 2)};
  const bool has_union = Pick(2) > 0;
  RC_PRE(Names(common, "?v0"));

  std::string text = "select ?v0 { " + Written(common);
  std::vector<Triples> branches{common};
  if (has_union) {
    text += "{" + Written(alternatives[0]) + "} union {" + Written(alternatives[1]) + "}";
    branches = {common, common};
    for (std::size_t i = 0; i < 2; ++i) {
      branches[i].insert(branches[i].end(), alternatives[i].begin(), alternatives[i].end());
    }
  }
  text += "}";
  RC_LOG() << text << "\n";

  std::set<std::string> wanted;
  for (const Triples& branch : branches) {
    Row row;
    TryAll(branch, view, &row, [&] { wanted.insert(row.at("?v0")); });
  }
  RC_CLASSIFY(!wanted.empty(), "selects something");
  const Sparql query(text, RestaurantOntology());
  const std::vector<std::string> found = query.Instances(view);
  RC_ASSERT(std::vector<std::string>(wanted.begin(), wanted.end()) == found);
  for (const std::string& name : Domain("?v0")) {
    RC_ASSERT(query.Accepts(view, name) == (wanted.count(name) > 0));
  }
}

HIRES_PROPERTY(SparqlProperty, AnyTextIsReadOrRefusedWithItsPlace, ()) {
  const std::vector<std::string> pieces{
      "select ", "?x ",    "{",       "}",           "race:Mug ",
      "a ",      "union ", ". ",      "; ",          ", ",
      "\"a\" ",  "0.0 ",   "^^",      "upper:hasZ ", "rdfs:subClassOf+ ",
      "\n",      "<a#b> ", "prefix ", "r: ",         "\\",
      "\xff",    "#"};
  std::string text = Pick(2) > 0 ? "select ?x { ?x a race:Mug . " : "";
  for (int i = Pick(12); i > 0; --i) text += PickOf(pieces);
  try {
    Sparql(text, RestaurantOntology());
  } catch (const base::ConfigError& error) {
    RC_ASSERT(std::string(error.what()).compare(0, 6, "query ") == 0);
  }
}

}  // namespace
}  // namespace hires::knowledge::sparql_properties_test
