#include "knowledge/query/instance_walk.h"

#include <sqlite3.h>

#include <algorithm>
#include <utility>

namespace hires::knowledge {
namespace {

using TimeKind = FluentQuery::TimeFilter::Kind;

int Compare(const std::string& a, const std::string& b) {
  return sqlite3_stricmp(a.c_str(), b.c_str());
}

}  // namespace

InstanceWalk::InstanceWalk(const QueryConditions& conditions, std::optional<QueryPosition> after,
                           QueryStatements* statements, PageBuilder* page)
    : conditions_(conditions), after_(std::move(after)), statements_(statements), page_(page) {}

void InstanceWalk::Through(NamedInstances instances) {
  std::sort(instances.begin(), instances.end(),
            [](const auto& a, const auto& b) { return Compare(a.name, b.name) < 0; });
  std::int64_t walked = 0;
  for (const Instances::Named& named : instances) {
    if (named.id == walked) continue;  // listed twice
    walked = named.id;
    if (after_ && Compare(named.name, after_->name) < 0) continue;
    if (!Instance(named)) return;
  }
}

void InstanceWalk::ThroughAll() {
  Rows rows(statements_->instances, after_ ? after_->name : std::string());
  while (rows.Next()) {
    if (!Instance({rows.Integer(0), rows.Text(1)})) return;
  }
}

bool InstanceWalk::Instance(const Instances::Named& named) {
  ++visited_;
  const WorldRange& worlds = conditions_.worlds();
  if (worlds.IsOne()) return World(named, worlds.first);
  for (std::int64_t world = worlds.first;; ++world) {
    {
      Rows rows(statements_->worlds, named.id, world);
      if (!rows.Next() || rows.IsNull(0)) return true;
      world = rows.Integer(0);
    }
    if (!World(named, world)) return false;
  }
}

bool InstanceWalk::World(const Instances::Named& named, std::int64_t world) {
  QueryPosition begin{named.name, world, -temporal::kForever, 0};
  if (after_ && Compare(named.name, after_->name) == 0) {
    if (world < after_->world) return true;
    if (world == after_->world) begin = *after_;
  }
  if (conditions_.time_kind() == TimeKind::kNow) {
    return begin.id != 0 || Newest(named, world);  // at most one, and told if the last
  }
  const bool whole = conditions_.time_kind() == TimeKind::kEver;
  if (begin.id == 0 && !whole) begin = FirstInReach(named, world);
  return Stretch(named, begin);
}

/// Just before the first validity that may still last after the reach's earliest finish.
QueryPosition InstanceWalk::FirstInReach(const Instances::Named& named, std::int64_t world) {
  const double earliest_finish = conditions_.reach().earliest_finish;
  QueryPosition first{named.name, world, -temporal::kForever, 0};
  Rows rows(statements_->reach, named.id, world, earliest_finish, conditions_.as_of());
  while (rows.Next()) {
    ++visited_;
    first.start = rows.Real(0);
    first.id = rows.Integer(1) - 1;
    if (rows.Real(2) <= earliest_finish) return first;
  }
  return {named.name, world, -temporal::kForever, 0};
}

bool InstanceWalk::Newest(const Instances::Named& named, std::int64_t world) {
  Rows rows(statements_->newest, named.id, world, conditions_.as_of());
  return !rows.Next() || page_->Offer(ReadValidity(&rows), named.name);
}

bool InstanceWalk::Stretch(const Instances::Named& named, const QueryPosition& from) {
  Rows rows(statements_->stretch, named.id, from.world, from.start, from.id,
            conditions_.reach().latest_start);
  while (rows.Next()) {
    if (!page_->Offer(ReadValidity(&rows), named.name)) return false;
  }
  return true;
}

}  // namespace hires::knowledge
