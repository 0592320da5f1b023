#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "lab/src/decision/decision_play.h"
#include "lab/src/run_journal.h"

namespace hires::lab {

/// One piece of a series that is played by itself.
struct DecisionPiece {
  enum class Kind { kImagined, kPlays, kOracle } kind{Kind::kImagined};
  DecisionTask task;       ///< kOracle: any of its cell
  std::string motion_set;  ///< kOracle
};

/// Which pieces a series needs.
struct DecisionNeeds {
  std::string truth{"same"};
  bool imagines{true};
  bool has_oracle{true};
};

/// The pieces of all series of one seed, whatever their truth, in a file of JSON lines. What was
/// imagined is found by the hash of its request, so truths share it; plays of the oracle belong to
/// a cell, so tasks share them. Several threads may use it.
class DecisionJournal {
 public:
  /// Begins the file, or goes on with it.  @param files  hash of all that pieces were played with.
  /// @throws base::ConfigError as RunJournal, and for lines that are no pieces.
  DecisionJournal(const std::string& path, std::uint64_t seed, const std::string& files);

  /// What these tasks lack, in their order, each piece once.
  std::vector<DecisionPiece> Missing(const std::vector<DecisionTask>& tasks,
                                     const DecisionNeeds& needs, const DecisionParts& parts) const;
  /// Plays one piece and writes it down.  @return false when cancelled.
  bool Play(const DecisionPiece& piece, const std::string& truth, const DecisionParts& parts);
  /// @pre nothing of it is missing.
  DecisionRecord RecordOf(const DecisionTask& task, const DecisionNeeds& needs,
                          const DecisionParts& parts) const;

 private:
  using PlaysKey = std::pair<std::string, int>;                         // truth, number
  using OracleKey = std::tuple<std::string, std::string, std::string>;  // truth, cell, motion set

  void Keep(const nlohmann::ordered_json& line, const std::string& where);
  void Append(const nlohmann::ordered_json& line);

  mutable std::mutex mutex_;
  std::map<std::string, ImaginedTask> imagined_;                // guarded: by hash of the request
  std::map<PlaysKey, std::map<std::string, TruthPlay>> plays_;  // guarded: by motion set
  std::map<OracleKey, std::vector<TruthPlay>> oracle_;          // guarded
  RunJournal journal_;  // guarded; last: what is there is told to the others
};

}  // namespace hires::lab
