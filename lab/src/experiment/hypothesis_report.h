#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/src/experiment/hypothesis.h"
#include "lab/src/statistics.h"

namespace hires::lab {

/// What all runs had in common.
struct HypothesisSetting {
  std::string scenario;
  int runs{20};  ///< with imagination, and as many without
  std::uint64_t seed{1};
  double pace{1.0};
  int workers{1};
  std::string files;          ///< hash of configuration, worlds and robots: what the runs rest on
  bool is_local{false};       ///< played in one process, in virtual time: no pace, virtual workers
  std::string truth{"same"};  ///< what robot and world are really like
};

/// One arm of the experiment. Means are over runs that came to an end (`complete` of `runs`),
/// shares and falls over all.
struct HypothesisArm {
  int runs{0}, complete{0}, successes{0};
  int falls{0};                                 ///< of all objects in all runs
  std::map<std::string, int> broken_rules;      ///< complete runs that broke a rule of the judge
  Interval success;                             ///< share, with the exact 95 % interval
  double duration_mean{0.0}, duration_sd{0.0};  ///< [s]; sd divides by n
  double steps{0.0}, replans{0.0};              ///< means
  int dispatched{0}, in_time{0};                ///< imaginations, see HypothesisRun
  double imagination_wall{0.0};                 ///< [s] mean per run
};
HypothesisArm SumUpArm(const std::vector<HypothesisRun>& runs, bool imagines);

struct HypothesisReport {
  HypothesisSetting setting;
  std::vector<HypothesisRun> runs;  ///< by run, with imagination first
  HypothesisArm with, without;
  PairedCounts pairs;   ///< of successes; first: with imagination
  Interval difference;  ///< of the shares of success, with - without: PairedScoreInterval
};

/// @pre every run is there with and without imagination.  @throws std::logic_error if broken.
HypothesisReport SumUpHypothesis(const HypothesisSetting& setting, std::vector<HypothesisRun> runs);

std::string HypothesisText(const HypothesisReport& report);  ///< for people
std::string HypothesisCsv(const HypothesisReport& report);   ///< a line per run, with heads
/// For machines.  @param command  that repeats it.
nlohmann::ordered_json ToJson(const HypothesisReport& report, const std::string& command);

}  // namespace hires::lab
