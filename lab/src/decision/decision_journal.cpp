#include "lab/src/decision/decision_journal.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "lab/src/decision/decision_record.h"
#include "hires/base/error.h"
#include "hires/base/hash.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;
using Kind = DecisionPiece::Kind;

constexpr char kKind[] = "hires decision 2";

std::string RequestOf(const DecisionTask& task, const DecisionParts& parts) {
  return base::HexOf(RequestHash(task, parts));
}

}  // namespace

DecisionJournal::DecisionJournal(const std::string& path, std::uint64_t seed,
                                 const std::string& files)
    : journal_(path, {{"journal", kKind}, {"seed", seed}, {"files", files}},
               [this](const ordered_json& line, const std::string& where) { Keep(line, where); }) {}

std::vector<DecisionPiece> DecisionJournal::Missing(const std::vector<DecisionTask>& tasks,
                                                    const DecisionNeeds& needs,
                                                    const DecisionParts& parts) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<DecisionPiece> missing;
  std::set<std::string> cells;
  for (const DecisionTask& task : tasks) {
    if (needs.imagines && imagined_.count(RequestOf(task, parts)) == 0) {
      missing.push_back({Kind::kImagined, task, ""});
    }
    if (plays_.count({needs.truth, task.number}) == 0) missing.push_back({Kind::kPlays, task, ""});
    if (!needs.has_oracle || !cells.insert(CellOf(task)).second) continue;
    for (const std::string& set : DecisionAlternatives()) {
      if (oracle_.count({needs.truth, CellOf(task), set}) > 0) continue;
      missing.push_back({Kind::kOracle, task, set});
    }
  }
  return missing;
}

bool DecisionJournal::Play(const DecisionPiece& piece, const std::string& truth,
                           const DecisionParts& parts) {
  const DecisionTask& task = piece.task;
  if (piece.kind == Kind::kImagined) {
    const auto imagined = Imagine(task, parts);
    if (imagined) Append({{"request", RequestOf(task, parts)}, {"imagined", ToJson(*imagined)}});
    return imagined.has_value();
  }
  if (piece.kind == Kind::kPlays) {
    const auto plays = PlayAlternatives(task, parts);
    if (plays) Append({{"truth", truth}, {"task", task.number}, {"plays", ToJson(*plays)}});
    return plays.has_value();
  }
  const auto plays = PlayForOracle(task, piece.motion_set, parts);
  if (plays) {
    Append({{"truth", truth},
            {"cell", CellOf(task)},
            {"motion_set", piece.motion_set},
            {"plays", ToJson(*plays)}});
  }
  return plays.has_value();
}

DecisionRecord DecisionJournal::RecordOf(const DecisionTask& task, const DecisionNeeds& needs,
                                         const DecisionParts& parts) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  DecisionRecord record;
  record.task = task;
  record.plays = plays_.at({needs.truth, task.number});
  if (needs.imagines) record.imagined = imagined_.at(RequestOf(task, parts));
  if (!needs.has_oracle) return record;
  for (const std::string& set : DecisionAlternatives()) {
    record.oracle[set] = oracle_.at({needs.truth, CellOf(task), set});
  }
  return record;
}

void DecisionJournal::Append(const ordered_json& line) {
  const std::lock_guard<std::mutex> lock(mutex_);
  journal_.Append(line);
  Keep(line, "a piece that was just played");
}

void DecisionJournal::Keep(const ordered_json& line, const std::string& where) {
  try {
    if (line.contains("imagined")) {
      imagined_[line.at("request").get<std::string>()] = ParseImagined(line.at("imagined"));
      return;
    }
    const std::string truth = line.at("truth").get<std::string>();
    if (line.contains("task")) {
      plays_[{truth, line.at("task").get<int>()}] = ParseAlternatives(line.at("plays"));
      return;
    }
    const auto cell = line.at("cell").get<std::string>();
    oracle_[{truth, cell, line.at("motion_set").get<std::string>()}] = ParsePlays(line.at("plays"));
  } catch (const ordered_json::exception& error) {
    throw base::ConfigError(fmt::format("{}: {}", where, error.what()));
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format("{}: {}", where, error.what()));
  }
}

}  // namespace hires::lab
