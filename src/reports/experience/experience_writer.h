#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "hires/knowledge/experience.h"

namespace hires::reports {

/// Puts parts that come one by one into a store, in batches: a second's at a time, when another
/// action begins, and at once when the load topples. What cannot be written is kept and tried again
/// by Flush() alone, as a file that is locked takes its time to say so.
class ExperienceWriter {
 public:
  static constexpr std::size_t kBatch = 20;       ///< parts
  static constexpr std::size_t kMostKept = 3600;  ///< batches that wait to be written: an hour's

  /// @param store  must outlive this.  @param run  what parts belong to.
  ExperienceWriter(knowledge::ExperienceStore* store, std::string run);
  ~ExperienceWriter();  ///< writes what is there

  /// What the robot does from the next part on; "" while it does nothing.
  void SetAction(const std::string& action);
  void SetRun(const std::string& run);  ///< likewise
  void Add(const knowledge::ToppleEpisodePart& part);
  void Flush();

  std::uint64_t num_written() const { return num_written_; }
  std::uint64_t num_lost() const { return num_lost_; }  ///< too many waited
  /// Why the last batch is not written; empty: it is.
  const std::string& problem() const { return problem_; }

 private:
  knowledge::ExperienceStore* store_;
  knowledge::ExperienceBatch batch_;  // being filled
  std::deque<knowledge::ExperienceBatch> waiting_;
  knowledge::ToppleState last_{knowledge::ToppleState::kNoTopple};
  std::uint64_t num_written_{0}, num_lost_{0};
  std::string problem_;
};

}  // namespace hires::reports
