#include "knowledge/query/candidate_collector.h"

#include <algorithm>
#include <utility>

namespace hires::knowledge {

CandidateCollector::CandidateCollector(const QueryConditions& conditions,
                                       std::optional<QueryPosition> after, Instances* instances)
    : conditions_(conditions), after_(std::move(after)), instances_(instances) {}

void CandidateCollector::Begin(std::int64_t allowance) {
  allowance_ = allowance;
  gave_up_ = false;
  candidates_.clear();
}

bool CandidateCollector::GiveUp() {
  gave_up_ = true;
  return false;
}

bool CandidateCollector::Add(const IndexEntry& entry) {
  if (!conditions_.MayFit(entry)) return true;
  if (candidates_.size() == kMaxCandidates) return GiveUp();
  QueryPosition position{instances_->Name(entry.instance), entry.world, entry.start, entry.id};
  if (!after_ || *after_ < position) candidates_.push_back(std::move(position));
  return true;
}

bool CandidateCollector::AddRows(Rows* rows, int work) {
  while (rows->Next()) {
    if (!Spend(work) || !Add(ReadIndexEntry(rows))) return false;
  }
  return true;
}

std::vector<QueryPosition> CandidateCollector::Take() {
  const auto is_same = [](const QueryPosition& a, const QueryPosition& b) { return a.id == b.id; };
  std::sort(candidates_.begin(), candidates_.end());
  candidates_.erase(std::unique(candidates_.begin(), candidates_.end(), is_same),
                    candidates_.end());
  return std::move(candidates_);
}

}  // namespace hires::knowledge
