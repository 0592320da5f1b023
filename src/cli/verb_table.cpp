#include "cli/verb_table.h"

#include <CLI/CLI.hpp>

namespace hires::cli {

void VerbTable::AddForeign(const std::string& name, const std::string& help,
                           const std::function<int(const std::vector<std::string>&)>& run,
                           bool is_shown) {
  CLI::App* verb = app_->add_subcommand(name, help)->prefix_command();
  verb->set_help_flag();  // its own parser explains it
  if (!is_shown) verb->group("");
  verbs_.push_back({verb, [verb, run] { return run(verb->remaining()); }});
}

std::string CommandOf(const std::string& program, std::vector<std::string> arguments) {
  arguments.front() = program;
  return CommandText(arguments);
}

}  // namespace hires::cli
