#include "nodes/world_tracker/world_tracker_params.h"

#include "hires/imagination/imagination_setup.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"

namespace hires_ros {

WorldTrackerParams ReadWorldTrackerParams(const std::string& path) {
  using hires::base::Between;
  hires::base::ParamReader in = hires::base::ParamReader::FromFile(path);
  WorldTrackerParams params;
  ReadTranslatorFiles(path, &in, &params.files);
  params.sensing = hires::imagination::ReadSetupConfig(params.files.scene).sensing;
  params.changes = hires::translation::ReadChangeParams(in.Sub("changes"));
  hires::translation::RefuseConcepts(in);
  params.sweep = hires::control::ReadSweepParams(in.Sub("sweep"));
  params.floor = hires::sensing::ReadFloorWatchParams(in.Sub("floor"));
  params.write_period = in.Get("write_period", Between(0.0, 10.0));
  params.lockstep = in.GetBool("lockstep");
  in.RejectUnknownKeys();
  return params;
}

WorldTrackerParams LoadWorldTrackerParams() {
  RejectUnknownPrivate({"config", "world", "robot", "objects", "sweep", "lockstep", "names",
                        "map_to_world", "action_libraries"});
  WorldTrackerParams params = ReadWorldTrackerParams(ConfigPath("world_tracker"));
  params.files.world = PrivateText("world").value_or("");
  params.files.robot = PrivateText("robot").value_or("");
  params.files.objects = PrivateText("objects").value_or("");
  params.files.names = LoadRobotNames();
  params.action_libraries = PrivateActionLibraries();
  params.sweep.enabled = PrivateBool("sweep").value_or(params.sweep.enabled);
  params.lockstep = PrivateBool("lockstep").value_or(params.lockstep);
  return params;
}

}  // namespace hires_ros
