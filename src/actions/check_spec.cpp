#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "hires/actions/action_spec.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::actions {
namespace {

[[noreturn]] void Refuse(const ActionSpec& spec, const std::string& why) {
  throw base::ConfigError(fmt::format("description of action '{}': {}", spec.name, why));
}

bool IsName(const std::string& text) {
  const auto fits = [](unsigned char letter) {
    return std::islower(letter) || std::isdigit(letter) || letter == '_';
  };
  return !text.empty() && std::islower(static_cast<unsigned char>(text.front())) &&
         std::all_of(text.begin(), text.end(), fits);
}

const Parameter* FindParameter(const ActionSpec& spec, const std::string& name) {
  for (const Parameter& parameter : spec.parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

bool HasKind(const ActionSpec& spec, ParameterKind kind) {
  return std::any_of(spec.parameters.begin(), spec.parameters.end(),
                     [&](const Parameter& parameter) { return parameter.kind == kind; });
}

void CheckNames(const ActionSpec& spec) {
  constexpr char kWanted[] = "wanted lower-case letters, digits and '_', a letter first";
  if (!IsName(spec.name)) Refuse(spec, fmt::format("its name is '{}', {}", spec.name, kWanted));
  for (const Parameter& parameter : spec.parameters) {
    if (!IsName(parameter.name)) {
      Refuse(spec, fmt::format("a parameter is called '{}', {}", parameter.name, kWanted));
    }
    if (FindParameter(spec, parameter.name) != &parameter) {
      Refuse(spec,
             fmt::format("two parameters are called '{}', wanted different names", parameter.name));
    }
  }
}

/// That `name` is a parameter of a kind.
void RequireParameter(const ActionSpec& spec, const char* what, const std::string& name,
                      ParameterKind kind) {
  const Parameter* parameter = FindParameter(spec, name);
  if (parameter != nullptr && parameter->kind == kind) return;
  Refuse(spec, fmt::format("{} is '{}', wanted a parameter of the kind '{}'", what, name,
                           ToString(kind)));
}

void CheckGroup(const ActionSpec& spec, const std::string& group) {
  if (!group.empty() && group.front() == '?') {
    RequireParameter(spec, "a group", group.substr(1), ParameterKind::kArm);
  } else if (!IsName(group)) {
    Refuse(spec, fmt::format("a group is '{}', wanted base, torso, head, an arm by its instance, "
                             "or '?' and a parameter that names one",
                             group));
  }
  if (group != kBaseGroup && spec.detail == Detail::kBase) {
    Refuse(spec, fmt::format("it needs '{}', which does not move at the level of detail of the "
                             "base; wanted that of the upper body",
                             group));
  }
}

void CheckGroups(const ActionSpec& spec) {
  if (spec.groups.empty()) {
    Refuse(spec, "it needs no group of joints, wanted at least one: base, torso, head, an arm");
  }
  for (const std::string& group : spec.groups) CheckGroup(spec, group);
}

void CheckDriving(const ActionSpec& spec) {
  if (spec.driving == Driving::kNone) return;
  if (spec.groups.count(kBaseGroup) == 0) {
    Refuse(spec, "it drives, but its groups lack 'base'; add the group, or set driving to kNone");
  }
  if (spec.driving == Driving::kRoundObstacles && !HasKind(spec, ParameterKind::kArea)) {
    Refuse(spec, "it drives round obstacles, but has no parameter of the kind 'area' to drive to");
  }
}

void CheckPurpose(const ActionSpec& spec) {
  const PurposeSpec& purpose = spec.purpose;
  if (purpose.purpose == Purpose::kNone) return;
  RequireParameter(spec, "the object of its purpose", purpose.object, ParameterKind::kObject);
  RequireParameter(spec, "the arm of its purpose", purpose.arm, ParameterKind::kArm);
  if (purpose.purpose == Purpose::kPutOnArea) {
    RequireParameter(spec, "the area of its purpose", purpose.area, ParameterKind::kArea);
  }
}

void CheckEffects(const ActionSpec& spec) {
  for (const base::Atom& effect : spec.effects) {
    if (effect.predicate.empty()) Refuse(spec, "an effect has no predicate");
    for (const std::string& argument : effect.arguments) {
      const bool is_variable = !argument.empty() && argument.front() == '?';
      if (is_variable && FindParameter(spec, argument.substr(1)) == nullptr) {
        Refuse(spec,
               fmt::format("effect {}: '{}' is no parameter", base::ToString(effect), argument));
      }
    }
  }
}

void CheckFailures(const ActionSpec& spec) {
  for (const base::FailureCode code : spec.failures) {
    if (code == base::FailureCode::kNone ||
        !base::FailureCodeOf(static_cast<std::uint16_t>(code))) {
      Refuse(spec, fmt::format("failure {} is no code of base::FailureCode",
                               static_cast<unsigned>(code)));
    }
  }
}

}  // namespace

void CheckSpec(const ActionSpec& spec) {
  CheckNames(spec);
  CheckGroups(spec);
  CheckDriving(spec);
  CheckPurpose(spec);
  CheckEffects(spec);
  CheckFailures(spec);
}

}  // namespace hires::actions
