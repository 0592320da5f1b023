#include "execution/alternatives.h"

#include <algorithm>

#include "hires/base/text.h"

namespace hires::execution {
namespace {

std::string WithoutMarks(const std::string& name) {
  return name.substr(std::min(name.find_first_not_of('!'), name.size()));
}

}  // namespace

base::ActionTemplate TemplateOf(const planning::Datum& task) {
  base::ActionTemplate action;
  if (task.items.size() < 2) return action;
  action.name = WithoutMarks(ToString(task.items[1]));
  for (std::size_t i = 2; i < task.items.size(); ++i) {
    action.alternatives.emplace_back();
    if (!task.items[i].IsList()) {
      action.alternatives.back().push_back(ToString(task.items[i]));
      continue;
    }
    for (const planning::Datum& item : task.items[i].items) {
      action.alternatives.back().push_back(ToString(item));
    }
  }
  return action;
}

bool Fits(const base::ActionTemplate& action, const base::ActionCall& call) {
  if (action.name != call.name || action.alternatives.size() != call.arguments.size()) return false;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const auto& list = action.alternatives[i];
    if (std::find(list.begin(), list.end(), call.arguments[i]) == list.end()) return false;
  }
  return true;
}

bool IsSame(const base::ActionTemplate& a, const base::ActionTemplate& b) {
  return a.name == b.name && a.alternatives == b.alternatives;
}

base::ActionCall Lowered(const base::ActionCall& call) {
  base::ActionCall lowered{base::ToLower(WithoutMarks(call.name)), {}};
  for (const std::string& argument : call.arguments) {
    lowered.arguments.push_back(base::ToLower(argument));
  }
  return lowered;
}

std::set<std::string> LoweredSet(const std::vector<std::string>& names) {
  std::set<std::string> lowered;
  for (const std::string& name : names) lowered.insert(base::ToLower(name));
  return lowered;
}

}  // namespace hires::execution
