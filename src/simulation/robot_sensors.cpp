#include "simulation/robot_sensors.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "simulation/varied.h"

namespace hires::simulation {

RobotSensors::RobotSensors(std::shared_ptr<const Scene> scene, const Variation& variation,
                           const geometry::Pose2& X_MB, const base::Rng& rng)
    : scene_(std::move(scene)),
      variation_(variation),
      state_{rng.Fork(2), GhostObstacles(rng.Fork(3)), rng.Fork(4), std::nullopt} {
  if (scene_->self_localisation)
    state_.localiser.emplace(scene_->self_localisation, X_MB, rng.Fork(6));
}

void RobotSensors::ReadBase(double time, const BaseMotion& motion,
                            robot::Observation* observation) {
  observation->X_MB = state_.localiser ? state_.localiser->X_MB()
                                       : BelievedPose(motion.X_MB, variation_, &state_.rng);
  observation->V_B = motion.V_B;
  state_.ghosts.Update(motion.X_MB, variation_.ghost_rate, time);
  observation->obstacles_M = state_.ghosts.OutlinesInMap();
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
