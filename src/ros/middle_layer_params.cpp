#include "hires/ros/middle_layer_params.h"

#include <ros/package.h>

#include "hires/ros/private_params.h"

namespace hires_ros {
namespace {

using hires::base::Between;
using hires::base::ParamReader;

StopParams ReadStopping(ParamReader in) {
  StopParams params;
  params.linear_deceleration = in.Get("linear_deceleration", Between(0.05, 10.0));
  params.angular_deceleration = in.Get("angular_deceleration", Between(0.05, 20.0));
  params.still_speed = in.Get("still_speed", Between(0.0001, 1.0));
  params.patience = in.Get("patience", Between(0.1, 60.0));
  return params;
}

ScanParams ReadScan(ParamReader in) {
  ScanParams params;
  params.tolerance = in.Get("tolerance", Between(0.0, 1.0));
  params.range = in.Get("range", Between(0.1, 30.0));
  params.cell = in.Get("cell", Between(0.01, 0.5));
  return params;
}

}  // namespace

MiddleLayerParams ReadMiddleLayerParams(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  MiddleLayerParams params;
  params.setup = hires::imagination::ReadSetupConfig(
      hires::imagination::ResolvePath(in.GetString("scene"), path));
  params.runner.time_limit = in.Get("time_limit", Between(0.1, 3600.0));
  params.runner.stale_after = in.Get("stale_after", Between(0.05, 10.0));
  params.runner.stop = ReadStopping(in.Sub("stopping"));
  params.scan = ReadScan(in.Sub("scan"));
  params.start_patience = in.Get("start_patience", Between(0.0, 600.0));
  params.feedback_period = in.Get("feedback_period", Between(0.01, 60.0));
  params.lockstep = in.GetBool("lockstep");
  in.RejectUnknownKeys();
  return params;
}

MiddleLayerParams LoadMiddleLayerParams() {
  RejectUnknownPrivate({"config", "world", "robot", "objects", "lockstep"});
  MiddleLayerParams params = ReadMiddleLayerParams(
      PrivateText("config").value_or(ros::package::getPath("hires") + "/config/middle_layer.yaml"));
  hires::imagination::OverridePaths(PrivateText("world"), PrivateText("robot"),
                                    PrivateText("objects"), std::nullopt, &params.setup);
  params.lockstep = PrivateBool("lockstep").value_or(params.lockstep);
  return params;
}

}  // namespace hires_ros
