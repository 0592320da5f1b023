#include "knowledge/sparql/sparql_names.h"

#include <fmt/format.h>

#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::knowledge::sparql {
namespace {

const std::map<std::string, std::string>& WellKnown() {
  static const std::map<std::string, std::string> iris{
      {"upper", "urn:x-hires:upper#"},
      {"race", "urn:x-hires:race#"},
      {"rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#"},
      {"rdfs", "http://www.w3.org/2000/01/rdf-schema#"},
      {"owl", "http://www.w3.org/2002/07/owl#"},
      {"xsd", "http://www.w3.org/2001/XMLSchema#"},
  };
  return iris;
}

std::string SpaceOf(const std::string& iri) {
  for (const auto& [space, known] : WellKnown()) {
    if (known == iri) return space;
  }
  return iri;
}

}  // namespace

Names::Names(const Ontology& ontology) : ontology_(ontology), iris_(WellKnown()) {}

void Names::Declare(const std::string& prefix, const std::string& iri) { iris_[prefix] = iri; }

Name Names::Read(const Token& token) const {
  if (token.kind == Token::Kind::kIri) return ReadIri(token);
  const std::size_t colon = token.text.find(':');
  const auto found = iris_.find(token.text.substr(0, colon));
  if (found == iris_.end()) {
    std::vector<std::string> known;
    for (const auto& [prefix, iri] : iris_) known.push_back(prefix);
    FailAt(token.place, fmt::format("came the prefix of {}, which nothing declares; wanted one of "
                                    "{}, or a line 'prefix name: <iri>' before select",
                                    ToString(token), base::Join(known, ", ")));
  }
  return {SpaceOf(found->second), token.text.substr(colon + 1), ToString(token), token.place};
}

Name Names::ReadIri(const Token& token) const {
  const std::size_t end = token.text.find_last_of("#/");
  if (end == std::string::npos || end + 1 == token.text.size()) {
    FailAt(token.place,
           "came " + ToString(token) + ", wanted an IRI with a name behind its last '#' or '/'");
  }
  return {SpaceOf(token.text.substr(0, end + 1)), token.text.substr(end + 1), ToString(token),
          token.place};
}

void Names::CheckSpace(const Name& name) const {
  if (WellKnown().count(name.space) == 0) return;  // of another ontology: the name alone counts
  const std::string qualified = ontology_.Qualified(name.local);
  const std::string space = qualified.substr(0, qualified.find(':'));
  if (WellKnown().count(space) == 0 || space == name.space) return;
  FailAt(name.place, "came " + name.written + ", the ontology has " + qualified);
}

Ontology::ConceptId Names::Concept(const Name& name) const {
  const Ontology::ConceptId found = ontology_.Find(name.local);
  if (found == Ontology::kUnknown) {
    FailAt(name.place, base::UnknownName("concept", name.local, ontology_.ConceptNames()));
  }
  CheckSpace(name);
  return found;
}

const Ontology::Relation& Names::Relation(const Name& name) const {
  const Ontology::Relation* found = ontology_.FindRelation(name.local);
  if (found == nullptr) {
    FailAt(name.place, base::UnknownName("relation", name.local, ontology_.RelationNames()) +
                           "; besides relations, rdf:type and rdfs:subClassOf are understood");
  }
  CheckSpace(name);
  return *found;
}

}  // namespace hires::knowledge::sparql
