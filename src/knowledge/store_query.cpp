#include "store_query.h"

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
#include "store_codec.h"

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;

// Up to so many candidates are sorted in memory (some 3 MB); more are walked through by name.
constexpr std::size_t kMaxCandidates = 20'000;
// A filler that more validities have is no short cut.
constexpr int kMaxOfFiller = 2'000;
constexpr int kBelowAnyLevel = -5000;

const std::string kLight = "SELECT id, instance, world, concept, start_earliest FROM validity ";
const std::string kAll = std::string("SELECT") + kValidityColumns + "FROM validity ";

bool IsNumber(const Filler& filler) {
  return std::holds_alternative<double>(filler) || std::holds_alternative<std::int64_t>(filler);
}

/// Integers beyond 2^53 do not all fit a double, so two of them compare as they are.
bool SameNumber(const Filler& a, const Filler& b) {
  if (a.index() == b.index()) return a == b;
  const auto value = [](const Filler& filler) {
    const auto* integer = std::get_if<std::int64_t>(&filler);
    return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(filler);
  };
  return value(a) == value(b);
}

bool SameFiller(const Filler& a, const Filler& b) {
  const auto* text = std::get_if<std::string>(&a);
  const auto* other = std::get_if<std::string>(&b);
  if (text != nullptr && other != nullptr) return base::ToLower(*text) == base::ToLower(*other);
  return IsNumber(a) && IsNumber(b) ? SameNumber(a, b) : a == b;
}

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

QueryStatements::QueryStatements(StoreFile* file)
    : levels(file->database(), "SELECT min(level) FROM validity WHERE world = ? AND level > ?"),
      window(file->database(),
             "SELECT id, instance, world, concept, start_earliest "
             "FROM validity INDEXED BY validity_when WHERE world = ? AND level = ? "
             "AND start_earliest >= ? AND start_earliest <= ? AND finish_latest > ?"),
      replaced(file->database(), "SELECT previous FROM validity WHERE id > ? AND updated = 1"),
      removed(file->database(), "SELECT validity FROM removal WHERE sequence > ?"),
      filler(file->database(), "SELECT validity FROM filler WHERE hash = ? LIMIT ?"),
      episode(file->database(), kLight + "WHERE episode = ? AND episode <> 0"),
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

bool QueryRun::FitsProperty(const Fluent& fluent, const FluentQuery::PropertyFilter& filter) const {
  return std::any_of(fluent.properties.begin(), fluent.properties.end(), [&](const Property& p) {
    return p.role == filter.role && (!filter.filler || SameFiller(p.filler, *filter.filler));
  });
}

bool QueryRun::FitsProperties(const Fluent& fluent) const {
  const auto fits = [&](const FluentQuery::PropertyFilter& filter) {
    return FitsProperty(fluent, filter);
  };
  const auto& filters = query_.properties;
  if (filters.empty() || query_.all_properties) {
    return std::all_of(filters.begin(), filters.end(), fits);
  }
  return std::any_of(filters.begin(), filters.end(), fits);
}

bool QueryRun::Consider(const Validity& validity, const std::string& name) {
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

// --------------------------------------------------------------------- few candidates, then sorted

/// False where there are too many.
bool QueryRun::Gather(const Light& light, std::vector<Candidate>* candidates) const {
  if (light.id > as_of_ || !FitsWorld(light.world) || !FitsConcept(light.concept_id)) return true;
  if (candidates->size() == kMaxCandidates) return false;
  Candidate candidate;
  candidate.instance = light.instance;
  candidate.position = {parts_->instances.Name(light.instance), light.world, light.start, light.id};
  if (!from_ || *from_ < candidate.position) candidates->push_back(std::move(candidate));
  return true;
}

bool QueryRun::Gather(std::int64_t id, std::vector<Candidate>* candidates) const {
  const auto validity = parts_->validities.Find(id);
  if (!validity) return true;
  return Gather(Light{id, validity->instance, validity->world, validity->concept_id,
                      validity->start.earliest},
                candidates);
}

std::vector<std::int64_t> QueryRun::WorldsToSearch() const {
  if (only_world_) return {*only_world_};
  std::vector<std::int64_t> worlds = parts_->episodes.Imagined();
  if (!query_.label) worlds.insert(worlds.begin(), 0);
  return worlds;
}

bool QueryRun::GatherLevel(std::int64_t world, int level,
                           std::vector<Candidate>* candidates) const {
  // What lasts less than 2^level and ends after a moment began less than 2^level before it.
  const bool bounded = level != kLevelOpen && level != kLevelSinceEver;
  const double from = bounded ? earliest_finish_ - std::ldexp(1.0, level) : -temporal::kForever;
  Rows rows(statements_->window, world, level, from, latest_start_, earliest_finish_);
  while (rows.Next()) {
    const Light light{rows.Integer(0), rows.Integer(1), rows.Integer(2), rows.Integer(3),
                      rows.Real(4)};
    if (!Gather(light, candidates)) return false;
  }
  return true;
}

bool QueryRun::GatherWindow(std::int64_t world, std::vector<Candidate>* candidates) const {
  if (query_.time.kind == TimeKind::kNow) return GatherLevel(world, kLevelOpen, candidates);
  for (int level = kBelowAnyLevel;;) {
    {
      Rows rows(statements_->levels, world, level);
      if (!rows.Next() || rows.IsNull(0)) return true;
      level = static_cast<int>(rows.Integer(0));
    }
    if (!GatherLevel(world, level, candidates)) return false;
  }
}

/// What was ended after the page's moment had not ended then.
bool QueryRun::GatherReopened(std::vector<Candidate>* candidates) const {
  if (as_of_ == last_) return true;
  if (last_ - as_of_ > static_cast<std::int64_t>(kMaxCandidates)) return false;
  for (SQLite::Statement* statement : {&statements_->replaced, &statements_->removed}) {
    Rows rows(*statement, as_of_);
    while (rows.Next()) {
      if (!Gather(rows.Integer(0), candidates)) return false;
    }
  }
  return true;
}

QueryRun::Candidates QueryRun::ByWindow() const {
  std::vector<Candidate> candidates;
  for (const std::int64_t world : WorldsToSearch()) {
    if (!GatherWindow(world, &candidates)) return std::nullopt;
  }
  if (!GatherReopened(&candidates)) return std::nullopt;
  return candidates;
}

QueryRun::Candidates QueryRun::ByFiller() const {
  if (!query_.all_properties && query_.properties.size() > 1) return std::nullopt;
  for (const FluentQuery::PropertyFilter& filter : query_.properties) {
    const auto* text = filter.filler ? std::get_if<std::string>(&*filter.filler) : nullptr;
    if (text == nullptr) continue;
    std::vector<std::int64_t> ids;
    Rows rows(statements_->filler, FillerHash(filter.role, *text), kMaxOfFiller + 1);
    while (rows.Next()) ids.push_back(rows.Integer(0));
    if (ids.size() > static_cast<std::size_t>(kMaxOfFiller)) continue;
    std::vector<Candidate> candidates;
    for (const std::int64_t id : ids) Gather(id, &candidates);
    return candidates;
  }
  return std::nullopt;
}

QueryRun::Candidates QueryRun::ByEpisode() const {
  if (!query_.episode || *query_.episode == 0) return std::nullopt;
  std::vector<Candidate> candidates;
  Rows rows(statements_->episode, *query_.episode);
  while (rows.Next()) {
    const Light light{rows.Integer(0), rows.Integer(1), rows.Integer(2), rows.Integer(3),
                      rows.Real(4)};
    if (!Gather(light, &candidates)) return std::nullopt;
  }
  return candidates;
}

QueryRun::Candidates QueryRun::FewCandidates() const {
  if (auto candidates = ByFiller()) return candidates;
  if (auto candidates = ByEpisode()) return candidates;
  if (query_.time.kind != TimeKind::kEver) return ByWindow();
  return std::nullopt;
}

void QueryRun::Take(std::vector<Candidate> candidates) {
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.position < b.position; });
  std::int64_t taken = 0;
  for (const Candidate& candidate : candidates) {
    if (candidate.position.id == taken) continue;  // found in two ways
    taken = candidate.position.id;
    const auto validity = parts_->validities.Find(taken);
    if (validity && !Consider(*validity, candidate.position.name)) return;
  }
}

// ----------------------------------------------------------------------- many: by name, one by one

void QueryRun::ListInstancesOfConcepts() {
  if (!concepts_) return;
  std::vector<Instances::Named> named;
  for (std::size_t concept_id = 0; concept_id < concepts_->size(); ++concept_id) {
    if (!(*concepts_)[concept_id]) continue;
    Rows rows(statements_->of_concept, static_cast<std::int64_t>(concept_id));
    while (rows.Next()) {
      if (named.size() == kMaxCandidates) return;
      named.push_back({rows.Integer(0), parts_->instances.Name(rows.Integer(0))});
    }
  }
  list_ = std::move(named);
}

void QueryRun::WalkList() {
  const auto earlier = [](const Instances::Named& a, const Instances::Named& b) {
    return sqlite3_stricmp(a.name.c_str(), b.name.c_str()) < 0;
  };
  std::sort(list_->begin(), list_->end(), earlier);
  std::int64_t walked = 0;
  for (const Instances::Named& named : *list_) {
    if (named.id == walked) continue;  // listed twice
    walked = named.id;
    if (from_ && sqlite3_stricmp(named.name.c_str(), from_->name.c_str()) < 0) continue;
    if (!WalkInstance(named)) return;
  }
}

void QueryRun::WalkAll() {
  Rows rows(statements_->instances, from_ ? from_->name : std::string());
  while (rows.Next()) {
    if (!WalkInstance({rows.Integer(0), rows.Text(1)})) return;
  }
}

bool QueryRun::WalkInstance(const Instances::Named& named) {
  if (only_world_) return WalkWorld(named, *only_world_);
  for (std::int64_t world = query_.label ? 1 : 0;; ++world) {
    {
      Rows rows(statements_->worlds, named.id, world);
      if (!rows.Next() || rows.IsNull(0)) return true;
      world = rows.Integer(0);
    }
    if (!WalkWorld(named, world)) return false;
  }
}

bool QueryRun::WalkWorld(const Instances::Named& named, std::int64_t world) {
  QueryPosition begin{named.name, world, -temporal::kForever, 0};
  if (from_ && sqlite3_stricmp(named.name.c_str(), from_->name.c_str()) == 0) {
    if (world < from_->world) return true;
    if (world == from_->world) begin = *from_;
  }
  if (query_.time.kind == TimeKind::kNow) {
    return begin.id != 0 || ConsiderNewest(named, world);  // at most one, and told if the last
  }
  const bool whole = query_.time.kind == TimeKind::kEver;
  if (begin.id == 0 && !whole) begin = FirstInReach(named, world);
  return WalkStretch(named, begin);
}

/// Just before the first validity that may still last after `earliest_finish_`.
QueryPosition QueryRun::FirstInReach(const Instances::Named& named, std::int64_t world) const {
  QueryPosition first{named.name, world, -temporal::kForever, 0};
  Rows rows(statements_->reach, named.id, world, earliest_finish_, as_of_);
  while (rows.Next()) {
    first.start = rows.Real(0);
    first.id = rows.Integer(1) - 1;
    if (rows.Real(2) <= earliest_finish_) return first;
  }
  return {named.name, world, -temporal::kForever, 0};
}

bool QueryRun::ConsiderNewest(const Instances::Named& named, std::int64_t world) {
  Rows rows(statements_->newest, named.id, world, as_of_);
  return !rows.Next() || Consider(ReadValidity(&rows), named.name);
}

bool QueryRun::WalkStretch(const Instances::Named& named, QueryPosition from) {
  Rows rows(statements_->stretch, named.id, from.world, from.start, from.id, latest_start_);
  while (rows.Next()) {
    if (!Consider(ReadValidity(&rows), named.name)) return false;
  }
  return true;
}

FluentPage QueryRun::Page() {
  if (concepts_ && concepts_->empty()) return std::move(page_);  // of none was anything said
  if (!list_) {
    if (auto candidates = FewCandidates()) {
      Take(std::move(*candidates));
      return std::move(page_);
    }
    ListInstancesOfConcepts();
  }
  if (list_) {
    WalkList();
  } else {
    WalkAll();
  }
  return std::move(page_);
}

}  // namespace hires::knowledge
