#include "lab/src/decision/decision_record.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

using imagination::ImaginationOutcome;
using nlohmann::ordered_json;

/// A play in one short line: journals hold hundreds of them.
ordered_json PlayToJson(const TruthPlay& play) {
  std::vector<std::string> failures;
  for (const base::FailureCode code : play.failures) failures.push_back(base::ToString(code));
  return {play.duration, base::Join(failures, " "), play.virtual_seconds, play.wall_seconds,
          play.processor_seconds};
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
  play.processor_seconds = json.at(4).get<double>();
  return play;
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

ImaginationOutcome ParseOutcome(const std::string& word) {
  std::vector<std::string> words;
  for (const auto outcome : {ImaginationOutcome::kRanked, ImaginationOutcome::kClose,
                             ImaginationOutcome::kAllFailed, ImaginationOutcome::kUndecided,
                             ImaginationOutcome::kNoWorker, ImaginationOutcome::kNothingFinished}) {
    words.push_back(imagination::ToString(outcome));
    if (words.back() == word) return outcome;
  }
  throw base::ConfigError(base::UnknownName("outcome", word, words));
}

ordered_json DecidedToJson(const Decided& decided) {
  ordered_json advice = ordered_json::array();
  for (const Advice& one : decided.advice) {
    advice.push_back({{"outcome", imagination::ToString(one.outcome)}, {"first", one.first}});
  }
  return {{"advice", advice},
          {"simulated_seconds", decided.simulated_seconds},
          {"wall_seconds", decided.wall_seconds},
          {"processor_seconds", decided.processor_seconds}};
}

Decided ParseDecided(const ordered_json& json) {
  Decided decided;
  for (const ordered_json& one : json.at("advice")) {
    decided.advice.push_back(
        {ParseOutcome(one.at("outcome").get<std::string>()), one.at("first").get<std::string>()});
  }
  if (decided.advice.size() != PriceScales().size()) {
    throw base::ConfigError("there is not one answer for each scale of prices");
  }
  decided.simulated_seconds = json.at("simulated_seconds").get<double>();
  decided.wall_seconds = json.at("wall_seconds").get<double>();
  decided.processor_seconds = json.at("processor_seconds").get<double>();
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

template <typename Map>
void RequireMotionSets(const Map& map, const char* field) {
  for (const std::string& set : DecisionAlternatives()) {
    if (map.count(set) > 0) continue;
    throw base::ConfigError(fmt::format("field '{}' lacks motion set '{}'", field, set));
  }
}

}  // namespace

ordered_json ToJson(const ImaginedTask& imagined) {
  return {{"drives", MapToJson(imagined.drives, DriveToJson)},
          {"decided", MapToJson(imagined.decided, DecidedToJson)}};
}

ordered_json ToJson(const std::map<std::string, TruthPlay>& plays) {
  return MapToJson(plays, PlayToJson);
}

ordered_json ToJson(const std::vector<TruthPlay>& plays) {
  ordered_json json = ordered_json::array();
  for (const TruthPlay& play : plays) json.push_back(PlayToJson(play));
  return json;
}

ImaginedTask ParseImagined(const ordered_json& json) {
  ImaginedTask imagined;
  ParseMap(json.at("drives"), ParseDrive, &imagined.drives);
  ParseMap(json.at("decided"), ParseDecided, &imagined.decided);
  RequireMotionSets(imagined.drives, "drives");
  for (const char* arm : {kImaginationArm, kDissertationArm}) {
    if (imagined.decided.count(arm) > 0) continue;
    throw base::ConfigError(fmt::format("field 'decided' lacks arm '{}'", arm));
  }
  return imagined;
}

std::map<std::string, TruthPlay> ParseAlternatives(const ordered_json& json) {
  std::map<std::string, TruthPlay> plays;
  ParseMap(json, ParsePlay, &plays);
  RequireMotionSets(plays, "plays");
  return plays;
}

std::vector<TruthPlay> ParsePlays(const ordered_json& json) {
  std::vector<TruthPlay> plays;
  for (const ordered_json& play : json) plays.push_back(ParsePlay(play));
  if (plays.empty()) throw base::ConfigError("field 'plays' is empty");
  return plays;
}

}  // namespace hires::lab
