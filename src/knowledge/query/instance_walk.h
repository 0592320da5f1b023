#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "knowledge/query/access_paths.h"
#include "knowledge/query/page_builder.h"

namespace hires::knowledge {

/// Offers what instances had, one instance after the other in order of their names, from where the
/// page before ended: where they are given, or where too much may match to be sorted.
class InstanceWalk {
 public:
  /// @param after  Last fluent of the page before, if there was one.
  InstanceWalk(const QueryConditions& conditions, std::optional<QueryPosition> after,
               QueryStatements* statements, PageBuilder* page);

  void Through(NamedInstances instances);
  void ThroughAll();
  std::uint64_t visited() const { return visited_; }  ///< rows, those offered to the page apart

 private:
  bool Instance(const Instances::Named& named);  // all that return bool: false: the page is full
  bool World(const Instances::Named& named, std::int64_t world);
  bool Stretch(const Instances::Named& named, const QueryPosition& from);
  bool Newest(const Instances::Named& named, std::int64_t world);
  QueryPosition FirstInReach(const Instances::Named& named, std::int64_t world);

  const QueryConditions& conditions_;
  std::optional<QueryPosition> after_;
  QueryStatements* statements_;
  PageBuilder* page_;
  std::uint64_t visited_{0};
};

}  // namespace hires::knowledge
