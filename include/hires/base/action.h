#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hires::base {

/// A ground action, as the planner writes it: `move_base_param area1 slow`. Names and arguments
/// compare without regard to case, and a leading `!` (the planner's mark of a primitive) is no part
/// of the name.
struct ActionCall {
  std::string name;
  std::vector<std::string> arguments;

  bool operator==(const ActionCall& other) const;
};

/// A symbolic statement: `RobotAt(area1)`. Predicates and names compare without regard to case.
struct Atom {
  std::string predicate;
  std::vector<std::string> arguments;
};
std::string ToString(const Atom& atom);

/// An action with a list of alternatives for each argument.
struct ActionTemplate {
  std::string name;
  std::vector<std::vector<std::string>> alternatives;  ///< one list per argument, none empty
};

/// Lower-case, without `!`: names of actions that are the same are equal so.
std::string CanonicalName(const std::string& name);

/// Whether a call is one of a template's combinations.
bool IsAmong(const ActionCall& call, const ActionTemplate& action);

/// "move_base_param(area1, slow)", for people.
std::string ToString(const ActionCall& call);
/// "move_base_param(area1, slow|fast)"
std::string ToString(const ActionTemplate& action);

/// Every combination of the alternatives, the last argument varying fastest, names and arguments
/// lower-cased and without `!`, repeated alternatives of one argument once.
/// @throws ConfigError if a list is empty or there are more than `at_most` combinations.
std::vector<ActionCall> Combinations(const ActionTemplate& action, std::size_t at_most = 4096);

}  // namespace hires::base
