#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "hires/planning/planner.h"
#include "planning/proof/program.h"
#include "planning/search/search_path.h"

namespace hires::planning {

/// Why paths were given up, for people: the latest reasons, and those of the paths that led
/// furthest. Ask active() before a reason is put into words, for that takes time.
class SearchTrace {
 public:
  /// @param size     Latest reasons that are kept; 0: none.
  /// @param deepest  Whether those of the deepest paths are kept.
  SearchTrace(const Program& program, SearchPath* path, std::size_t size, bool deepest)
      : program_(program), path_(*path), size_(size), keeps_deepest_(deepest) {}

  bool active() const { return size_ > 0 || IsAmongDeepest(); }
  /// @param task  Nil where the reason speaks of no task.
  void Note(Term task, const std::string& where, const std::string& reason);
  /// "domain.lisp:12: method get, branch 2 'far'"
  std::string Where(const CompiledMethod& method, std::uint32_t branch) const;
  /// "domain.lisp:7: operator !drive"
  std::string Where(const CompiledOperator& applied) const;
  const std::deque<TraceEntry>& entries() const { return entries_; }
  const std::vector<TraceEntry>& deepest() const { return deepest_; }

 private:
  bool IsAmongDeepest() const {
    return keeps_deepest_ && (deepest_.empty() || path_.depth() >= deepest_.front().depth);
  }
  void NoteDeepest(const TraceEntry& entry);

  const Program& program_;
  SearchPath& path_;
  const std::size_t size_;
  const bool keeps_deepest_;
  std::deque<TraceEntry> entries_;
  std::vector<TraceEntry> deepest_;  ///< all of one depth
};

}  // namespace hires::planning
