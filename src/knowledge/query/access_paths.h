#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "knowledge/query/candidate_collector.h"
#include "knowledge/query/time_scan.h"

namespace hires::knowledge {

using NamedInstances = std::vector<Instances::Named>;

/// What an access path came to: the validities that may match, in order, each once; or the
/// instances that may have one.
using Found = std::variant<std::vector<QueryPosition>, NamedInstances>;

/// Ways through a store's indexes to what may match a query (docs/notes_blackboard.md lists them).
/// What was said decides which is the short one. So each is followed for a few rows, then each for
/// eight times as many, until one comes to its end.
class AccessPaths {
 public:
  /// @param start  Where the page begins.
  /// @param last  Sequence number of the store's last change.
  AccessPaths(const QueryConditions& conditions, const PageStart& start, std::int64_t last,
              StoreParts* parts, QueryStatements* statements);

  std::optional<Found> Find();  ///< nothing where there is too much on all of them
  std::uint64_t visited() const { return collector_.visited(); }  ///< rows

 private:
  using Path = std::function<bool()>;  // whether it was followed to its end

  std::vector<Path> Choose();
  std::vector<std::int64_t> Texts() const;
  bool Follow(const Path& path, std::int64_t allowance);
  bool ByOpenText(std::int64_t text);
  bool ByText(std::int64_t text);
  bool ByEpisode();
  bool ByTime();
  bool ByInstances();

  const QueryConditions& conditions_;
  std::int64_t last_;
  StoreParts* parts_;
  QueryStatements* statements_;
  CandidateCollector collector_;
  TimeScan scan_;
  std::optional<NamedInstances> instances_;  // that the path followed last came to
};

}  // namespace hires::knowledge
