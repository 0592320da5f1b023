#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/evaluation/decision.h"

namespace hires::evaluation {
namespace {

using nlohmann::ordered_json;

/// A play in one short line: journals hold a hundred of them per task.
ordered_json PlayToJson(const TruthPlay& play) {
  std::vector<std::string> failures;
  for (const base::FailureCode code : play.failures) failures.push_back(base::ToString(code));
  return {play.duration, base::Join(failures, " "), play.virtual_seconds, play.wall_seconds};
}

TruthPlay ParsePlay(const ordered_json& json) {
  TruthPlay play;
  play.duration = json.at(0).get<double>();
  for (const std::string& word : base::Split(json.at(1).get<std::string>(), ' ')) {
    if (word.empty()) continue;
    const auto code = base::ParseFailureCode(word);
    if (!code) throw base::ConfigError("no failure code: '" + word + "'");
    play.failures.push_back(*code);
  }
  play.virtual_seconds = json.at(2).get<double>();
  play.wall_seconds = json.at(3).get<double>();
  return play;
}

ordered_json TaskToJson(const DecisionTask& task) {
  return {{"number", task.number},
          {"load", task.load},
          {"from", task.from},
          {"to", task.to},
          {"torso", task.torso},
          {"deadline", task.deadline ? ordered_json(*task.deadline) : ordered_json()},
          {"price_factor", task.price_factor},
          {"truth_seed", task.truth_seed},
          {"imagination_seed", task.imagination_seed},
          {"oracle_seed", task.oracle_seed}};
}

DecisionTask ParseTask(const ordered_json& json) {
  DecisionTask task;
  task.number = json.at("number").get<int>();
  task.load = json.at("load").get<std::string>();
  task.from = json.at("from").get<std::string>();
  task.to = json.at("to").get<std::string>();
  task.torso = json.at("torso").get<std::string>();
  if (!json.at("deadline").is_null()) task.deadline = json.at("deadline").get<double>();
  task.price_factor = json.at("price_factor").get<double>();
  task.truth_seed = json.at("truth_seed").get<std::uint64_t>();
  task.imagination_seed = json.at("imagination_seed").get<std::uint64_t>();
  task.oracle_seed = json.at("oracle_seed").get<std::uint64_t>();
  return task;
}

ordered_json DriveToJson(const ImaginedDrive& drive) {
  return {{"rollouts", drive.num_rollouts},
          {"success", drive.num_success},
          {"lower", drive.lower},
          {"upper", drive.upper},
          {"cost", drive.cost},
          {"durations", drive.durations}};
}

ImaginedDrive ParseDrive(const ordered_json& json) {
  ImaginedDrive drive;
  drive.num_rollouts = json.at("rollouts").get<int>();
  drive.num_success = json.at("success").get<int>();
  drive.lower = json.at("lower").get<double>();
  drive.upper = json.at("upper").get<double>();
  drive.cost = json.at("cost").get<double>();
  drive.durations = json.at("durations").get<std::vector<double>>();
  return drive;
}

ordered_json DecidedToJson(const Decided& decided) {
  return {{"motion_sets", decided.motion_sets},
          {"simulated_seconds", decided.simulated_seconds},
          {"wall_seconds", decided.wall_seconds}};
}

Decided ParseDecided(const ordered_json& json) {
  Decided decided;
  decided.motion_sets = json.at("motion_sets").get<std::vector<std::string>>();
  if (decided.motion_sets.size() != PriceScales().size()) {
    throw base::ConfigError("there is not one choice for each scale of prices");
  }
  decided.simulated_seconds = json.at("simulated_seconds").get<double>();
  decided.wall_seconds = json.at("wall_seconds").get<double>();
  return decided;
}

template <typename Map, typename ToJsonOf>
ordered_json MapToJson(const Map& map, const ToJsonOf& to_json) {
  ordered_json json = ordered_json::object();
  for (const auto& [key, value] : map) json[key] = to_json(value);
  return json;
}

template <typename Map, typename ParseOf>
void ParseMap(const ordered_json& json, const ParseOf& parse, Map* map) {
  for (const auto& [key, value] : json.items()) (*map)[key] = parse(value);
}

ordered_json PlaysToJson(const std::vector<TruthPlay>& plays) {
  ordered_json json = ordered_json::array();
  for (const TruthPlay& play : plays) json.push_back(PlayToJson(play));
  return json;
}

std::vector<TruthPlay> ParsePlays(const ordered_json& json) {
  std::vector<TruthPlay> plays;
  for (const ordered_json& play : json) plays.push_back(ParsePlay(play));
  return plays;
}

}  // namespace

ordered_json ToJson(const DecisionRecord& record) {
  return {{"task", TaskToJson(record.task)},
          {"plays", MapToJson(record.plays, PlayToJson)},
          {"imagined", MapToJson(record.imagined, DriveToJson)},
          {"decided", MapToJson(record.decided, DecidedToJson)},
          {"oracle", MapToJson(record.oracle, PlaysToJson)}};
}

DecisionRecord ParseDecisionRecord(const ordered_json& json, const std::string& where) {
  DecisionRecord record;
  try {
    record.task = ParseTask(json.at("task"));
    ParseMap(json.at("plays"), ParsePlay, &record.plays);
    ParseMap(json.at("imagined"), ParseDrive, &record.imagined);
    ParseMap(json.at("decided"), ParseDecided, &record.decided);
    ParseMap(json.at("oracle"), ParsePlays, &record.oracle);
    for (const std::string& set : DecisionAlternatives()) record.plays.at(set);
  } catch (const ordered_json::exception& error) {
    throw base::ConfigError(fmt::format("{}: {}", where, error.what()));
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format("{}: {}", where, error.what()));
  } catch (const std::out_of_range&) {
    throw base::ConfigError(fmt::format("{}: field 'plays' lacks a motion set", where));
  }
  return record;
}

}  // namespace hires::evaluation
