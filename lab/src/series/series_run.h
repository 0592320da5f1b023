#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/run_journal.h"
#include "hires/knowledge/store.h"

namespace hires::lab {

/// How a run of a series ended.
enum class SeriesOutcome {
  kSucceeded,   ///< the execution monitor says so
  kFailed,      ///< the task was begun and not done
  kImpossible,  ///< there is no plan, and nothing was begun
  kBroken       ///< what plays it died, or hung; says nothing of the scenario
};
std::string ToString(SeriesOutcome outcome);  ///< "succeeded", "failed", "impossible", "broken"

/// One run, as it ended.
struct SeriesRun {
  int run{1};                ///< 1, 2, ...
  std::vector<int> choices;  ///< of each group, from 0
  std::uint64_t seed{1};
  std::string instruction;  ///< as the file or the command says it
  std::string scenario, truth;
  std::string outcome;  ///< ToString(SeriesOutcome)
  std::string cause;    ///< one sentence; empty where it succeeded
  std::string failure;  ///< name of the failure that ended it, where a single one did
  /// How each try broke that was played again, and the last one where none was left.
  std::vector<std::string> broken_tries;
  std::string episode;            ///< name in the store's folder; empty: none was kept
  double simulated_seconds{0.0};  ///< [s]
  std::uint64_t fluents{0};       ///< on the Blackboard at the end, ended ones included
  /// Of them, those that it was given as knowledge before the run; nothing where no episode was
  /// kept, or an older journal does not tell.
  std::optional<std::uint64_t> known_fluents;
  std::vector<std::string> fallen;  ///< things that fell in truth
  std::string touched;              ///< the robot's first collision in truth, or empty
};
nlohmann::ordered_json ToJson(const SeriesRun& run);
/// @throws base::ConfigError naming `where` and the field.
SeriesRun ParseSeriesRun(const nlohmann::ordered_json& json, const std::string& where);

/// Takes over what `hires achieve --json` wrote.
/// @throws base::ConfigError naming `where` and the field.
void TakeAchieveReport(const nlohmann::ordered_json& json, const std::string& where,
                       SeriesRun* run);

/// Takes over how many fluents the run's Blackboard holds.
void TakeBlackboard(const knowledge::Store& store, SeriesRun* run);

/// The finished runs of a series, one behind the other (RunJournal).
class SeriesJournal {
 public:
  /// @param setting  all that runs have in common.
  /// @throws base::ConfigError as RunJournal, and where runs are missing between others.
  SeriesJournal(const std::string& path, const nlohmann::ordered_json& setting);

  const std::vector<SeriesRun>& runs() const { return runs_; }
  /// On the disk when this returns.  @throws base::ConfigError if it cannot be written.
  void Append(const SeriesRun& run);

 private:
  void Load(const SeriesRun& run, const std::string& where);

  std::vector<SeriesRun> runs_;
  RunJournal journal_;  // last: what is there is told to the others
};

}  // namespace hires::lab
