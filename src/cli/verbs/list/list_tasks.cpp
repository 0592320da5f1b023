#include "cli/verbs/list/list_tasks.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "hires/base/text.h"
#include "hires/planning/planning_files.h"

namespace hires::cli {
namespace {

using nlohmann::ordered_json;

void NoteTasks(const planning::TaskNetwork& network, std::set<std::string>* names) {
  for (const planning::TaskItem& item : network.items) {
    if (item.network.empty()) names->insert(std::string(item.task.Head()));
    for (const planning::TaskNetwork& inner : item.network) NoteTasks(inner, names);
  }
}

std::string ArgumentsOf(const planning::Datum& head) {
  std::vector<std::string> arguments;
  for (std::size_t i = 1; i < head.items.size(); ++i) {
    arguments.push_back(planning::ToString(head.items[i]));
  }
  return base::Join(arguments, " ");
}

}  // namespace

ListRows TasksOf(const std::string& domain_file) {
  const planning::Domain domain = planning::LoadDomain(domain_file);
  std::map<std::string, std::set<std::string>> parents;
  for (const planning::Method& method : domain.methods) {
    std::set<std::string> parts;
    for (const planning::Branch& branch : method.branches) NoteTasks(branch.subtasks, &parts);
    const std::string name(method.head.Head());
    for (const std::string& part : parts) {
      if (part != name) parents[part].insert(name);
    }
  }
  ListRows rows;
  std::set<std::string> seen;
  for (const planning::Method& method : domain.methods) {
    const std::string name(method.head.Head());
    if (!seen.insert(name).second) continue;
    rows.push_back(
        {{"task", name}, {"arguments", ArgumentsOf(method.head)}, {"part of", parents[name]}});
  }
  std::stable_partition(rows.begin(), rows.end(),
                        [](const ordered_json& row) { return row["part of"].empty(); });
  return rows;
}

}  // namespace hires::cli
