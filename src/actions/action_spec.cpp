#include "hires/actions/action_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::actions {
namespace {

/// move_base_param: MoveBaseParam.
std::string Camel(const std::string& name) {
  std::string camel;
  bool is_first = true;
  for (const char letter : name) {
    if (letter == '_' || letter == '-') {
      is_first = true;
    } else {
      camel +=
          is_first ? static_cast<char>(std::toupper(static_cast<unsigned char>(letter))) : letter;
      is_first = false;
    }
  }
  return camel;
}

std::vector<std::string> NamesOf(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

/// Where a parameter stands; their number if there is none of that name.
std::size_t IndexOf(const ActionSpec& spec, const std::string& name) {
  return std::find_if(spec.parameters.begin(), spec.parameters.end(),
                      [&](const Parameter& parameter) { return parameter.name == name; }) -
         spec.parameters.begin();
}

std::string ArgumentAt(const base::ActionCall& call, std::size_t index) {
  return index < call.arguments.size() ? base::ToLower(call.arguments[index]) : "";
}

}  // namespace

const char* ToString(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kArea:
      return "area";
    case ParameterKind::kMotionSet:
      return "motion set";
    case ParameterKind::kTorsoPosture:
      return "torso posture";
    case ParameterKind::kArmPosture:
      return "arm posture";
    case ParameterKind::kArm:
      return "arm";
    case ParameterKind::kObject:
      return "object";
    case ParameterKind::kAreaOrObject:
      return "area or object";
    case ParameterKind::kSpot:
      return "spot";
    case ParameterKind::kBasePlace:
      return "base place";
  }
  return "";
}

std::string Canonical(const ActionSpec& spec) {
  std::string text = spec.name + '(';
  for (const Parameter& parameter : spec.parameters) {
    text += fmt::format("{}: {}, ", parameter.name, ToString(parameter.kind));
  }
  text += fmt::format(") detail {} groups ", static_cast<int>(spec.detail));
  for (const std::string& group : spec.groups) text += group + ' ';
  text += fmt::format("driving {} purpose {} '{}' '{}' '{}' effects ",
                      static_cast<int>(spec.driving), static_cast<int>(spec.purpose.purpose),
                      spec.purpose.object, spec.purpose.arm, spec.purpose.area);
  for (const base::Atom& effect : spec.effects) text += base::ToString(effect) + ' ';
  for (const base::FailureCode code : spec.failures) text += base::ToString(code) + ' ';
  return text + (spec.is_operator ? "operator" : "");
}

std::string Signature(const ActionSpec& spec) {
  return fmt::format("{}({})", spec.name, base::Join(NamesOf(spec.parameters), ", "));
}

void CheckArguments(const ActionSpec& spec, const base::ActionCall& call) {
  if (call.arguments.size() == spec.parameters.size()) return;
  throw base::ConfigError(
      fmt::format("has {} argument{}, wanted {} ({})", call.arguments.size(),
                  call.arguments.size() == 1 ? "" : "s", spec.parameters.size(),
                  spec.parameters.empty() ? "none" : base::Join(NamesOf(spec.parameters), ", ")));
}

std::set<std::string> GroupsOf(const ActionSpec& spec, const base::ActionCall& call) {
  std::set<std::string> groups;
  for (const std::string& group : spec.groups) {
    groups.insert(group.front() == '?' ? ArgumentOf(spec, call, group.substr(1)) : group);
  }
  return groups;
}

std::string ArgumentOf(const ActionSpec& spec, const base::ActionCall& call,
                       const std::string& parameter) {
  return ArgumentAt(call, IndexOf(spec, parameter));
}

std::optional<std::string> ArgumentOf(const ActionSpec& spec, const base::ActionCall& call,
                                      ParameterKind kind) {
  for (const Parameter& parameter : spec.parameters) {
    const std::size_t index = &parameter - spec.parameters.data();
    if (parameter.kind == kind && index < call.arguments.size()) return ArgumentAt(call, index);
  }
  return std::nullopt;
}

std::string ActivityConcept(const std::string& action_name) {
  return Camel(action_name) + "Activity";
}

std::string TaskConcept(const std::string& action_name) { return Camel(action_name) + "Task"; }

}  // namespace hires::actions
