#pragma once

#include <string>
#include <vector>

#include "lab/src/experiment/hypothesis_report.h"
#include "lab/src/run_journal.h"

namespace hires::lab {

/// The finished runs of an experiment (RunJournal).
class HypothesisJournal {
 public:
  /// @throws base::ConfigError as RunJournal, and for a run that is not of this setting.
  HypothesisJournal(const std::string& path, const HypothesisSetting& setting);

  const std::vector<HypothesisRun>& runs() const { return runs_; }
  bool Has(int run, bool imagines) const;

  /// On the disk when this returns.  @throws base::ConfigError if it cannot be written.
  void Append(const HypothesisRun& run);

 private:
  void Load(const HypothesisSetting& setting, const HypothesisRun& run, const std::string& where);

  std::vector<HypothesisRun> runs_;
  RunJournal journal_;  // last: what is there is told to the others
};

}  // namespace hires::lab
