#include "nodes/sim_worker/sim_robot_publisher.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <hires/Detections.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>

#include "hires/perception/detector.h"
#include "hires/robot/posture.h"
#include "hires/ros/conversions.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"
#include "hires/ros/topic_names.h"
#include "hires/simulation/scan_ghosts.h"
#include "hires/skills/manipulation_context.h"
#include "hires/world/occupancy_grid.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose3;

constexpr double kLaserHeight = 0.303;   // [m] of a PR2's base laser: the map's slice
constexpr double kMapResolution = 0.05;  // [m]
constexpr double kStillHead = 0.02;      // [rad/s]
constexpr double kScanTime = 0.05;       // [s] 20 Hz
constexpr int kShownIndex = 0;           // of the markers; workers count from 1
enum SensorStreams : std::uint64_t { kScanStream = 100, kDetectorStream };

}  // namespace

SimRobotPublisher::SimRobotPublisher(const SimRobotParams& params,
                                     const hires::imagination::ImaginationSetup& setup,
                                     ros::NodeHandle* nh)
    : params_(params),
      scene_(setup.scene),
      laser_(params.laser),
      scan_rng_(hires::base::Rng(params.seed).Fork(kScanStream)),
      detector_rng_(hires::base::Rng(params.seed).Fork(kDetectorStream)),
      clock_(nh->advertise<rosgraph_msgs::Clock>("/clock", 100)),
      odometry_(nh->advertise<nav_msgs::Odometry>(params.names.odometry, 100)),
      joints_(nh->advertise<sensor_msgs::JointState>(params.names.joint_states, 100)),
      amcl_(nh->advertise<geometry_msgs::PoseWithCovarianceStamped>(params.names.localisation, 10)),
      scan_(nh->advertise<sensor_msgs::LaserScan>(params.names.base_scan, 10)),
      detections_(nh->advertise<hires::Detections>(kDetections, 10)),
      map_(nh->advertise<nav_msgs::OccupancyGrid>(params.names.map, 1, true)),
      world_markers_(nh->advertise<visualization_msgs::MarkerArray>(kWorldMarkers, 1, true)),
      markers_(nh->advertise<visualization_msgs::MarkerArray>("robot_markers", 10)),
      true_world_(nh->advertise<hires::WorldState>("ground_truth/world_state", 100)),
      true_robot_(nh->advertise<hires::RobotState>("ground_truth/robot_state", 100)),
      truth_(nh->advertise<hires::GroundTruth>("ground_truth/summary", 10, true)),
      trace_(kShownIndex, setup.standing) {
  laser_.link = scene_->robot.profile.laser_link;
  world_markers_.publish(WorldMarkers(scene_->world));
  PublishMap();
}

ros::Time SimRobotPublisher::StampOf(const hires::evaluation::SimRobotWorld& world) {
  ros::Time stamp;
  stamp.fromNSec(1000000000ULL + 1000000ULL * static_cast<std::uint64_t>(world.milliseconds()));
  return stamp;
}

void SimRobotPublisher::PublishClock(const hires::evaluation::SimRobotWorld& world) {
  rosgraph_msgs::Clock clock;
  clock.clock = StampOf(world);
  clock_.publish(clock);
}

void SimRobotPublisher::PublishFast(const hires::evaluation::SimRobotWorld& world,
                                    const hires::evaluation::SensorReadings& readings) {
  const ros::Time stamp = StampOf(world);
  joints_.publish(ToMsg(readings.joints, stamp));
  nav_msgs::Odometry odometry;
  odometry.header.stamp = stamp;
  odometry.header.frame_id = params_.names.odometry_frame;
  odometry.child_frame_id = scene_->robot.profile.base_link;
  odometry.pose.pose = ToMsg(hires::geometry::Lift(readings.odometry.X_OB));
  odometry.twist.twist = ToMsg(readings.odometry.V_B);
  odometry_.publish(odometry);
  PublishClock(world);
}

std::vector<std::string> SimRobotPublisher::PublishTick(
    const hires::evaluation::SimRobotWorld& world,
    const hires::evaluation::SensorReadings& readings,
    const hires::simulation::TruthRecord& truth) {
  const ros::Time stamp = StampOf(world);
  std::vector<std::string> sensors{kTransforms, params_.names.joint_states, params_.names.odometry};
  PublishTransforms(readings, stamp);
  PublishLocalisation(readings, stamp);
  if (!laser_.link.empty() && scene_->surroundings) {
    PublishScan(world, readings, stamp);
    sensors.push_back(params_.names.base_scan);
  }
  if (IsLookDue(world, readings)) {
    last_look_ = world.milliseconds();
    PublishDetections(world, stamp);
    sensors.push_back(kDetections);
  }
  PublishTruth(world, truth, stamp);
  return sensors;
}

void SimRobotPublisher::PublishTransforms(const hires::evaluation::SensorReadings& readings,
                                          const ros::Time& stamp) {
  const hires::robot::Robot& robot = scene_->robot;
  tf_.sendTransform(MakeTransform(params_.names.map_frame, params_.names.odometry_frame,
                                  hires::geometry::Lift(readings.X_MO), stamp));
  std::vector<geometry_msgs::TransformStamped> links{
      MakeTransform(params_.names.odometry_frame, robot.profile.base_link,
                    hires::geometry::Lift(readings.odometry.X_OB), stamp)};
  const auto X_RL = hires::robot::ForwardKinematics(
      robot.model, hires::robot::PostureOf(robot, readings.joints.positions));
  for (std::size_t i = 0; i < robot.model.links.size(); ++i) {
    const auto& joint = robot.model.links[i].joint;
    if (!joint || robot.model.links[i].name == robot.profile.base_link) continue;
    links.push_back(MakeTransform(robot.model.links[joint->parent].name, robot.model.links[i].name,
                                  X_RL[joint->parent].Inverse() * X_RL[i], stamp));
  }
  tf_.sendTransform(links);
}

void SimRobotPublisher::PublishLocalisation(const hires::evaluation::SensorReadings& readings,
                                            const ros::Time& stamp) {
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header.stamp = stamp;
  pose.header.frame_id = params_.names.map_frame;
  pose.pose.pose = ToMsg(hires::geometry::Lift(readings.X_MB));
  amcl_.publish(pose);
}

void SimRobotPublisher::PublishScan(const hires::evaluation::SimRobotWorld& world,
                                    const hires::evaluation::SensorReadings& readings,
                                    const ros::Time& stamp) {
  hires::base::Rng rng = scan_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  std::vector<double> ranges = hires::simulation::ScanLaser(world.simulator(), laser_, &rng);
  hires::simulation::AddGhosts(readings.ghosts_M, laser_,
                               hires::geometry::Flatten(world.simulator().X_MLink(laser_.link)),
                               &ranges);
  sensor_msgs::LaserScan scan;
  scan.header.stamp = stamp;
  scan.header.frame_id = laser_.link;
  scan.angle_min = static_cast<float>(laser_.angle_min);
  scan.angle_max = static_cast<float>(laser_.angle_max);
  scan.angle_increment =
      static_cast<float>((laser_.angle_max - laser_.angle_min) / (laser_.num_beams - 1));
  scan.scan_time = kScanTime;
  scan.range_min = static_cast<float>(laser_.range_min);
  scan.range_max = static_cast<float>(laser_.range_max);
  scan.ranges.assign(ranges.begin(), ranges.end());
  scan_.publish(scan);
}

/// A camera that turns sees nothing sharp.
bool SimRobotPublisher::IsLookDue(const hires::evaluation::SimRobotWorld& world,
                                  const hires::evaluation::SensorReadings& readings) const {
  if (!scene_->surroundings) return false;
  const long period = std::lround(1000.0 * params_.detection_period);
  if (last_look_ && world.milliseconds() != *last_look_ &&
      world.milliseconds() < *last_look_ + period) {
    return false;
  }
  const hires::robot::UpperBodyProfile& body = *scene_->robot.profile.upper_body;
  for (const std::string& joint : {body.head_pan_joint, body.head_tilt_joint}) {
    const auto velocity = readings.joints.velocities.find(joint);
    if (velocity != readings.joints.velocities.end() && std::abs(velocity->second) > kStillHead) {
      return false;
    }
  }
  return true;
}

void SimRobotPublisher::PublishDetections(const hires::evaluation::SimRobotWorld& world,
                                          const ros::Time& stamp) {
  // The camera is where the robot really is; what it sees is told in its own frame.
  const auto& simulator = world.simulator();
  const auto& robot = scene_->robot;
  const auto objects = simulator.GetWorldState().objects;
  const auto truth = simulator.GetRobotState();
  const hires::perception::LineOfSight sight(
      scene_->surroundings, objects, hires::perception::ShapesOf(robot, truth.X_MB, truth.joints));
  const auto view =
      hires::perception::ViewFrom(robot, simulator.X_MLink(robot.profile.upper_body->camera_link));
  const hires::perception::DetectorParams detector{
      params_.min_visible_share, world.detection_noise(), world.detection_noise_yaw()};
  hires::base::Rng rng = detector_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  hires::Detections detections;
  detections.header.stamp = stamp;
  detections.header.frame_id = scene_->robot.profile.upper_body->camera_link;
  for (const hires::perception::Detection& seen :
       hires::perception::Detect(sight, view, objects, detector, &rng)) {
    detections.detections.push_back(ToMsg(seen));
  }
  detections_.publish(detections);
}

void SimRobotPublisher::PublishTruth(const hires::evaluation::SimRobotWorld& world,
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
