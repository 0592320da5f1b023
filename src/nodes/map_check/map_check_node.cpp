#include "nodes/map_check/map_check_node.h"

#include <fmt/format.h>
#include <ros/callback_queue.h>
#include <ros/package.h>

#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"
#include "hires/ros/world/map_messages.h"
#include "hires/world/world.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;

constexpr double kPatience = 5.0;  // [s] for a latched map, before static_map is asked, and for the
                                   // transform of its frame
constexpr double kMostTilt = 1e-3;  // [rad] of a map's frame

}  // namespace

MapCheckParams LoadMapCheckParams() {
  RejectUnknownPrivate({"scene", "world", "robot", "names", "map_to_world"});
  auto setup = hires::imagination::ReadSetupConfig(
      PrivateText("scene").value_or(ros::package::getPath("hires") + "/config/scene.yaml"));
  hires::imagination::OverridePaths(PrivateText("world"), PrivateText("robot"), {}, {}, &setup);
  MapCheckParams params;
  params.world = setup.world;
  params.robot = setup.robot;
  params.names = LoadRobotNames();
  return params;
}

MapPlace PlaceOf(const std::string& frame, const hires::control::RobotNames& names,
                 const TransformBuffer& tree) {
  const std::string map = hires::sensing::BareFrame(frame);
  if (map == names.map_frame) return {names.map_to_world, ""};
  const std::string where = fmt::format("map: it is in frame '{}', wanted '{}' or a frame that tf ",
                                        map, names.map_frame);
  const auto newest = tree.NewestOf(names.map_frame, map);
  // Each link may be known, but not all of them at one time yet.
  const auto found =
      newest ? tree.Find(names.map_frame, map, *newest) : hires::sensing::FramePose{};
  if (!newest || !found.is_found()) {
    return {{},
            where + fmt::format("connects with it: {}; publish the transform between them, or say "
                                "in the names file (frames: map) what this robot calls its map",
                                tree.WhyNot(names.map_frame, map, newest.value_or(0.0)))};
  }
  const double tilt = hires::geometry::TiltOf(found.X_PC.rotation);
  if (!(tilt <= kMostTilt)) {
    return {{},
            where + fmt::format("has level in it: it is tilted by {:.3f} rad; correct the "
                                "transform",
                                tilt)};
  }
  const auto X_MF = hires::geometry::Flatten(found.X_PC);
  return {hires::geometry::MapToWorld{names.map_to_world.ToWorld(X_MF), names.map_to_world.scale},
          ""};
}

double LaserHeight(const std::string& robot_path) {
  const hires::robot::Robot robot = hires::robot::LoadAnyRobot(robot_path);
  const auto laser = robot.model.FindLink(robot.profile.laser_link);
  const auto base = robot.model.FindLink(robot.profile.base_link);
  if (robot.profile.laser_link.empty() || !laser || !base) {
    throw ConfigError(
        fmt::format("{}: the robot has no laser (laser_link), so its map cannot be "
                    "compared with the world; start with check_map:=false",
                    robot_path));
  }
  const auto X_RL = hires::robot::ForwardKinematics(robot.model, robot.profile.joints);
  return (X_RL[*base].Inverse() * X_RL[*laser]).translation.z();
}

MapCheckNode::MapCheckNode(const MapCheckParams& params, ros::NodeHandle* nh)
    : params_(params),
      slice_(hires::world::SliceWorld(hires::world::LoadWorld(params.world),
                                      LaserHeight(params.robot), LaserHeight(params.robot))),
      nh_(*nh),
      subscriber_(nh->subscribe(params.names.map, 1, &MapCheckNode::OnMap, this)),
      map_server_(nh->resolveName(params.names.static_map)),
      asks_(!params.names.static_map.empty()) {
  updater_.setHardwareID("map_check");
  updater_.add("map", this, &MapCheckNode::Diagnose);
}

std::string MapCheckNode::Run() {
  const ros::WallTime begin = ros::WallTime::now();
  while (ros::ok() && misfit_.empty()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    if (asks_ && !fit_ && (ros::WallTime::now() - begin).toSec() > kPatience) AskForMap();
    if (new_map_) Compare();
    updater_.update();
  }
  return misfit_;
}

/// Once; then until it came, or too much time went by without it.
void MapCheckNode::AskForMap() {
  if (!asked_) {
    asked_ = ros::WallTime::now();
    return map_server_.Ask();
  }
  const bool waits = map_server_.Waiting() > 0.0;  // before it is looked for: it may come now
  const std::optional<nav_msgs::OccupancyGrid> map = map_server_.Take();
  if (map) OnMap(*map);
  asks_ = !map && waits && (ros::WallTime::now() - *asked_).toSec() < kPatience;
  if (map || asks_) return;
  hires::base::Log(hires::base::LogLevel::kWarn,
                   fmt::format("nothing comes on {} and {} does not answer: start the robot's "
                               "map_server",
                               params_.names.map, params_.names.static_map));
}

void MapCheckNode::OnMap(const nav_msgs::OccupancyGrid& map) {
  new_map_ = map;
  came_ = ros::WallTime::now();
}

void MapCheckNode::ListenToTransforms() {
  for (const bool are_static : {false, true}) {
    transforms_.push_back(nh_.subscribe<tf2_msgs::TFMessage>(
        are_static ? kStaticTransforms : kTransforms, 100,
        boost::function<void(const tf2_msgs::TFMessage&)>(
            [this, are_static](const tf2_msgs::TFMessage& msg) { tree_.Take(msg, are_static); })));
  }
}

/// As soon as it is known where the map's frame lies.
void MapCheckNode::Compare() {
  const MapPlace place = PlaceOf(new_map_->header.frame_id, params_.names, tree_);
  if (!place.map_to_world) {
    if (transforms_.empty()) ListenToTransforms();
    if ((ros::WallTime::now() - came_).toSec() > kPatience) misfit_ = place.why_not;
    return;
  }
  const nav_msgs::OccupancyGrid map = *std::exchange(new_map_, std::nullopt);
  try {
    fit_ = hires::world::RequireMapFits(FromMsg(map), slice_, *place.map_to_world, params_.fit);
    hires::base::Log(hires::base::LogLevel::kInfo,
                     fmt::format("map=fits score={:.2f} explained={:.2f} found={:.2f}", fit_->score,
                                 fit_->explained, fit_->found));
  } catch (const ConfigError& error) {
    misfit_ = error.what();
  }
}

void MapCheckNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!misfit_.empty()) {
    status.summary(DiagnosticStatus::ERROR, misfit_);
  } else if (fit_) {
    status.summary(DiagnosticStatus::OK, "map and world agree");
    status.add("score", fit_->score);
    status.add("map's obstacles explained", fit_->explained);
    status.add("world's obstacles found", fit_->found);
  } else {
    status.summary(DiagnosticStatus::WARN, "waits for " + params_.names.map);
  }
}

}  // namespace hires_ros
