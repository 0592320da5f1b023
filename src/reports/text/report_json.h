#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hires/base/failure.h"
#include "hires/imagination/report.h"

namespace hires::reports {

/// "ranked", "ranked_at_deadline" (cut short), "all_failed", "undecided", "no_worker",
/// "nothing_finished", "cancelled".
std::string OutcomeName(const imagination::Report& report);

/// The report for machines. Field order is fixed; equal reports give equal text but for
/// `wall_seconds` and `real_time_factor`.
nlohmann::ordered_json ToJson(const imagination::Report& report);
/// With `min_success`, what a recommendation had to reach; null where the rule asks for none.
nlohmann::ordered_json ToJson(const imagination::Report& report,
                              const imagination::Criteria& criteria);

/// {"failure": "no_path", "subjects": ["hand", "book1"], "detail": "..."}; null for no failure.
nlohmann::ordered_json ToJson(const base::Failure& failure);

/// How often each failure came: [{"failure": "area_occupied", "subjects": ["book1"],
/// "detail": "...", "count": 2}]; the detail is of the first of them.
nlohmann::ordered_json FailuresToJson(const std::map<base::Failure, int>& failures);

/// For those who work long before they write.
/// @throws base::ConfigError if the folder in which `path` lies does not exist.
void RequireFolderOf(const std::string& path);

/// Likewise, for those who write many files.
/// @param option  under which the folder was named: "--clouds".
/// @throws base::ConfigError if it does not exist, or is a file.
void RequireFolder(const std::string& option, const std::string& folder);

/// All or nothing: a file of that name is replaced only when the new one is whole.
/// @throws base::ConfigError if the file cannot be written.
void WriteJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace hires::reports
