#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/statistics.h"

namespace hires::lab {

/// Times that a measurement reads [s]; from any start, never backwards.
struct LadderClocks {
  std::function<double()> wall;
  std::function<double()> processor;  ///< of all threads of this process together
};

/// How fast what is simulated, step by step as the dissertation made it faster (section 5.4.2).
struct LadderOrder {
  std::string package_folder;  ///< whose config and worlds are played
  double seconds{90.0};        ///< [s] of the wall's clock for everything; a guess is kept to
  int repeats{5};              ///< of each variant, at most; at least 2
  std::uint64_t seed{1};
  int answer_rollouts{64};  ///< of each alternative of the ranked answer
  LadderClocks clocks;
  /// Plays the scenario topple as a whole task on one thread; @return [s] simulated, nothing when
  /// cancelled. Empty: the rungs that need it are left out.
  std::function<std::optional<double>(std::uint64_t seed)> play_task;
};

/// What was measured of one way to simulate something.
struct LadderSide {
  std::string what;
  std::map<std::string, double> facts;  ///< what is simulated, in numbers: bodies, triangles, ...
  std::vector<double> values;           ///< one for each repeat
};

/// Two ways, by turns. What is better is larger.
struct LadderPair {
  int threads{1};  ///< on which each way was played at once
  int rounds{0};   ///< pieces of work of each repeat, the same for both ways
  LadderSide before, after;
  Interval ratio;  ///< after / before: t interval of the paired logarithms
};

/// A step of the dissertation. Its unit is the real-time factor, simulated / wall seconds
/// (Eq. 5.2).
struct LadderRung {
  std::string id, title;
  std::optional<double> published_before, published_after;
  std::string published;  ///< what the dissertation says, in words
  std::string note;       ///< what is otherwise here; or empty
  LadderPair one_core;
  std::optional<LadderPair> all_cores;  ///< where the step is worth it: sums over all threads
  /// [m] the farthest that an object ends from where it ends with the other way; nothing where the
  /// ways do not play the same motion.
  std::optional<double> apart;
};

/// A step of ours on the way from one step of the engine to a ranked answer.
struct LadderOwn {
  std::string id, title, unit;
  std::vector<double> values;
  Interval mean;  ///< t interval over repeats
};

struct LadderReport {
  int cores{1};         ///< threads that were used where all were
  double seconds{0.0};  ///< [s] wanted
  int repeats{0};
  std::uint64_t seed{0};
  double wall_seconds{0.0};  ///< [s] taken
  std::vector<LadderRung> rungs;
  std::vector<LadderOwn> own;
};

/// @param crew  its threads are "all cores".  @return nothing when it was cancelled.
/// @throws base::ConfigError for bad numbers or files, before anything is measured.
std::optional<LadderReport> ClimbLadder(const LadderOrder& order, const base::Crew& crew);

std::string ReportText(const LadderReport& report);
/// {"schema": "hires/ladder", "version": 1, ...}; the order of `rungs` and `own` is fixed.
nlohmann::ordered_json ToJson(const LadderReport& report);

}  // namespace hires::lab
