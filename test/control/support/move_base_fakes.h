#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/control/move_base_keeper.h"

/// Local planners of move_base for tests without ROS.
namespace hires::control::test_support {

constexpr hires::robot::MotionSet kFast{0.55, 1.0, 2.5, 3.2};  // dissertation, Table 5.1
constexpr hires::robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};

constexpr char kPlanner[] = "/move_base_node/DWAPlannerROS";

inline RobotNames::MoveBase NamesOfDwa() {
  RobotNames::MoveBase names;
  names.action = "move_base";
  names.planner = kPlanner;
  names.parameters = {{"max_linear_velocity", {"max_vel_x"}},
                      {"max_translational_velocity", {"max_vel_trans", "max_trans_vel"}},
                      {"max_angular_velocity", {"max_vel_theta", "max_rot_vel"}},
                      {"max_linear_acceleration", {"acc_lim_x"}},
                      {"max_lateral_acceleration", {"acc_lim_y"}},
                      {"max_angular_acceleration", {"acc_lim_theta", "acc_lim_th"}}};
  return names;
}

/// As a PR2 is configured.
inline PlannerValues NoeticDwa() {
  return {{"max_vel_x", 0.55},     {"min_vel_x", 0.0},     {"max_vel_y", 0.1},
          {"max_vel_trans", 0.55}, {"min_vel_trans", 0.1}, {"max_vel_theta", 1.0},
          {"min_vel_theta", 0.3},  {"acc_lim_x", 2.5},     {"acc_lim_y", 2.5},
          {"acc_lim_theta", 3.2}};
}

inline PlannerValues OldDwa() {
  return {{"max_vel_x", 0.55},     {"min_vel_x", 0.0},     {"max_vel_y", 0.1},
          {"max_trans_vel", 0.55}, {"min_trans_vel", 0.1}, {"max_rot_vel", 1.0},
          {"min_rot_vel", 0.3},    {"acc_lim_x", 2.5},     {"acc_lim_y", 2.5},
          {"acc_lim_th", 3.2}};
}

/// A server that can misbehave as servers do.
struct FakePlanner {
  PlannerValues values = OldDwa();
  PlannerValues upper, lower;     // clamps
  std::set<std::string> ignored;  // does not take these
  bool is_missing{false};
  std::vector<PlannerValues> changes;  // that it was told, empty calls left out

  PlannerValues Call(const std::string& server, const PlannerValues& wanted) {
    if (is_missing || server != kPlanner) {
      throw hires::base::ConfigError("there is no service " + server + "/set_parameters");
    }
    if (!wanted.empty()) changes.push_back(wanted);
    for (const auto& [name, value] : wanted) Set(name, value);
    return values;
  }

  void Set(const std::string& name, double value) {
    if (values.count(name) == 0 || ignored.count(name) > 0) return;  // as generated servers do
    if (upper.count(name) > 0) value = std::min(value, upper.at(name));
    if (lower.count(name) > 0) value = std::max(value, lower.at(name));
    values[name] = value;
  }
};

inline Reconfigure By(std::shared_ptr<FakePlanner> planner) {
  return [planner = std::move(planner)](const std::string& server, const PlannerValues& changes) {
    return planner->Call(server, changes);
  };
}

}  // namespace hires::control::test_support
