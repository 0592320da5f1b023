#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/src/decision/decision.h"

// Pieces of a series as JSON; see DecisionJournal.
namespace hires::lab {

nlohmann::ordered_json ToJson(const ImaginedTask& imagined);
nlohmann::ordered_json ToJson(const std::map<std::string, TruthPlay>& plays);
nlohmann::ordered_json ToJson(const std::vector<TruthPlay>& plays);

// They throw base::ConfigError or an exception of the JSON library, which say what is wrong.
ImaginedTask ParseImagined(const nlohmann::ordered_json& json);
std::map<std::string, TruthPlay> ParseAlternatives(const nlohmann::ordered_json& json);
std::vector<TruthPlay> ParsePlays(const nlohmann::ordered_json& json);

}  // namespace hires::lab
