#include "sim_robot/controller_changes.h"

#include <string>
#include <vector>

#include "hires/base/text.h"

namespace hires::sim_robot {
namespace {

using robot::BaseControllerParams;

constexpr char kAtTimeout[] = "at_timeout";

struct ControllerNumber {
  std::string key;
  double lower, upper;
  double BaseControllerParams::*slot;
};

/// Of a base on casters; others have none to change.
struct CasterNumber {
  std::string key;
  double lower, upper;
  double robot::CasterParams::*slot;
};

const std::vector<CasterNumber>& CasterNumbers() {
  static const std::vector<CasterNumber> numbers{
      {"wheel_effort", 0.01, 1e4, &robot::CasterParams::wheel_effort},
      {"wheel_damping", 0.0, 100.0, &robot::CasterParams::wheel_damping},
      {"steering_effort", 0.01, 1e4, &robot::CasterParams::steering_effort},
      {"grip", 0.01, 100.0, &robot::CasterParams::grip},
  };
  return numbers;
}

const std::vector<ControllerNumber>& ControllerNumbers() {
  static const std::vector<ControllerNumber> numbers{
      {"command_timeout", 0.001, 60.0, &BaseControllerParams::command_timeout},
      {"max_linear_jerk", 0.0, 1e6, &BaseControllerParams::max_linear_jerk},
      {"command_lag", 0.0, 10.0, &BaseControllerParams::command_lag},
      {"loop_frequency", 0.0, 1e4, &BaseControllerParams::loop_frequency},
      {"loop_damping", 0.0, 100.0, &BaseControllerParams::loop_damping},
      {"sway_compliance", 0.0, 0.1, &BaseControllerParams::sway_compliance},
      {"sway_frequency", 0.1, 200.0, &BaseControllerParams::sway_frequency},
      {"sway_damping", 0.0, 10.0, &BaseControllerParams::sway_damping},
  };
  return numbers;
}

base::Bound<double> BoundOf(const base::ParamReader& in, const std::string& key) {
  std::vector<std::string> names{kAtTimeout};
  for (const ControllerNumber& number : ControllerNumbers()) {
    if (number.key == key) return base::Between(number.lower, number.upper);
    names.push_back(number.key);
  }
  for (const CasterNumber& number : CasterNumbers()) {
    if (number.key == key) return base::Between(number.lower, number.upper);
    names.push_back(number.key);
  }
  in.Fail(key, base::UnknownName("number of a base controller", key, names));
}

}  // namespace

void ReadControllerChanges(base::ParamReader in, Truth* truth) {
  for (const std::string& key : in.Keys()) {
    base::ParamReader entry = in.Sub(key);
    entry.GetString("source");
    if (key == kAtTimeout) {
      truth->stops_at_timeout = entry.Get("value", base::OneOf({"ramp", "stop"})) == "stop";
      continue;
    }
    truth->controller[key] = entry.Get("value", BoundOf(in, key));
  }
}

void ChangeController(const Truth& truth, BaseControllerParams* params) {
  params->stops_at_timeout = truth.stops_at_timeout.value_or(params->stops_at_timeout);
  const auto change = [&truth](const auto& numbers, auto* changed) {
    for (const auto& number : numbers) {
      const auto found = truth.controller.find(number.key);
      if (found != truth.controller.end()) changed->*number.slot = found->second;
    }
  };
  change(ControllerNumbers(), params);
  if (params->casters) change(CasterNumbers(), &*params->casters);
}

}  // namespace hires::sim_robot
