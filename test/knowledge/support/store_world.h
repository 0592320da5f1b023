#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/store.h"

namespace hires::test_support {

/// A few concepts and relations, enough for the tests of the store.
inline std::shared_ptr<const knowledge::Ontology> SmallOntology() {
  static const auto ontology =
      std::make_shared<const knowledge::Ontology>(knowledge::Ontology::FromText(R"(
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix t: <http://example.org/test#> .
t:Entity a owl:Class .
t:Object a owl:Class ; rdfs:subClassOf t:Entity .
t:Mug a owl:Class ; rdfs:subClassOf t:Object .
t:Vase a owl:Class ; rdfs:subClassOf t:Object .
t:Area a owl:Class ; rdfs:subClassOf t:Entity .
t:Pose a owl:Class .
t:State a owl:Class .
t:On a owl:Class ; rdfs:subClassOf t:State .
t:ExecutionRecord a owl:Class .
t:RobotActivity a owl:Class ; rdfs:subClassOf t:ExecutionRecord .
t:hasPose a owl:ObjectProperty , owl:FunctionalProperty ;
  rdfs:domain t:Entity ; rdfs:range t:Pose .
t:hasObject a owl:ObjectProperty ; rdfs:domain t:State ; rdfs:range t:Object .
t:hasArea a owl:ObjectProperty ; rdfs:domain t:State ; rdfs:range t:Area .
t:hasX a owl:DatatypeProperty , owl:FunctionalProperty ;
  rdfs:domain t:Pose ; rdfs:range xsd:float .
t:hasY a owl:DatatypeProperty , owl:FunctionalProperty ;
  rdfs:domain t:Pose ; rdfs:range xsd:float .
t:hasColour a owl:DatatypeProperty ; rdfs:domain t:Object ; rdfs:range xsd:string .
t:hasCount a owl:DatatypeProperty ; rdfs:domain t:Object ; rdfs:range xsd:int .
t:isClean a owl:DatatypeProperty ; rdfs:domain t:Object ; rdfs:range xsd:boolean .
t:hasResult a owl:DatatypeProperty ; rdfs:domain t:ExecutionRecord ; rdfs:range xsd:string .
)",
                                                                                "small.ttl"));
  return ontology;
}

inline knowledge::Fluent MakeFluent(std::string concept_name, std::string instance,
                                    std::vector<knowledge::Property> properties = {}) {
  knowledge::Fluent fluent;
  fluent.concept_name = std::move(concept_name);
  fluent.instance = std::move(instance);
  fluent.properties = std::move(properties);
  return fluent;
}

inline knowledge::Fluent PoseAt(const std::string& instance, double x) {
  return MakeFluent("Pose", instance, {{"hasX", "xsd:float", x}});
}

inline knowledge::Assertion At(double time, std::int64_t episode = 0,
                               knowledge::Source source = knowledge::Source::kObservation) {
  return {source, episode, time};
}

inline knowledge::FluentQuery Ever() {
  knowledge::FluentQuery query;
  query.time.kind = knowledge::FluentQuery::TimeFilter::Kind::kEver;
  return query;
}

inline knowledge::FluentQuery HoldsAt(double time) {
  knowledge::FluentQuery query;
  query.time.kind = knowledge::FluentQuery::TimeFilter::Kind::kAt;
  query.time.at = time;
  return query;
}

/// All pages of a query.
inline std::vector<knowledge::Fluent> QueryAll(const knowledge::Store& store,
                                               knowledge::FluentQuery query) {
  std::vector<knowledge::Fluent> fluents;
  for (;;) {
    knowledge::FluentPage page = store.Query(query);
    for (knowledge::Fluent& fluent : page.fluents) fluents.push_back(std::move(fluent));
    if (page.next.empty()) return fluents;
    query.cursor = page.next;
  }
}

inline std::vector<std::string> Names(const std::vector<knowledge::Fluent>& fluents) {
  std::vector<std::string> names;
  for (const knowledge::Fluent& fluent : fluents) names.push_back(fluent.instance);
  return names;
}

}  // namespace hires::test_support
