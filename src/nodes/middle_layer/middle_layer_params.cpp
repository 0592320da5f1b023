#include "nodes/middle_layer/middle_layer_params.h"

#include <ros/package.h>

#include "hires/navigation/base_guard.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"

namespace hires_ros {
namespace {

using hires::base::Between;
using hires::base::ParamReader;

/// How loads bear braking stands in the guard's own file, so that both think the same.
GuardParams ReadGuard(ParamReader in, bool is_there, const std::string& path) {
  GuardParams params;
  params.is_there = is_there;
  params.request_period = in.Get("request_period", Between(0.01, 0.05));
  const std::string file = hires::imagination::ResolvePath(in.GetString("config"), path);
  if (params.is_there) params.braking = hires::navigation::ReadBaseGuardParams(file).braking;
  return params;
}

hires::control::OverrideParams ReadOverride(ParamReader in) {
  hires::control::OverrideParams params;
  params.after = in.Get("after", Between(0.1, 60.0));
  params.linear = in.Get("linear", Between(0.01, 2.0));
  params.angular = in.Get("angular", Between(0.01, 4.0));
  return params;
}

MiddleLayerParams Read(const std::string& path, std::optional<bool> is_guard_there,
                       std::optional<std::string> navigation_by) {
  ParamReader in = ParamReader::FromFile(path);
  MiddleLayerParams params;
  params.setup = hires::imagination::ReadSetupConfig(
      hires::imagination::ResolvePath(in.GetString("scene"), path));
  params.setup.has_base_guard = is_guard_there.value_or(params.setup.has_base_guard);
  params.runner.time_limit = in.Get("time_limit", Between(0.1, 3600.0));
  params.runner.stale_after = params.setup.sensing.robot_state.stale_after;
  params.runner.stop = hires::control::ReadStopParams(in.Sub("stopping"));
  params.scan = hires::sensing::ReadScanParams(in.Sub("scan"));
  params.guard = ReadGuard(in.Sub("guard"), params.setup.has_base_guard, path);
  params.override = ReadOverride(in.Sub("override"));
  params.navigation =
      hires::control::ReadNavigation(in.Sub("navigation"), std::move(navigation_by));
  params.start_patience = in.Get("start_patience", Between(0.0, 600.0));
  params.feedback_period = in.Get("feedback_period", Between(0.01, 60.0));
  params.lockstep = in.GetBool("lockstep");
  in.RejectUnknownKeys();
  return params;
}

}  // namespace

MiddleLayerParams ReadMiddleLayerParams(const std::string& path) {
  return Read(path, std::nullopt, std::nullopt);
}

MiddleLayerParams LoadMiddleLayerParams() {
  RejectUnknownPrivate({"config", "world", "robot", "objects", "lockstep", "names", "map_to_world",
                        "guard", "navigation", "dry_run", "action_libraries"});
  MiddleLayerParams params = Read(
      PrivateText("config").value_or(ros::package::getPath("hires") + "/config/middle_layer.yaml"),
      PrivateBool("guard"), PrivateWord("navigation", hires::base::OneOf({"own", "move_base"})));
  hires::imagination::OverridePaths(PrivateText("world"), PrivateText("robot"),
                                    PrivateText("objects"), std::nullopt, &params.setup);
  params.setup.action_libraries = PrivateActionLibraries();
  params.names = LoadRobotNames();
  hires::control::RequireMeansFor(params.navigation, params.names, params.guard.is_there);
  params.dry_run = PrivateBool("dry_run").value_or(params.dry_run);
  params.lockstep = PrivateBool("lockstep").value_or(params.lockstep);
  return params;
}

}  // namespace hires_ros
