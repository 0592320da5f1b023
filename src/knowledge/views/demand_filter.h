#pragma once

#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/query.h"
#include "hires/knowledge/sparql.h"
#include "knowledge/sparql/sparql_engine.h"
#include "knowledge/sparql/sparql_reach.h"

namespace hires::knowledge {

/// The concept and property filters of a topic.
class FluentFilter {
 public:
  /// @throws ConfigError for an unknown concept or relation, with the nearest names.
  FluentFilter(const DemandTopic& topic, const Ontology& ontology);

  bool is_given() const { return is_given_; }
  /// False where none is given.
  bool Matches(const Fluent& fluent, Ontology::ConceptId concept_id) const;
  const FluentQuery& query() const { return query_; }  ///< for the same fluents.  @pre is_given()

 private:
  void ReadConcepts(const DemandTopic& topic, const Ontology& ontology);
  void ReadProperties(const DemandTopic& topic, const Ontology& ontology);
  bool HasProperties(const Fluent& fluent) const;

  bool is_given_{false};
  FluentQuery query_;
  std::vector<bool> concepts_;  // by id: whether it passes
};

/// One query of a topic.
class QueryFilter {
 public:
  /// @throws ConfigError as Sparql; also if the first selected variable stands for no instances.
  QueryFilter(const std::string& text, std::shared_ptr<const Ontology> ontology);

  const sparql::Reach& reach() const { return reach_; }
  bool Matches(const Fluent& fluent, Ontology::ConceptId concept_id, const FluentView& view) const;
  std::vector<std::string> Instances(const FluentView& view) const {
    return engine_->Instances(view);
  }
  /// Looks up which fluents can decide about others, as far as `Reach` cannot trace them.
  void FindParts(const FluentView& view);
  /// Whether the fluent was one of those before the change, or is one after it. Keeps which.
  bool NoticePart(const Change& change);

 private:
  enum class May : unsigned char { kUnknown, kNo, kYes };

  bool MayBe(int variable, Ontology::ConceptId concept_id) const;
  May AskWhetherItMayBe(int variable, Ontology::ConceptId concept_id) const;
  bool IsPart(const Fluent& fluent, const std::string& key) const;

  std::shared_ptr<const Ontology> ontology_;
  std::unique_ptr<sparql::Engine> engine_;
  sparql::Reach reach_;
  bool asks_roles_{false};
  mutable std::vector<std::vector<May>> may_;  // by variable and concept, filled when asked for
  std::unordered_set<std::string> parts_;      // in lower case; none if the reach is traceable
};

}  // namespace hires::knowledge
