#include "nodes/sim_worker/sim_robot_params.h"

#include <ros/package.h>

#include <limits>

#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"
#include "sim_robot/scenario.h"

namespace hires_ros {
namespace {

using hires::base::Between;
using hires::base::ParamReader;

/// Nothing uncertain means that the sensors tell the truth, too.
void DropNoiseIfCertain(SimRobotParams* params) {
  if (params->setup.uncertainty == "none" && params->setup.uncertainty_over.empty())
    hires::sim_robot::DropNoise(&params->sensors);
}

/// @param path  of the file that the truths lie beside.
hires::sim_robot::Truth TruthOf(const std::string& name, const std::string& path) {
  return hires::sim_robot::FindTruth(name, hires::imagination::ResolvePath("truths", path));
}

void OverridePrivate(const std::string& path, SimRobotParams* params) {
  hires::imagination::OverridePaths(PrivateText("world"), PrivateText("robot"),
                                    PrivateText("objects"), PrivateText("uncertainty"),
                                    &params->setup);
  const auto override_text = [](const char* key, std::string* target) {
    const auto given = PrivateText(key);
    if (given && !given->empty()) *target = *given;
  };
  override_text("scenario", &params->scenario);
  override_text("area", &params->area);
  const std::string truth = PrivateText("truth").value_or("");
  if (!truth.empty()) params->truth = TruthOf(truth, path);
  params->truth = hires::sim_robot::WithSensing(params->truth, PrivateText("sensing").value_or(""));
  int seed = static_cast<int>(params->seed);
  Override("seed", PrivateInt("seed"), Between(0, std::numeric_limits<int>::max()), &seed);
  params->seed = static_cast<std::uint64_t>(seed);
  Override("pace", PrivateNumber("pace"), Between(0.0, 1000.0), &params->pace);
  params->lockstep = PrivateBool("lockstep").value_or(params->lockstep);
  params->hold = PrivateBool("hold").value_or(params->hold);
  params->tells_place = PrivateBool("tells_place").value_or(params->tells_place);
  params->sensors.cameras.temperatures = hires::sim_robot::TemperaturesOf(params->scenario);
}

}  // namespace

SimRobotParams ReadSimRobotParams(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  SimRobotParams params;
  params.setup = hires::imagination::ReadSetupConfig(
      hires::imagination::ResolvePath(in.GetString("scene"), path));
  params.scenario = hires::imagination::ResolvePath(in.GetString("scenario"), path);
  params.area = in.GetString("area");
  params.truth = TruthOf(in.GetString("truth"), path);
  params.seed =
      static_cast<std::uint64_t>(in.Get("seed", Between(0, std::numeric_limits<int>::max())));
  params.pace = in.Get("pace", Between(0.0, 1000.0));
  params.lockstep = in.GetBool("lockstep");
  params.hold = in.GetBool("hold");
  params.tells_place = in.GetBool("tells_place");
  params.sensors = hires::sim_robot::ReadSimSensorParams(in);
  in.RejectUnknownKeys();
  DropNoiseIfCertain(&params);
  return params;
}

SimRobotParams LoadSimRobotParams() {
  RejectUnknownPrivate({"role", "config", "world", "robot", "objects", "uncertainty", "truth",
                        "sensing", "scenario", "area", "seed", "pace", "lockstep", "hold",
                        "tells_place", "names"});
  const std::string path =
      PrivateText("config").value_or(ros::package::getPath("hires") + "/config/sim_robot.yaml");
  SimRobotParams params = ReadSimRobotParams(path);
  params.names = LoadRobotNames();
  OverridePrivate(path, &params);
  if (!params.tells_place) {
    params.truth = hires::sim_robot::WithoutPlace(params.truth, params.setup.self_localisation);
  }
  DropNoiseIfCertain(&params);
  return params;
}

}  // namespace hires_ros
