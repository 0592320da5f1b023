#include "robot/profile/motion_set_order.h"

#include <algorithm>
#include <tuple>

namespace hires::robot {

std::vector<std::string> MostCautiousFirst(const std::map<std::string, MotionSet>& sets) {
  const auto limits = [&](const std::string& name) {
    const MotionSet& set = sets.at(name);
    return std::make_tuple(set.max_linear_velocity, set.max_linear_acceleration,
                           set.max_angular_velocity, set.max_angular_acceleration, name);
  };
  std::vector<std::string> names;
  for (const auto& [name, set] : sets) names.push_back(name);
  std::sort(names.begin(), names.end(),
            [&](const auto& a, const auto& b) { return limits(a) < limits(b); });
  return names;
}

}  // namespace hires::robot
