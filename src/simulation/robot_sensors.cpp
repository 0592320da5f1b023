#include "simulation/robot_sensors.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "hires/geometry/covariance.h"
#include "simulation/varied.h"

namespace hires::simulation {
namespace {

constexpr double kSlack = 1e-6;  // [s] between times that are multiples of a step

}  // namespace

RobotSensors::RobotSensors(std::shared_ptr<const Scene> scene, const Variation& variation,
                           const geometry::Pose2& X_MB, const base::Rng& rng)
    : scene_(std::move(scene)),
      variation_(variation),
      odometry_scale_(1.0 + rng.Fork(8).Normal(0.0, variation.wheel_slip)),
      state_{rng.Fork(2),  GhostObstacles(rng.Fork(3)),
             rng.Fork(4),  std::nullopt,
             std::nullopt, rng.Fork(7),
             0.0,          nullptr,
             0.0,          std::nullopt,
             X_MB,         X_MB} {
  if (scene_->sight.scans) state_.memory.emplace(robot::BaseOutlineOf(scene_->robot));
  if (scene_->self_localisation)
    state_.localiser.emplace(scene_->self_localisation, X_MB, rng.Fork(6));
  else if (scene_->pose_error)
    state_.told.emplace(*scene_->pose_error, X_MB, rng.Fork(6));
}

void RobotSensors::ReadBase(double time, const BaseMotion& motion,
                            robot::Observation* observation) {
  if (state_.localiser) {
    observation->X_MB = state_.localiser->X_MB();
    observation->X_OB = state_.localiser->X_OB();
    observation->V_B = state_.localiser->V_B();
    const Eigen::Matrix3d covariance = state_.localiser->Estimate().covariance;
    observation->position_sd =
        geometry::LargestSd(covariance(0, 0), covariance(0, 1), covariance(1, 1));
  } else if (state_.told) {
    state_.told->Drive(motion.X_MB);
    observation->X_MB = state_.told->X_MBelieved();
    observation->X_OB = state_.told->X_OB();
    observation->V_B = motion.V_B;
  } else {
    observation->X_MB = BelievedPose(motion.X_MB, variation_, &state_.rng);
    ReadOdometry(motion, observation);
  }
  observation->scan = state_.scan;
  observation->scan_age = time - state_.scanned;
  state_.ghosts.Update(motion.X_MB, variation_.ghost_rate, time);
  observation->obstacles_M = state_.ghosts.OutlinesInMap();
}

/// As far as wheels slip, all ways are counted too long, or too short.
void RobotSensors::ReadOdometry(const BaseMotion& motion, robot::Observation* observation) {
  const geometry::Pose2 step = state_.X_MBread.Inverse() * motion.X_MB;
  state_.X_OB =
      state_.X_OB * geometry::Pose2{odometry_scale_ * step.x, odometry_scale_ * step.y, step.yaw};
  state_.X_MBread = motion.X_MB;
  observation->X_OB = state_.X_OB;
  observation->V_B = {odometry_scale_ * motion.V_B.vx, odometry_scale_ * motion.V_B.vy,
                      motion.V_B.wz};
}

std::optional<geometry::Pose2> RobotSensors::place_error() const {
  if (state_.localiser) return state_.localiser->X_MBtrue().Inverse() * state_.localiser->X_MB();
  if (state_.told) return state_.told->error();
  return std::nullopt;
}

base::Rng* RobotSensors::ScanDue(double time) {
  const auto& scans = scene_->sight.scans;
  if (!scans || time < state_.next_scan) return nullptr;
  state_.next_scan = time + scans->period - kSlack;
  return &state_.scan_rng;
}

void RobotSensors::ReadScan(double time, robot::ScanReading reading, const geometry::Pose2& X_BL,
                            robot::Observation* observation) {
  robot::PlacedScan scan{std::move(reading), observation->X_OB, X_BL, {}};
  state_.memory->Complete(time, &scan);
  state_.scan = std::make_shared<const robot::PlacedScan>(std::move(scan));
  state_.scanned = time;
  observation->scan = state_.scan;
  observation->scan_age = 0.0;
}

void RobotSensors::ReadJoints(const PlanarRobot& robot, robot::Observation* observation) {
  observation->joints = robot.Joints();
  observation->joint_velocities = robot.JointVelocities();
  if (variation_.encoder_noise > 0.0) AddEncoderNoise(&observation->joints);
}

/// Of torso, head and arms; a measured joint stays within its limits.
void RobotSensors::AddEncoderNoise(robot::JointPositions* joints) {
  const robot::UpperBodyProfile& profile = *scene_->robot.profile.upper_body;
  std::vector<std::string> groups{"torso", "head"};
  for (const auto& [arm, parts] : profile.arms) groups.push_back(arm);
  for (const std::string& group : groups) {
    for (const std::string& name : robot::JointsOfGroup(profile, group)) {
      double& position = joints->at(name);
      position += state_.encoder_rng.Normal(0.0, variation_.encoder_noise);
      const robot::Joint& joint = *robot::FindJoint(scene_->robot.model, name);
      if (joint.type == robot::JointType::kContinuous) continue;
      position = std::clamp(position, joint.limits->lower, joint.limits->upper);
    }
  }
}

}  // namespace hires::simulation
