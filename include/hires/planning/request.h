#pragma once

#include <set>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/planning/domain.h"

/// What others ask a planner for, in texts and atoms, as the problem that it solves.
namespace hires::planning {

/// Makes these the tasks of a problem, in place of those that it had, with its parameters and goal.
/// @param tasks  a task network as SHOP2 text: "serve_coffee_to_guest guest1".
/// @throws base::ConfigError for a text that is no task network, and tasks that the domain lacks.
void SetTasks(const std::string& tasks, const Domain& domain, Problem* problem);

/// @param field  stands for the atoms in messages: "state[3].arguments[0]: ...".
/// @throws base::ConfigError naming the atom that is not ground, or no atom.
void AppendFacts(const std::vector<base::Atom>& atoms, const std::string& field, Problem* problem);

/// Every symbol that facts and domain write.
std::set<std::string> SymbolsOf(const Domain& domain, const Problem& problem);

/// Symbols among the arguments of the tasks, each once, in the order of the text.
std::vector<std::string> ArgumentSymbols(const TaskNetwork& tasks);

}  // namespace hires::planning
