#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/knowledge/ontology.h"
#include "hires/knowledge/query.h"
#include "knowledge/query/access_paths.h"
#include "knowledge/query/page_builder.h"

namespace hires::knowledge {

/// Answers queries to a store, page by page. What lies on an access path is sorted; where there is
/// too much on all of them, all instances are walked through in order of their names. Either way
/// memory is bounded.
class QueryEngine {
 public:
  QueryEngine(StoreParts* parts, std::shared_ptr<const Ontology> ontology);

  /// Within one transaction.
  /// @param last  Sequence number of the last change.
  /// @throws ConfigError
  FluentPage Page(const FluentQuery& query, std::int64_t last);

 private:
  struct Selection;  // of instances
  Selection Select(const QueryConditions& conditions, std::int64_t last);
  Selection SelectBySparql(const QueryConditions& conditions, std::int64_t last);
  NamedInstances FindInstances(const std::vector<std::string>& names);
  void Search(const QueryConditions& conditions, const PageStart& start, std::int64_t last,
              PageBuilder* page);
  void Walk(const QueryConditions& conditions, const PageStart& start,
            std::optional<NamedInstances> instances, PageBuilder* page);
  void Offer(const std::vector<QueryPosition>& candidates, PageBuilder* page);

  StoreParts* parts_;
  std::shared_ptr<const Ontology> ontology_;
  QueryStatements statements_;
};

}  // namespace hires::knowledge
