#include "knowledge/store/store_query.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <tuple>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/sparql.h"
#include "knowledge/store/store_codec.h"
#include "knowledge/store/store_snapshot.h"
#include "knowledge/views/live_view_match.h"

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;

// Fluents of a state that a SPARQL query looks at, in memory.
constexpr std::size_t kMaxState = 200'000;

const std::string kLight = "SELECT v.id, v.instance, v.world, v.concept, v.start_earliest FROM ";
const std::string kAll = std::string("SELECT") + kValidityColumns + "FROM validity ";

std::uint64_t BitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

double FromBits(std::uint64_t bits) {
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

template <typename Number>
bool ReadNumber(const std::string& text, int base, Number* number) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, *number, base);
  return result.ec == std::errc() && result.ptr == end;
}

bool Has(const std::vector<temporal::Allen>& relations, temporal::Allen wanted) {
  return std::find(relations.begin(), relations.end(), wanted) != relations.end();
}

}  // namespace

Fluent ToFluent(const Validity& validity, std::int64_t as_of, StoreParts* parts) {
  Fluent fluent;
  fluent.concept_name = parts->words.Text(validity.concept_id);
  fluent.instance = parts->instances.Name(validity.instance);
  fluent.properties = DecodeProperties(validity.properties, &parts->words);
  fluent.start = validity.start;
  fluent.finish = validity.closed > as_of ? validity.given : validity.finish;
  return fluent;
}

bool HasProperty(const Fluent& fluent, const FluentQuery::PropertyFilter& filter) {
  return std::any_of(fluent.properties.begin(), fluent.properties.end(), [&](const Property& p) {
    return p.role == filter.role && (!filter.filler || SameFiller(p.filler, *filter.filler));
  });
}

QueryStatements::QueryStatements(StoreFile* file)
    : levels(file->database(), "SELECT min(level) FROM validity WHERE world = ? AND level > ?"),
      window(file->database(),
             kLight +
                 "validity AS v INDEXED BY validity_when WHERE world = ? AND level = ? "
                 "AND start_earliest >= ? AND start_earliest <= ? AND finish_latest > ?"),
      open_of_concept(file->database(),
                      kLight + fmt::format("validity AS v INDEXED BY validity_open "
                                           "WHERE level = {} AND concept = ? "
                                           "AND world BETWEEN ? AND ?",
                                           kLevelOpen)),
      open_filler(file->database(),
                  kLight +
                      "open_filler AS f CROSS JOIN validity AS v ON v.id = f.validity "
                      "WHERE f.hash = ? AND f.world BETWEEN ? AND ?"),
      replaced(file->database(),
               kLight +
                   "validity AS later CROSS JOIN validity AS v ON v.id = later.previous "
                   "WHERE later.id > ? AND later.updated = 1"),
      removed(file->database(), kLight +
                                    "removal AS r CROSS JOIN validity AS v ON v.id = r.validity "
                                    "WHERE r.sequence > ?"),
      filler(file->database(), kLight +
                                   "filler AS f CROSS JOIN validity AS v ON v.id = f.validity "
                                   "WHERE f.hash = ?"),
      episode(file->database(), kLight + "validity AS v WHERE episode = ? AND episode <> 0"),
      of_concept(file->database(), "SELECT instance FROM instance_concept WHERE concept = ?"),
      instances(file->database(), "SELECT id, name FROM instance WHERE name >= ? ORDER BY name"),
      worlds(file->database(), "SELECT min(world) FROM validity WHERE instance = ? AND world >= ?"),
      reach(file->database(),
            "SELECT start_earliest, id, ended_before FROM validity WHERE instance = ? "
            "AND world = ? AND start_earliest <= ? AND id <= ? "
            "ORDER BY start_earliest DESC, id DESC"),
      stretch(file->database(),
              kAll +
                  "WHERE instance = ? AND world = ? AND (start_earliest, id) > (?, ?) "
                  "AND start_earliest <= ? ORDER BY start_earliest, id"),
      newest(file->database(), kAll +
                                   "WHERE instance = ? AND world = ? AND id <= ? "
                                   "ORDER BY start_earliest DESC, id DESC LIMIT 1") {}

bool operator<(const QueryPosition& a, const QueryPosition& b) {
  const int names = sqlite3_stricmp(a.name.c_str(), b.name.c_str());
  if (names != 0) return names < 0;
  return std::tie(a.world, a.start, a.id) < std::tie(b.world, b.start, b.id);
}

std::string ToString(const QueryCursor& cursor) {
  return fmt::format("{}:{}:{:x}:{}:{}", cursor.as_of, cursor.last.world, BitsOf(cursor.last.start),
                     cursor.last.id, cursor.last.name);
}

QueryCursor ReadCursor(const std::string& text) {
  const std::vector<std::string> parts = base::Split(text, ':');
  QueryCursor cursor;
  std::uint64_t bits = 0;
  const bool ok = parts.size() >= 5 && ReadNumber(parts[0], 10, &cursor.as_of) &&
                  ReadNumber(parts[1], 10, &cursor.last.world) && ReadNumber(parts[2], 16, &bits) &&
                  ReadNumber(parts[3], 10, &cursor.last.id) && cursor.as_of >= 0;
  cursor.last.start = FromBits(bits);
  if (!ok || std::isnan(cursor.last.start)) {
    throw base::ConfigError(
        fmt::format("cursor '{}' is none; pass on the one of the page before, or none at first",
                    text.substr(0, 60)));
  }
  cursor.last.name = base::Join({parts.begin() + 4, parts.end()}, ":");  // it may have some itself
  return cursor;
}

// ------------------------------------------------------------------------- what the query asks for

QueryRun::QueryRun(const FluentQuery& query, std::int64_t last, const Ontology& ontology,
                   StoreParts* parts, QueryStatements* statements)
    : query_(query), parts_(parts), statements_(statements), last_(last), as_of_(last) {
  if (query.limit == 0) throw base::ConfigError("a query with limit 0; wanted at least 1");
  if (!query.cursor.empty()) {
    const QueryCursor cursor = ReadCursor(query.cursor);
    as_of_ = std::min(cursor.as_of, last);
    from_ = cursor.last;
  }
  page_.sequence = static_cast<std::uint64_t>(as_of_);
  ReadConcepts(query, ontology);
  ReadProperties(ontology);
  ReadTime();
  ReadWorlds();
  if (!query.instance.empty()) Restrict({query.instance});
  if (!query.sparql.empty()) ReadSparql(ontology);
}

void QueryRun::ReadConcepts(const FluentQuery& query, const Ontology& ontology) {
  if (query.concepts.empty()) return;
  if (parts_->file->read_only()) parts_->words.Reload();  // the writer may know more by now
  concepts_.emplace();
  for (const FluentQuery::ConceptFilter& filter : query.concepts) AddConcepts(filter, ontology);
}

void QueryRun::AddConcepts(const FluentQuery::ConceptFilter& filter, const Ontology& ontology) {
  using Reach = FluentQuery::ConceptFilter::Reach;
  const Ontology::ConceptId id = ontology.Require(filter.name);
  std::vector<Ontology::ConceptId> ids{id};
  if (filter.reach == Reach::kBelow) ids = ontology.Below(id);
  if (filter.reach == Reach::kAbove) ids = ontology.Above(id);
  for (const Ontology::ConceptId each : ids) {
    const auto word = parts_->words.Find(ontology.Name(each));
    if (!word) continue;  // nothing of it was ever said
    const auto index = static_cast<std::size_t>(*word);
    if (concepts_->size() <= index) concepts_->resize(index + 1, false);
    (*concepts_)[index] = true;
  }
}

void QueryRun::ReadProperties(const Ontology& ontology) const {
  for (const FluentQuery::PropertyFilter& filter : query_.properties) {
    if (ontology.FindRelation(filter.role) != nullptr) continue;
    throw base::ConfigError(
        base::UnknownName("relation", filter.role.substr(0, 60), ontology.RelationNames()));
  }
}

void QueryRun::ReadTime() {
  const FluentQuery::TimeFilter& time = query_.time;
  if (time.kind == TimeKind::kAllen) return ReadAllen();
  if (time.kind != TimeKind::kAt) return;
  if (std::isnan(time.at)) throw base::ConfigError("a query at no time (NaN); wanted seconds");
  earliest_finish_ = latest_start_ = time.at;
}

void QueryRun::ReadAllen() {
  using temporal::Allen;
  const temporal::Interval& interval = query_.time.interval;
  const std::vector<Allen>& relations = query_.time.relations;
  if (!(interval.start < interval.finish)) {
    throw base::ConfigError(
        fmt::format("a query by an interval from {} to {}; wanted a start "
                    "before the finish",
                    interval.start, interval.finish));
  }
  if (relations.empty()) {
    throw base::ConfigError("a query by an interval without relations to it; name at least one");
  }
  earliest_finish_ = interval.start;
  if (Has(relations, Allen::kMeets)) {  // which ends just there
    earliest_finish_ = std::nextafter(interval.start, -temporal::kForever);
  }
  if (Has(relations, Allen::kBefore)) earliest_finish_ = -temporal::kForever;
  latest_start_ = Has(relations, Allen::kAfter) ? temporal::kForever : interval.finish;
}

void QueryRun::ReadWorlds() {
  if (query_.label == Episode::Label::kReal) only_world_ = 0;
  if (!query_.episode || *query_.episode == 0) return;
  const Episode episode = parts_->episodes.Require(*query_.episode);
  only_world_ = episode.label == Episode::Label::kImagined ? episode.id : 0;
}

/// The state that a SPARQL query looks at: of the query's moment and world, as of the first page.
FluentQuery QueryRun::StateQuery() const {
  FluentQuery state;
  if (query_.time.kind == TimeKind::kAt) state.time = query_.time;
  if (*only_world_ != 0) state.episode = *only_world_;
  state.limit = kMaxState;
  state.cursor = ToString(QueryCursor{as_of_, QueryPosition()});
  return state;
}

void QueryRun::ReadSparql(const Ontology& ontology) {
  if (!only_world_) {
    throw base::ConfigError(
        "a SPARQL query looks at one world; ask for label real, or name an imagined episode");
  }
  // Not owned: the query is gone before the ontology is.
  const Sparql sparql(query_.sparql, {std::shared_ptr<const Ontology>(), &ontology});
  const FluentQuery state = StateQuery();
  FluentPage page = QueryRun(state, last_, ontology, parts_, statements_).Page();
  page_.visited += page.visited;
  if (!page.next.empty()) {
    throw base::ConfigError(fmt::format(
        "a SPARQL query over more than {} fluents; ask by concept, instance or property",
        kMaxState));
  }
  Restrict(sparql.Instances(SnapshotView(std::move(page.fluents))));
}

void QueryRun::Restrict(const std::vector<std::string>& instances) {
  std::vector<Instances::Named> found;
  for (const std::string& name : instances) {
    if (const auto named = parts_->instances.Find(name)) found.push_back(*named);
  }
  if (list_) {  // already restricted: both hold
    const auto elsewhere = [&](const Instances::Named& named) {
      return std::none_of(found.begin(), found.end(),
                          [&](const Instances::Named& other) { return other.id == named.id; });
    };
    list_->erase(std::remove_if(list_->begin(), list_->end(), elsewhere), list_->end());
  } else {
    list_ = std::move(found);
  }
}

// ------------------------------------------------------------------------- whether a validity fits

bool QueryRun::FitsWorld(std::int64_t world) const {
  if (only_world_) return world == *only_world_;
  return query_.label != Episode::Label::kImagined || world != 0;
}

bool QueryRun::FitsConcept(std::int64_t concept_id) const {
  if (!concepts_) return true;
  const auto index = static_cast<std::size_t>(concept_id);
  return index < concepts_->size() && (*concepts_)[index];
}

bool QueryRun::FitsTime(const Validity& validity) const {
  const FluentQuery::TimeFilter& time = query_.time;
  if (time.kind == TimeKind::kEver) return true;
  if (time.kind == TimeKind::kNow) return validity.closed > as_of_;
  const temporal::Bounds& finish = validity.closed > as_of_ ? validity.given : validity.finish;
  if (time.kind == TimeKind::kAt) {
    return validity.start.earliest <= time.at && time.at < finish.latest;
  }
  const auto possible = temporal::PossibleRelations(validity.start, finish, time.interval);
  return std::any_of(possible.begin(), possible.end(),
                     [&](temporal::Allen relation) { return Has(time.relations, relation); });
}

bool QueryRun::FitsProperties(const Fluent& fluent) const {
  const auto fits = [&](const FluentQuery::PropertyFilter& filter) {
    return HasProperty(fluent, filter);
  };
  const auto& filters = query_.properties;
  if (filters.empty() || query_.all_properties) {
    return std::all_of(filters.begin(), filters.end(), fits);
  }
  return std::any_of(filters.begin(), filters.end(), fits);
}

bool QueryRun::Consider(const Validity& validity, const std::string& name) {
  ++page_.visited;
  const bool fits = validity.id <= as_of_ && FitsWorld(validity.world) &&
                    FitsConcept(validity.concept_id) &&
                    (!query_.episode || validity.episode == *query_.episode) && FitsTime(validity);
  if (!fits) return true;
  Fluent fluent = ToFluent(validity, as_of_, parts_);
  if (!FitsProperties(fluent)) return true;
  if (page_.fluents.size() == query_.limit) {
    page_.next = ToString(QueryCursor{as_of_, told_});
    return false;
  }
  told_ = {name, validity.world, validity.start.earliest, validity.id};
  page_.fluents.push_back(std::move(fluent));
  return true;
}

}  // namespace hires::knowledge
