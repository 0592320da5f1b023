#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "hires/planning/planner.h"
#include "planning/proof/program.h"
#include "planning/search/search_path.h"

namespace hires::planning {

/// Why paths were given up, the latest reasons, for people. Ask active() before a reason is put
/// into words, for that takes time.
class SearchTrace {
 public:
  /// @param size  Reasons that are kept; 0: none.
  SearchTrace(const Program& program, SearchPath* path, std::size_t size)
      : program_(program), path_(*path), size_(size) {}

  bool active() const { return size_ > 0; }
  /// @param task  Nil where the reason speaks of no task.
  void Note(Term task, const std::string& where, const std::string& reason);
  /// "domain.lisp:12: method get, branch 2 'far'"
  std::string Where(const CompiledMethod& method, std::uint32_t branch) const;
  /// "domain.lisp:7: operator !drive"
  std::string Where(const CompiledOperator& applied) const;
  const std::deque<TraceEntry>& entries() const { return entries_; }

 private:
  const Program& program_;
  SearchPath& path_;
  const std::size_t size_;
  std::deque<TraceEntry> entries_;
};

}  // namespace hires::planning
