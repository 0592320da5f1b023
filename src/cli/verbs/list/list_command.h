#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/list_rows.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// What was typed behind `hires list`.
struct ListOptions {
  std::string what, scene, world, map, robot, objects, uncertainty, domain, json;
  std::vector<std::string> action_libraries, areas;
  CLI::App* verb{nullptr};
};

/// The tasks of a planning domain; none where a program does not plan.
using TaskLister = std::function<ListRows(const std::string& domain)>;

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddListVerb(CLI::App* app, bool with_tasks, ListOptions* options);

/// Prints names that other verbs take, from the files that these would read.
/// @return kExitRecommended.  @throws base::ConfigError for bad input.
int RunListVerb(const ListOptions& options, const std::string& package_folder,
                const TaskLister& tasks);

}  // namespace hires::cli
