// Where too much can match to be sorted: instances in order of their names, one by one.
#include <sqlite3.h>

#include <algorithm>

#include "knowledge/store/store_query.h"

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;

}  // namespace

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
  ++page_.visited;
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
QueryPosition QueryRun::FirstInReach(const Instances::Named& named, std::int64_t world) {
  QueryPosition first{named.name, world, -temporal::kForever, 0};
  Rows rows(statements_->reach, named.id, world, earliest_finish_, as_of_);
  while (rows.Next()) {
    ++page_.visited;
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

}  // namespace hires::knowledge
