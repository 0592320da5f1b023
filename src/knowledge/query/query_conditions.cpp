#include "knowledge/query/query_conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/fluents/store_check.h"
#include "knowledge/state/live_view_match.h"

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;
using temporal::Allen;

bool Has(const std::vector<Allen>& relations, Allen wanted) {
  return std::find(relations.begin(), relations.end(), wanted) != relations.end();
}

TimeReach ReachOfRelations(const temporal::Interval& interval,
                           const std::vector<Allen>& relations) {
  if (!(interval.start < interval.finish)) {
    throw base::ConfigError(
        fmt::format("a query by an interval from {} to {}; wanted a start "
                    "before the finish",
                    interval.start, interval.finish));
  }
  if (relations.empty()) {
    throw base::ConfigError("a query by an interval without relations to it; name at least one");
  }
  TimeReach reach{interval.start, interval.finish};
  if (Has(relations, Allen::kMeets)) {  // which ends just there
    reach.earliest_finish = std::nextafter(interval.start, -temporal::kForever);
  }
  if (Has(relations, Allen::kBefore)) reach.earliest_finish = -temporal::kForever;
  if (Has(relations, Allen::kAfter)) reach.latest_start = temporal::kForever;
  return reach;
}

void RequireRelations(const std::vector<FluentQuery::PropertyFilter>& properties,
                      const Ontology& ontology) {
  for (const FluentQuery::PropertyFilter& filter : properties) {
    const Ontology::Relation* relation = ontology.FindRelation(filter.role);
    if (relation == nullptr) {
      throw base::ConfigError(
          base::UnknownName("relation", filter.role.substr(0, 60), ontology.RelationNames()));
    }
    if (filter.filler) CheckFiller(*relation, *filter.filler);
  }
}

WorldRange WorldsOf(const FluentQuery& query, Episodes* episodes) {
  if (query.episode && *query.episode != 0) {
    const Episode episode = episodes->Require(*query.episode);
    const std::int64_t world = episode.label == Episode::Label::kImagined ? episode.id : 0;
    return {world, world};
  }
  if (query.label == Episode::Label::kReal) return {0, 0};
  WorldRange worlds;
  if (query.label == Episode::Label::kImagined) worlds.first = 1;
  return worlds;
}

}  // namespace

void ConceptSet::Insert(std::int64_t concept_id) {
  const auto index = static_cast<std::size_t>(concept_id);
  if (members_.size() <= index) members_.resize(index + 1, false);
  members_[index] = true;
}

std::vector<std::int64_t> ConceptSet::Numbers() const {
  std::vector<std::int64_t> numbers;
  for (std::size_t index = 0; index < members_.size(); ++index) {
    if (members_[index]) numbers.push_back(static_cast<std::int64_t>(index));
  }
  return numbers;
}

TimeReach ReachOf(const FluentQuery::TimeFilter& time) {
  if (time.kind == TimeKind::kAllen) return ReachOfRelations(time.interval, time.relations);
  if (time.kind != TimeKind::kAt) return {};
  if (std::isnan(time.at)) throw base::ConfigError("a query at no time (NaN); wanted seconds");
  return {time.at, time.at};
}

bool HasProperty(const Fluent& fluent, const FluentQuery::PropertyFilter& filter) {
  return std::any_of(fluent.properties.begin(), fluent.properties.end(), [&](const Property& p) {
    return p.role == filter.role && (!filter.filler || SameFiller(p.filler, *filter.filler));
  });
}

QueryConditions::QueryConditions(const FluentQuery& query, std::int64_t as_of,
                                 const Ontology& ontology, StoreParts* parts)
    : query_(query), as_of_(as_of) {
  ReadConcepts(ontology, parts);
  RequireRelations(query.properties, ontology);
  reach_ = ReachOf(query.time);
  worlds_ = WorldsOf(query, &parts->episodes);
}

void QueryConditions::ReadConcepts(const Ontology& ontology, StoreParts* parts) {
  if (query_.concepts.empty()) return;
  if (parts->file->read_only()) parts->words.Reload();  // the writer may know more by now
  concepts_.emplace();
  for (const auto& filter : query_.concepts) AddConcepts(filter, ontology, &parts->words);
}

void QueryConditions::AddConcepts(const FluentQuery::ConceptFilter& filter,
                                  const Ontology& ontology, Words* words) {
  using Reach = FluentQuery::ConceptFilter::Reach;
  const Ontology::ConceptId id = ontology.Require(filter.name);
  std::vector<Ontology::ConceptId> ids{id};
  if (filter.reach == Reach::kBelow) ids = ontology.Below(id);
  if (filter.reach == Reach::kAbove) ids = ontology.Above(id);
  for (const Ontology::ConceptId each : ids) {
    const auto word = words->Find(ontology.Name(each));
    if (word) concepts_->Insert(*word);  // else nothing of it was ever said
  }
}

bool QueryConditions::FitsTime(const Validity& validity) const {
  const FluentQuery::TimeFilter& time = query_.time;
  if (time.kind == TimeKind::kEver) return true;
  if (time.kind == TimeKind::kNow) return validity.closed > as_of_;
  const temporal::Bounds& finish = validity.closed > as_of_ ? validity.given : validity.finish;
  if (time.kind == TimeKind::kAt) {
    return validity.start.earliest <= time.at && time.at < finish.latest;
  }
  const auto possible = temporal::PossibleRelations(validity.start, finish, time.interval);
  return std::any_of(possible.begin(), possible.end(),
                     [&](Allen relation) { return Has(time.relations, relation); });
}

bool QueryConditions::Fits(const Validity& validity) const {
  return validity.id <= as_of_ && worlds_.Contains(validity.world) &&
         FitsConcept(validity.concept_id) &&
         (!query_.episode || validity.episode == *query_.episode) && FitsTime(validity);
}

bool QueryConditions::FitsProperties(const Fluent& fluent) const {
  const auto fits = [&](const FluentQuery::PropertyFilter& filter) {
    return HasProperty(fluent, filter);
  };
  const auto& filters = query_.properties;
  if (filters.empty() || query_.all_properties) {
    return std::all_of(filters.begin(), filters.end(), fits);
  }
  return std::any_of(filters.begin(), filters.end(), fits);
}

}  // namespace hires::knowledge
