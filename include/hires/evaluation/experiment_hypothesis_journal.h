#pragma once

#include <string>
#include <vector>

#include "hires/evaluation/experiment_hypothesis_report.h"

namespace hires::evaluation {

/// Finished runs in a file of JSON lines, so that hours of work outlive whatever ends the program.
/// The first line says what the runs have in common. A last line that was cut off is dropped.
class HypothesisJournal {
 public:
  /// Begins the file, or goes on with one of the same setting. One program at a time.
  /// @throws base::ConfigError naming file and line: it cannot be written, is in use, is no
  /// journal, is broken elsewhere than at its end, or belongs to another setting (named).
  HypothesisJournal(const std::string& path, const HypothesisSetting& setting);
  ~HypothesisJournal();
  HypothesisJournal(const HypothesisJournal&) = delete;
  HypothesisJournal& operator=(const HypothesisJournal&) = delete;

  const std::vector<HypothesisRun>& runs() const { return runs_; }
  bool Has(int run, bool imagines) const;

  /// On the disk when this returns.  @throws base::ConfigError if it cannot be written.
  void Append(const HypothesisRun& run);

 private:
  void Load(const HypothesisSetting& setting);
  void AppendLine(const std::string& line);

  std::string path_;
  int fd_{-1};
  std::vector<HypothesisRun> runs_;
};

}  // namespace hires::evaluation
