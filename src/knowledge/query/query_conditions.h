#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "hires/knowledge/ontology.h"
#include "hires/knowledge/query.h"
#include "knowledge/query/query_statements.h"
#include "knowledge/store/store_parts.h"

namespace hires::knowledge {

/// Concepts by their numbers in Words.
class ConceptSet {
 public:
  void Insert(std::int64_t concept_id);
  bool Contains(std::int64_t concept_id) const {
    const auto index = static_cast<std::size_t>(concept_id);
    return index < members_.size() && members_[index];
  }
  bool empty() const { return members_.empty(); }
  std::vector<std::int64_t> Numbers() const;  ///< ascending

 private:
  std::vector<bool> members_;  // by number
};

/// Worlds from the first to the last: 0 is the real one, the others are imagined episodes.
struct WorldRange {
  std::int64_t first{0};
  std::int64_t last{std::numeric_limits<std::int64_t>::max()};
  bool Contains(std::int64_t world) const { return first <= world && world <= last; }
  bool IsOne() const { return first == last; }
};

/// What can meet a query's condition on time ends after `earliest_finish` (finish.latest) and
/// begins at `latest_start` or before it (start.earliest) [s].
struct TimeReach {
  double earliest_finish{-temporal::kForever};
  double latest_start{temporal::kForever};
};
/// @throws ConfigError for a moment or an interval that is none, or no relations to an interval.
TimeReach ReachOf(const FluentQuery::TimeFilter& time);

/// Whether the fluent has the role with that filler (text compares without regard to case, numbers
/// by value).
bool HasProperty(const Fluent& fluent, const FluentQuery::PropertyFilter& filter);

/// What a query asks of a fluent, checked, and made ready to be compared with rows of a store.
class QueryConditions {
 public:
  /// @param query  Outlives this.
  /// @param as_of  Last change that counts: what was ended later is still open.
  /// @throws ConfigError
  QueryConditions(const FluentQuery& query, std::int64_t as_of, const Ontology& ontology,
                  StoreParts* parts);

  const FluentQuery& query() const { return query_; }
  FluentQuery::TimeFilter::Kind time_kind() const { return query_.time.kind; }
  std::int64_t as_of() const { return as_of_; }
  const std::optional<ConceptSet>& concepts() const { return concepts_; }  ///< nothing: any
  const WorldRange& worlds() const { return worlds_; }
  const TimeReach& reach() const { return reach_; }

  /// Nothing was ever said of the concepts that the query asks for.
  bool IsImpossible() const { return concepts_ && concepts_->empty(); }
  /// False where the index tells that the validity does not match.
  bool MayFit(const IndexEntry& entry) const {
    return entry.id <= as_of_ && entry.start <= reach_.latest_start &&
           worlds_.Contains(entry.world) && FitsConcept(entry.concept_id);
  }
  /// All but the properties.
  bool Fits(const Validity& validity) const;
  bool FitsProperties(const Fluent& fluent) const;

 private:
  void ReadConcepts(const Ontology& ontology, StoreParts* parts);
  void AddConcepts(const FluentQuery::ConceptFilter& filter, const Ontology& ontology,
                   Words* words);
  bool FitsConcept(std::int64_t concept_id) const {
    return !concepts_ || concepts_->Contains(concept_id);
  }
  bool FitsTime(const Validity& validity) const;

  const FluentQuery& query_;
  std::int64_t as_of_;
  std::optional<ConceptSet> concepts_;
  TimeReach reach_;
  WorldRange worlds_;
};

}  // namespace hires::knowledge
