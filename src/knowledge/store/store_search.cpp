#include <algorithm>
#include <cmath>
#include <limits>

#include "knowledge/store/store_codec.h"
#include "knowledge/store/store_query.h"

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;

// Up to so many candidates are sorted in memory (some 3 MB); more are walked through by name.
constexpr std::size_t kMaxCandidates = 20'000;
// A text that more validities ever had is no short cut to them.
constexpr std::int64_t kMaxOfText = 2'000;
constexpr int kBelowAnyLevel = -5000;

// Work, in rows of an index read one after the other.
constexpr int kLookUp = 4;         // a row found by its number
constexpr int kWalkInstance = 16;  // an instance, and what holds of it
// The state of a restaurant is found at the first try; what a wrong road costs is a millisecond.
constexpr std::int64_t kFirstAllowance = 4096;
constexpr std::int64_t kPatience = 8;  // times as much work is allowed the next time
constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();

}  // namespace

// ---------------------------------------------------------------------------- what lies on a road

/// False where the road has cost what it may.
bool QueryRun::Spend(int work) {
  ++page_.visited;
  allowance_ -= work;
  return allowance_ >= 0;
}

bool QueryRun::Gather(const Light& light) {
  const bool fits = light.id <= as_of_ && light.start <= latest_start_ && FitsWorld(light.world) &&
                    FitsConcept(light.concept_id);
  if (!fits) return true;
  is_endless_ = candidates_.size() == kMaxCandidates;
  if (is_endless_) return false;
  QueryPosition position{parts_->instances.Name(light.instance), light.world, light.start,
                         light.id};
  if (!from_ || *from_ < position) candidates_.push_back(std::move(position));
  return true;
}

QueryRun::Light QueryRun::ReadLight(Rows* rows) {
  return {rows->Integer(0), rows->Integer(1), rows->Integer(2), rows->Integer(3), rows->Real(4)};
}

bool QueryRun::GatherRows(Rows* rows, int work) {
  while (rows->Next()) {
    if (!Spend(work) || !Gather(ReadLight(rows))) return false;
  }
  return true;
}

std::vector<std::int64_t> QueryRun::WorldsToSearch() const {
  if (only_world_) return {*only_world_};
  std::vector<std::int64_t> worlds = parts_->episodes.Imagined();
  if (!query_.label) worlds.insert(worlds.begin(), 0);
  return worlds;
}

/// From the first to the last that may fit.
std::pair<std::int64_t, std::int64_t> QueryRun::WorldRange() const {
  if (only_world_) return {*only_world_, *only_world_};
  return {query_.label ? 1 : 0, std::numeric_limits<std::int64_t>::max()};
}

bool QueryRun::GatherLevel(std::int64_t world, int level) {
  if (!Spend(kLookUp)) return false;
  // What lasts less than 2^level and ends after a moment began less than 2^level before it.
  const bool bounded = level != kLevelOpen && level != kLevelSinceEver;
  const double from = bounded ? earliest_finish_ - std::ldexp(1.0, level) : -temporal::kForever;
  Rows rows(statements_->window, world, level, from, latest_start_, earliest_finish_);
  return GatherRows(&rows, 1);
}

bool QueryRun::GatherOpen() {
  if (concepts_) return GatherOpenOfConcepts();
  const std::vector<std::int64_t> worlds = WorldsToSearch();
  return std::all_of(worlds.begin(), worlds.end(),
                     [this](std::int64_t world) { return GatherLevel(world, kLevelOpen); });
}

bool QueryRun::GatherOpenOfConcepts() {
  const auto [first, last] = WorldRange();
  for (std::size_t concept_id = 0; concept_id < concepts_->size(); ++concept_id) {
    if (!(*concepts_)[concept_id]) continue;
    if (!Spend(kLookUp)) return false;
    Rows rows(statements_->open_of_concept, static_cast<std::int64_t>(concept_id), first, last);
    if (!GatherRows(&rows, 1)) return false;
  }
  return true;
}

bool QueryRun::GatherOpenWithText(std::int64_t text) {
  const auto [first, last] = WorldRange();
  Rows rows(statements_->open_filler, text, first, last);
  return GatherRows(&rows, kLookUp);
}

bool QueryRun::GatherClosed(std::int64_t world) {
  for (int level = kBelowAnyLevel;;) {
    if (!Spend(kLookUp)) return false;
    {
      Rows rows(statements_->levels, world, level);
      if (!rows.Next() || rows.IsNull(0)) return true;
      level = static_cast<int>(rows.Integer(0));
    }
    if (level == kLevelOpen) return true;  // the highest
    if (!GatherLevel(world, level)) return false;
  }
}

bool QueryRun::GatherClosed() {
  if (query_.time.kind == TimeKind::kNow) return true;
  const std::vector<std::int64_t> worlds = WorldsToSearch();
  return std::all_of(worlds.begin(), worlds.end(),
                     [this](std::int64_t world) { return GatherClosed(world); });
}

/// What was ended after the page's moment had not ended then.
bool QueryRun::GatherReopened() {
  if (as_of_ == last_) return true;
  is_endless_ = last_ - as_of_ > static_cast<std::int64_t>(kMaxCandidates);
  if (is_endless_) return false;
  for (SQLite::Statement* statement : {&statements_->replaced, &statements_->removed}) {
    Rows rows(*statement, as_of_);
    if (!GatherRows(&rows, kLookUp)) return false;
  }
  return true;
}

// ------------------------------------------------------------------------------------- the roads

bool QueryRun::ByOpenText(std::int64_t text) {
  return GatherOpenWithText(text) && GatherClosed() && GatherReopened();
}

bool QueryRun::ByText(std::int64_t text) {
  Rows rows(statements_->filler, text);
  for (std::int64_t count = 0; rows.Next(); ++count) {
    is_endless_ = count == kMaxOfText;
    if (is_endless_ || !Spend(kLookUp) || !Gather(ReadLight(&rows))) return false;
  }
  return true;
}

bool QueryRun::ByEpisode(std::int64_t /*text*/) {
  Rows rows(statements_->episode, *query_.episode);
  return GatherRows(&rows, kLookUp);
}

bool QueryRun::ByTime(std::int64_t /*text*/) {
  return GatherOpen() && GatherClosed() && GatherReopened();
}

bool QueryRun::ByInstances(std::int64_t /*text*/) {
  std::vector<Instances::Named> named;
  for (std::size_t concept_id = 0; concept_id < concepts_->size(); ++concept_id) {
    if (!(*concepts_)[concept_id]) continue;
    Rows rows(statements_->of_concept, static_cast<std::int64_t>(concept_id));
    while (rows.Next()) {
      is_endless_ = named.size() == kMaxCandidates;
      if (is_endless_ || !Spend(kWalkInstance)) return false;
      named.push_back({rows.Integer(0), parts_->instances.Name(rows.Integer(0))});
    }
  }
  list_ = std::move(named);
  return true;
}

/// Of which every match has each.
std::vector<std::int64_t> QueryRun::Texts() const {
  if (!query_.all_properties && query_.properties.size() > 1) return {};
  std::vector<std::int64_t> texts;
  for (const FluentQuery::PropertyFilter& filter : query_.properties) {
    const auto* text = filter.filler ? std::get_if<std::string>(&*filter.filler) : nullptr;
    if (text != nullptr) texts.push_back(FillerHash(filter.role, *text));
  }
  return texts;
}

std::vector<QueryRun::Road> QueryRun::Roads() const {
  const bool ever = query_.time.kind == TimeKind::kEver;
  // Then what is open is all there can be, and there is an index for it.
  const bool now = query_.time.kind == TimeKind::kNow && as_of_ == last_;
  std::vector<Road> roads;
  for (const std::int64_t text : Texts()) {
    if (!ever) roads.push_back({&QueryRun::ByOpenText, text});
    if (!now) roads.push_back({&QueryRun::ByText, text});
  }
  if (query_.episode && *query_.episode != 0) roads.push_back({&QueryRun::ByEpisode});
  if (!ever) roads.push_back({&QueryRun::ByTime});
  if (concepts_ && !now) roads.push_back({&QueryRun::ByInstances});
  return roads;
}

bool QueryRun::Follow(const Road& road, std::int64_t allowance) {
  allowance_ = allowance;
  is_endless_ = false;
  candidates_.clear();
  return (this->*road.follow)(road.text);
}

/// False where there is too much on all of them.
bool QueryRun::FindRoad() {
  std::vector<Road> roads = Roads();
  for (std::int64_t allowance = kFirstAllowance; !roads.empty(); allowance *= kPatience) {
    for (auto road = roads.begin(); road != roads.end();) {
      if (Follow(*road, roads.size() == 1 ? kUnlimited : allowance)) return true;
      road = is_endless_ ? roads.erase(road) : road + 1;
    }
  }
  return false;
}

void QueryRun::TakeCandidates() {
  std::sort(candidates_.begin(), candidates_.end());
  std::int64_t taken = 0;
  for (const QueryPosition& candidate : candidates_) {
    if (candidate.id == taken) continue;  // found in two ways
    taken = candidate.id;
    const auto validity = parts_->validities.Find(taken);
    if (validity && !Consider(*validity, candidate.name)) return;
  }
}

FluentPage QueryRun::Page() {
  if (concepts_ && concepts_->empty()) return std::move(page_);  // of none was anything said
  const bool is_restricted = list_.has_value();
  if (!is_restricted && !FindRoad()) {
    WalkAll();
  } else if (list_) {
    WalkList();
  } else {
    TakeCandidates();
  }
  return std::move(page_);
}

}  // namespace hires::knowledge
