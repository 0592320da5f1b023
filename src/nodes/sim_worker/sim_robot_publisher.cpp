#include "nodes/sim_worker/sim_robot_publisher.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <hires/Detections.h>
#include <nav_msgs/OccupancyGrid.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include "hires/perception/detector.h"
#include "hires/robot/posture.h"
#include "hires/ros/imagination/truth_messages.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/perception/detection_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/pose_messages.h"
#include "hires/ros/world/world_messages.h"
#include "hires/skills/manipulation_context.h"
#include "hires/world/occupancy_grid.h"
#include "nodes/sim_worker/sensor_messages.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose3;

constexpr double kLaserHeight = 0.303;   // [m] of a PR2's base laser: the map's slice
constexpr double kMapResolution = 0.05;  // [m]
constexpr double kScanTime = 0.05;       // [s] 20 Hz
// Messages for one who is late: a minute of what comes at 100 Hz, which at ten times the pace is
// six seconds in which a busy computer may keep a node from listening.
constexpr std::uint32_t kQueue = 6000;
constexpr int kShownIndex = 0;  // of the markers; workers count from 1

}  // namespace

SimRobotPublisher::SimRobotPublisher(const SimRobotParams& params,
                                     const hires::imagination::ImaginationSetup& setup,
                                     const hires::sim_robot::SimRobotWorld& world,
                                     ros::NodeHandle* nh)
    : params_(params),
      scene_(setup.scene),
      sensors_(hires::sim_robot::SensorsOf(params.truth, params.sensors), params.seed,
               world.scene()),
      cameras_(params.names.sensors, scene_->robot, &sensors_.cameras(), nh),
      lasers_(params.names, scene_->robot, params.tells_place, &sensors_.lasers(), nh),
      motion_(params.names, scene_->robot, params.tells_place, nh),
      clock_(nh->advertise<rosgraph_msgs::Clock>("/clock", kQueue)),
      joints_(nh->advertise<sensor_msgs::JointState>(params.names.joint_states, kQueue)),
      scan_(nh->advertise<sensor_msgs::LaserScan>(params.names.base_scan, 10)),
      map_(nh->advertise<nav_msgs::OccupancyGrid>(params.names.map, 1, true)),
      world_markers_(nh->advertise<visualization_msgs::MarkerArray>(kWorldMarkers, 1, true)),
      markers_(nh->advertise<visualization_msgs::MarkerArray>("robot_markers", 10)),
      true_world_(nh->advertise<hires::WorldState>("ground_truth/world_state", 100)),
      true_robot_(nh->advertise<hires::RobotState>("ground_truth/robot_state", 100)),
      truth_(nh->advertise<hires::GroundTruth>("ground_truth/summary", 10, true)),
      tf_(nh->advertise<tf2_msgs::TFMessage>(kTransforms, kQueue)),
      trace_(kShownIndex, setup.standing) {
  if (params.tells_place)
    amcl_ = nh->advertise<geometry_msgs::PoseWithCovarianceStamped>(params.names.localisation, 10);
  if (sensors_.sees_pictures()) {
    recogniser_ = nh->subscribe<hires::Detections>(
        kDetections, 1,
        boost::function<void(const hires::Detections&)>(
            [this](const hires::Detections&) { ++num_recognised_; }));
  } else {
    detections_ = nh->advertise<hires::Detections>(kDetections, kQueue);
  }
  world_markers_.publish(WorldMarkers(scene_->world));
  PublishMap();
}

ros::Time SimRobotPublisher::StampOf(const hires::sim_robot::SimRobotWorld& world) {
  ros::Time stamp;
  stamp.fromNSec(1000000000ULL + 1000000ULL * static_cast<std::uint64_t>(world.milliseconds()));
  return stamp;
}

void SimRobotPublisher::PublishClock(const hires::sim_robot::SimRobotWorld& world) {
  rosgraph_msgs::Clock clock;
  clock.clock = StampOf(world);
  clock_.publish(clock);
}

void SimRobotPublisher::PublishFast(const hires::sim_robot::SimRobotWorld& world,
                                    const hires::sim_robot::SensorReadings& readings) {
  const ros::Time stamp = StampOf(world);
  joints_.publish(ToMsg(readings.joints, stamp));
  motion_.Publish(readings, stamp);
  PublishClock(world);
}

std::vector<std::string> SimRobotPublisher::PublishTick(
    const hires::sim_robot::SimRobotWorld& world, const hires::sim_robot::SensorReadings& readings,
    const hires::simulation::TruthRecord& truth) {
  const ros::Time stamp = StampOf(world);
  std::vector<std::string> sensors{kTransforms, params_.names.joint_states, params_.names.odometry};
  PublishTransforms(world, readings, stamp);
  if (params_.tells_place) PublishLocalisation(readings, stamp);
  motion_.TellStart(world, stamp);
  if (sensors_.has_laser()) {
    PublishScan(world, readings, stamp);
    sensors.push_back(params_.names.base_scan);
  }
  if (PublishLookOf(world, readings, stamp)) sensors.push_back(kDetections);
  cameras_.PublishHeatIfDue(world, stamp);
  for (const std::string& topic : lasers_.PublishTick(world, stamp)) sensors.push_back(topic);
  PublishTruth(world, truth, stamp);
  return sensors;
}

void SimRobotPublisher::PublishLook(const hires::sim_robot::SimRobotWorld& world,
                                    const hires::sim_robot::SensorReadings& readings) {
  lasers_.PublishLook(world, readings, StampOf(world));
}

void SimRobotPublisher::PublishTransforms(const hires::sim_robot::SimRobotWorld& world,
                                          const hires::sim_robot::SensorReadings& readings,
                                          const ros::Time& stamp) {
  const hires::robot::Robot& robot = scene_->robot;
  tf2_msgs::TFMessage correction, links;
  if (params_.tells_place) {
    correction.transforms.push_back(MakeTransform(params_.names.map_frame,
                                                  params_.names.odometry_frame,
                                                  hires::geometry::Lift(readings.X_MO), stamp));
    tf_.publish(correction);
    links.transforms.push_back(MakeTransform(params_.names.odometry_frame, robot.profile.base_link,
                                             hires::geometry::Lift(readings.odometry.X_OB), stamp));
  }
  hires::robot::JointPositions joints = readings.joints.positions;
  lasers_.AddTilt(world, &joints);
  const auto X_RL = hires::robot::ForwardKinematics(robot.model, PostureOf(robot, joints));
  for (std::size_t i = 0; i < robot.model.links.size(); ++i) {
    const auto& joint = robot.model.links[i].joint;
    if (!joint || robot.model.links[i].name == robot.profile.base_link) continue;
    links.transforms.push_back(MakeTransform(robot.model.links[joint->parent].name,
                                             robot.model.links[i].name,
                                             X_RL[joint->parent].Inverse() * X_RL[i], stamp));
  }
  tf_.publish(links);
}

void SimRobotPublisher::PublishLocalisation(const hires::sim_robot::SensorReadings& readings,
                                            const ros::Time& stamp) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = params_.names.map_frame;
  amcl_.publish(ToMsg(UncertainPose{readings.X_MB, readings.covariance}, header));
}

void SimRobotPublisher::PublishScan(const hires::sim_robot::SimRobotWorld& world,
                                    const hires::sim_robot::SensorReadings& readings,
                                    const ros::Time& stamp) {
  const std::vector<double> ranges = sensors_.Scan(world, readings);
  const hires::simulation::LaserParams& laser = sensors_.laser();
  sensor_msgs::LaserScan scan = ToMsg(laser, ranges, kScanTime);
  scan.header.stamp = stamp;
  scan.header.frame_id = laser.link;
  scan_.publish(scan);
}

/// @return whether somebody is going to tell of what is seen now.
bool SimRobotPublisher::PublishLookOf(const hires::sim_robot::SimRobotWorld& world,
                                      const hires::sim_robot::SensorReadings& readings,
                                      const ros::Time& stamp) {
  if (sensors_.sees_pictures()) {
    if (!sensors_.BeginLook(world, readings)) return false;
    return cameras_.PublishDepth(world, stamp) && recogniser_.getNumPublishers() > 0;
  }
  cameras_.PublishDepthIfDue(world, stamp);
  const auto seen = sensors_.Look(world, readings);
  if (!seen) return false;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = scene_->robot.profile.upper_body->camera_link;
  detections_.publish(ToMsg(seen, header));
  return true;
}

void SimRobotPublisher::PublishTruth(const hires::sim_robot::SimRobotWorld& world,
                                     const hires::simulation::TruthRecord& truth,
                                     const ros::Time& stamp) {
  hires::WorldState state = ToMsg(world.simulator().GetWorldState());
  state.header.stamp = stamp;
  state.header.frame_id = params_.names.map_frame;
  true_world_.publish(state);
  hires::RobotState robot = ToMsg(world.simulator().GetRobotState());
  robot.joints.header.stamp = stamp;
  true_robot_.publish(robot);
  hires::GroundTruth summary;
  summary.header.stamp = stamp;
  summary.header.frame_id = params_.names.map_frame;
  for (const auto& [name, fate] : truth.objects()) summary.objects.push_back(ToMsg(name, fate));
  summary.falls = static_cast<std::uint32_t>(truth.falls());
  summary.robot_collided = !truth.contact().empty();
  summary.contact = truth.contact();
  summary.distance = truth.distance();
  truth_.publish(summary);
  trace_.Add(world.simulator());
  if (markers_.getNumSubscribers() > 0) markers_.publish(trace_.Draw(world.simulator()));
}

void SimRobotPublisher::PublishMap() {
  const auto grid =
      hires::world::SliceWorld(scene_->world, kLaserHeight, kLaserHeight, kMapResolution);
  nav_msgs::OccupancyGrid map;
  map.header.frame_id = params_.names.map_frame;
  map.info.resolution = static_cast<float>(grid.resolution);
  map.info.width = static_cast<std::uint32_t>(grid.width);
  map.info.height = static_cast<std::uint32_t>(grid.height);
  map.info.origin.position.x = grid.origin.x();
  map.info.origin.position.y = grid.origin.y();
  map.info.origin.orientation.w = 1.0;
  for (const hires::world::Cell cell : grid.cells) {
    map.data.push_back(cell == hires::world::Cell::kOccupied ? 100
                       : cell == hires::world::Cell::kFree   ? 0
                                                             : -1);
  }
  map_.publish(map);
}

}  // namespace hires_ros
