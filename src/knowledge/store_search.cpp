#include <sqlite3.h>

#include <algorithm>
#include <cmath>

#include "store_codec.h"
#include "store_query.h"

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;

// Up to so many candidates are sorted in memory (some 3 MB); more are walked through by name.
constexpr std::size_t kMaxCandidates = 20'000;
// A filler that more validities have is no short cut.
constexpr int kMaxOfFiller = 2'000;
constexpr int kBelowAnyLevel = -5000;

}  // namespace

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
