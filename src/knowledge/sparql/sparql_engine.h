#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hires/knowledge/sparql.h"
#include "knowledge/sparql/sparql_plan.h"
#include "knowledge/sparql/sparql_query.h"

namespace hires::knowledge::sparql {

/// A query that is read and planned.
class Engine {
 public:
  /// @throws ConfigError as ReadQuery.
  Engine(std::string_view text, std::shared_ptr<const Ontology> ontology);
  Engine(const Engine&) = delete;  // plans point into the query
  Engine& operator=(const Engine&) = delete;

  const Query& query() const { return query_; }

  /// @throws ConfigError after a million intermediate rows; so do the others.
  std::vector<std::vector<std::string>> Select(const FluentView& view) const;
  std::vector<std::string> Instances(const FluentView& view) const;
  bool Accepts(const FluentView& view, const std::string& candidate) const;
  /// False only if no instance of that concept ever takes the place of the variable in a solution,
  /// whatever its properties are.
  bool MayBe(int variable, Ontology::ConceptId concept_id) const;

 private:
  std::shared_ptr<const Ontology> ontology_;
  Query query_;
  Plan search_;  // nothing is known beforehand
  Plan check_;   // the root is
};

}  // namespace hires::knowledge::sparql
