#include "knowledge/query/query_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"
#include "hires/knowledge/sparql.h"
#include "knowledge/query/instance_walk.h"
#include "knowledge/query/snapshot_view.h"

namespace hires::knowledge {
namespace {

// Fluents of a state that a SPARQL query looks at, in memory.
constexpr std::size_t kMaxState = 200'000;

/// The state that a SPARQL query looks at: of the query's moment and world, as of the first page.
FluentQuery StateQuery(const QueryConditions& conditions) {
  FluentQuery state;
  if (conditions.time_kind() == FluentQuery::TimeFilter::Kind::kAt) {
    state.time = conditions.query().time;
  }
  if (conditions.worlds().first != 0) state.episode = conditions.worlds().first;
  state.limit = kMaxState;
  state.cursor = ToString(QueryCursor{conditions.as_of(), QueryPosition()});
  return state;
}

/// Those of `kept` that are in `wanted`, too.
void KeepOnly(const NamedInstances& wanted, NamedInstances* kept) {
  const auto is_elsewhere = [&](const Instances::Named& named) {
    return std::none_of(wanted.begin(), wanted.end(),
                        [&](const Instances::Named& other) { return other.id == named.id; });
  };
  kept->erase(std::remove_if(kept->begin(), kept->end(), is_elsewhere), kept->end());
}

}  // namespace

/// The instances that a query restricts itself to.
struct QueryEngine::Selection {
  std::optional<NamedInstances> instances;  // nothing: it does not
  std::uint64_t visited{0};                 // rows looked at for it
};

QueryEngine::QueryEngine(StoreParts* parts, std::shared_ptr<const Ontology> ontology)
    : parts_(parts), ontology_(std::move(ontology)), statements_(parts->file) {}

FluentPage QueryEngine::Page(const FluentQuery& query, std::int64_t last) {
  if (query.limit == 0) throw base::ConfigError("a query with limit 0; wanted at least 1");
  const PageStart start = StartOfPage(query.cursor, last);
  const QueryConditions conditions(query, start.as_of, *ontology_, parts_);
  PageBuilder page(conditions, parts_);
  Selection selection = Select(conditions, last);
  page.AddVisited(selection.visited);
  if (conditions.IsImpossible()) return page.Take();
  if (selection.instances) {
    Walk(conditions, start, std::move(selection.instances), &page);
  } else {
    Search(conditions, start, last, &page);
  }
  return page.Take();
}

/// By name and by SPARQL: both hold.
QueryEngine::Selection QueryEngine::Select(const QueryConditions& conditions, std::int64_t last) {
  const FluentQuery& query = conditions.query();
  Selection selection;
  if (!query.sparql.empty()) selection = SelectBySparql(conditions, last);
  if (query.instance.empty()) return selection;
  NamedInstances named = FindInstances({query.instance});
  if (selection.instances) KeepOnly(*selection.instances, &named);
  selection.instances = std::move(named);
  return selection;
}

QueryEngine::Selection QueryEngine::SelectBySparql(const QueryConditions& conditions,
                                                   std::int64_t last) {
  if (!conditions.worlds().IsOne()) {
    throw base::ConfigError(
        "a SPARQL query looks at one world; ask for label real, or name an imagined episode");
  }
  const Sparql sparql(conditions.query().sparql, ontology_);
  FluentPage state = Page(StateQuery(conditions), last);
  if (!state.next.empty()) {
    throw base::ConfigError(fmt::format(
        "a SPARQL query over more than {} fluents; ask by concept, instance or property",
        kMaxState));
  }
  const std::uint64_t visited = state.visited;
  return {FindInstances(sparql.Instances(SnapshotView(std::move(state.fluents)))), visited};
}

/// Those that the store knows.
NamedInstances QueryEngine::FindInstances(const std::vector<std::string>& names) {
  NamedInstances found;
  for (const std::string& name : names) {
    if (const auto named = parts_->instances.Find(name)) found.push_back(*named);
  }
  return found;
}

void QueryEngine::Search(const QueryConditions& conditions, const PageStart& start,
                         std::int64_t last, PageBuilder* page) {
  AccessPaths paths(conditions, start, last, parts_, &statements_);
  std::optional<Found> found = paths.Find();
  page->AddVisited(paths.visited());
  if (!found) return Walk(conditions, start, std::nullopt, page);
  if (auto* instances = std::get_if<NamedInstances>(&*found)) {
    return Walk(conditions, start, std::move(*instances), page);
  }
  Offer(std::get<std::vector<QueryPosition>>(*found), page);
}

/// @param instances  Nothing: all.
void QueryEngine::Walk(const QueryConditions& conditions, const PageStart& start,
                       std::optional<NamedInstances> instances, PageBuilder* page) {
  InstanceWalk walk(conditions, start.after, &statements_, page);
  instances ? walk.Through(std::move(*instances)) : walk.ThroughAll();
  page->AddVisited(walk.visited());
}

void QueryEngine::Offer(const std::vector<QueryPosition>& candidates, PageBuilder* page) {
  for (const QueryPosition& candidate : candidates) {
    const auto validity = parts_->validities.Find(candidate.id);
    if (validity && !page->Offer(*validity, candidate.name)) return;
  }
}

}  // namespace hires::knowledge
