#include "cli/list_rows.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "reports/text/report_json.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using nlohmann::ordered_json;

std::string CellOf(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "";
  if (value.is_array()) return base::Join(value.get<std::vector<std::string>>(), ", ");
  return value.dump();
}

std::string TableOf(const ListRows& rows) {
  std::vector<std::vector<std::string>> table(1);
  for (const auto& [column, value] : rows.front().items()) table[0].push_back(column);
  for (const ordered_json& row : rows) {
    table.emplace_back();
    for (const auto& [column, value] : row.items()) table.back().push_back(CellOf(value));
  }
  return reports::FormatTable(table);
}

}  // namespace

void PrintList(const std::string& what, const ListRows& rows, const std::string& json) {
  if (json == "-") {
    std::cout << ordered_json(rows).dump(2) << '\n';
    return;
  }
  std::cout << (rows.empty() ? fmt::format("no {}\n", what) : TableOf(rows));
  if (!json.empty()) reports::WriteJson(ordered_json(rows), json);
}

}  // namespace hires::cli
