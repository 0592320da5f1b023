#pragma once

#include <cstdint>
#include <vector>

#include "knowledge/query/candidate_collector.h"

namespace hires::knowledge {

/// Work, in rows of an index read one after the other, of a row that is found by its number.
constexpr int kLookUp = 4;

/// Gathers what reaches into a query's time, by the indexes of what is open and of what was closed.
/// What it returns is as in CandidateCollector.
class TimeScan {
 public:
  /// @param last  Sequence number of the store's last change.
  TimeScan(const QueryConditions& conditions, std::int64_t last, StoreParts* parts,
           QueryStatements* statements, CandidateCollector* collector);

  bool Open();
  /// @param text  FillerHash of a role and a text.
  bool OpenWithText(std::int64_t text);
  bool Closed();
  /// What was ended after the page's moment had not ended then.
  bool Reopened();

 private:
  std::vector<std::int64_t> Worlds() const;
  bool Level(std::int64_t world, int level);
  bool OpenOfConcepts();
  bool ClosedIn(std::int64_t world);

  const QueryConditions& conditions_;
  std::int64_t last_;
  StoreParts* parts_;
  QueryStatements* statements_;
  CandidateCollector* collector_;
};

}  // namespace hires::knowledge
