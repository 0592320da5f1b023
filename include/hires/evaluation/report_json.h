#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "hires/imagination/report.h"

namespace hires::evaluation {

/// "ranked", "ranked_at_deadline" (cut short), "all_failed", "no_worker", "nothing_finished",
/// "cancelled".
std::string OutcomeName(const imagination::Report& report);

/// The report for machines. Field order is fixed; equal reports give equal text but for
/// `wall_seconds` and `real_time_factor`.
nlohmann::ordered_json ToJson(const imagination::Report& report);

/// For those who work long before they write.
/// @throws base::ConfigError if the folder in which `path` lies does not exist.
void RequireFolderOf(const std::string& path);

/// All or nothing: a file of that name is replaced only when the new one is whole.
/// @throws base::ConfigError if the file cannot be written.
void WriteJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace hires::evaluation
