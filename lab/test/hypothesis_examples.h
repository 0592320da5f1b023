#pragma once

#include <string>

#include "hires/base/error.h"
#include "lab/src/experiment/hypothesis.h"
#include "lab/src/experiment/hypothesis_report.h"

namespace hires::lab {

/// What `act` complains about.
template <typename Act>
std::string ErrorOf(const Act& act) {
  try {
    act();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

/// A run of the seed's experiment that came to its end.
inline HypothesisRun RecordOf(int run, bool imagines, bool success, std::uint64_t seed = 1) {
  HypothesisRun record;
  record.run = run;
  record.imagines = imagines;
  record.seed = SeedOfRun(seed, run);
  record.is_complete = true;
  record.outcome = success ? "succeeded" : "failed";
  record.success = success;
  record.verdict = success ? "mug1 stands on table1" : "no mug1 stands on table1";
  if (!success) record.broken_rules = {"not_there"};
  record.falls = success ? 0 : 1;
  record.duration = 100.0 + 10.0 * run;
  record.steps = imagines ? 12 : 10;
  record.recommended = {"move_base_param(area1, slow)", "none"};
  return record;
}

inline HypothesisSetting Setting(int runs) {
  return {"topple", runs, 1, 4.0, 2, "0123456789abcdef"};
}

}  // namespace hires::lab
