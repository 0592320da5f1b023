#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/loading.h"
#include "hires/knowledge/store.h"

namespace hires::cli {

/// A value as people type it; see ParsePropertyFilter.
knowledge::Filler ParseFiller(const std::string& text);

/// For people: tables with a line below.
std::string LoadText(const knowledge::LoadSummary& summary);
std::string FluentsText(const std::vector<knowledge::Fluent>& fluents);
std::string EpisodesText(const std::vector<knowledge::Episode>& episodes);
std::string StatisticsText(const knowledge::Store::Statistics& statistics, const std::string& path);

/// For machines. Bounds that are infinite are null.
nlohmann::ordered_json ToJson(const knowledge::LoadSummary& summary);
nlohmann::ordered_json ToJson(const std::vector<knowledge::Fluent>& fluents);
nlohmann::ordered_json ToJson(const std::vector<knowledge::Episode>& episodes);
nlohmann::ordered_json ToJson(const knowledge::Store::Statistics& statistics,
                              const std::string& path);

}  // namespace hires::cli
