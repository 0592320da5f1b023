#include "knowledge/query/time_scan.h"

#include <algorithm>
#include <cmath>

#include "knowledge/store/store_schema.h"

namespace hires::knowledge {
namespace {

constexpr int kBelowAnyLevel = -5000;

}  // namespace

TimeScan::TimeScan(const QueryConditions& conditions, std::int64_t last, StoreParts* parts,
                   QueryStatements* statements, CandidateCollector* collector)
    : conditions_(conditions),
      last_(last),
      parts_(parts),
      statements_(statements),
      collector_(collector) {}

/// Those that exist of the query's.
std::vector<std::int64_t> TimeScan::Worlds() const {
  const WorldRange& wanted = conditions_.worlds();
  if (wanted.IsOne()) return {wanted.first};
  std::vector<std::int64_t> worlds = parts_->episodes.Imagined();
  if (wanted.Contains(0)) worlds.insert(worlds.begin(), 0);
  return worlds;
}

bool TimeScan::Level(std::int64_t world, int level) {
  if (!collector_->Spend(kLookUp)) return false;
  const TimeReach& reach = conditions_.reach();
  // What lasts less than 2^level and ends after a moment began less than 2^level before it.
  const bool bounded = level != kLevelOpen && level != kLevelSinceEver;
  const double from =
      bounded ? reach.earliest_finish - std::ldexp(1.0, level) : -temporal::kForever;
  Rows rows(statements_->window, world, level, from, reach.latest_start, reach.earliest_finish);
  return collector_->AddRows(&rows, 1);
}

bool TimeScan::Open() {
  if (conditions_.concepts()) return OpenOfConcepts();
  const std::vector<std::int64_t> worlds = Worlds();
  return std::all_of(worlds.begin(), worlds.end(),
                     [this](std::int64_t world) { return Level(world, kLevelOpen); });
}

bool TimeScan::OpenOfConcepts() {
  const WorldRange& worlds = conditions_.worlds();
  for (const std::int64_t concept_id : conditions_.concepts()->Numbers()) {
    if (!collector_->Spend(kLookUp)) return false;
    Rows rows(statements_->open_of_concept, concept_id, worlds.first, worlds.last);
    if (!collector_->AddRows(&rows, 1)) return false;
  }
  return true;
}

bool TimeScan::OpenWithText(std::int64_t text) {
  const WorldRange& worlds = conditions_.worlds();
  Rows rows(statements_->open_filler, text, worlds.first, worlds.last);
  return collector_->AddRows(&rows, kLookUp);
}

bool TimeScan::ClosedIn(std::int64_t world) {
  for (int level = kBelowAnyLevel;;) {
    if (!collector_->Spend(kLookUp)) return false;
    {
      Rows rows(statements_->levels, world, level);
      if (!rows.Next() || rows.IsNull(0)) return true;
      level = static_cast<int>(rows.Integer(0));
    }
    if (level == kLevelOpen) return true;  // the highest
    if (!Level(world, level)) return false;
  }
}

bool TimeScan::Closed() {
  if (conditions_.time_kind() == FluentQuery::TimeFilter::Kind::kNow) return true;
  const std::vector<std::int64_t> worlds = Worlds();
  return std::all_of(worlds.begin(), worlds.end(),
                     [this](std::int64_t world) { return ClosedIn(world); });
}

bool TimeScan::Reopened() {
  const std::int64_t as_of = conditions_.as_of();
  if (as_of == last_) return true;
  if (last_ - as_of > static_cast<std::int64_t>(kMaxCandidates)) return collector_->GiveUp();
  for (SQLite::Statement* statement : {&statements_->replaced, &statements_->removed}) {
    Rows rows(*statement, as_of);
    if (!collector_->AddRows(&rows, kLookUp)) return false;
  }
  return true;
}

}  // namespace hires::knowledge
