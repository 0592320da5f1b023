#include "nodes/base_guard/base_guard_params.h"

#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"

namespace hires_ros {
namespace {

std::string ConfigOr(const std::string& standard) {
  const std::string given = PrivateText("config").value_or("");
  return given.empty() ? ros::package::getPath("hires") + standard : given;
}

bool ReadNavigation(const hires::control::RobotNames& names) {
  const std::string navigation =
      PrivateWord("navigation", hires::base::OneOf({"own", "move_base"})).value_or("own");
  if (navigation == "move_base" && names.move_base.action.empty()) {
    throw hires::base::ConfigError(
        "~navigation is 'move_base', but the file of names has no move_base/action; name it there "
        "or take navigation own");
  }
  return navigation == "move_base";
}

}  // namespace

BaseGuardNodeParams LoadBaseGuardParams() {
  RejectUnknownPrivate({"config", "names", "navigation", "journal", "diagnostic_period"});
  BaseGuardNodeParams params;
  params.guard = hires::navigation::ReadBaseGuardParams(ConfigOr("/config/base_guard.yaml"));
  params.names = LoadRobotNames();
  params.guard.needs_motors_state = !params.names.motors_halted.empty();
  params.guard.needs_localisation = !params.names.localisation.empty();
  params.guard.needs_scan = !params.names.base_scan.empty();
  params.uses_move_base = ReadNavigation(params.names);
  params.journal = PrivateText("journal").value_or("");
  return params;
}

}  // namespace hires_ros
