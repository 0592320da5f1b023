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

const ControllerNumber& ControllerNumberOf(const base::ParamReader& in, const std::string& key) {
  std::vector<std::string> names{kAtTimeout};
  for (const ControllerNumber& number : ControllerNumbers()) {
    if (number.key == key) return number;
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
    const ControllerNumber& number = ControllerNumberOf(in, key);
    truth->controller[key] = entry.Get("value", base::Between(number.lower, number.upper));
  }
}

void ChangeController(const Truth& truth, BaseControllerParams* params) {
  params->stops_at_timeout = truth.stops_at_timeout.value_or(params->stops_at_timeout);
  for (const ControllerNumber& number : ControllerNumbers()) {
    const auto found = truth.controller.find(number.key);
    if (found != truth.controller.end()) params->*number.slot = found->second;
  }
}

}  // namespace hires::sim_robot
