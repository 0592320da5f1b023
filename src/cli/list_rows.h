#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace hires::cli {

/// One line: column -> value; all lines of a list have the same columns.
using ListRows = std::vector<nlohmann::ordered_json>;

/// A table on standard output.
/// @param what  is listed: "no WHAT" where there are no rows.
/// @param json  file that is written as well; "-": JSON on standard output instead of the table;
///              empty: none.
void PrintList(const std::string& what, const ListRows& rows, const std::string& json);

}  // namespace hires::cli
