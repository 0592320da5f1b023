// What the simulated robot believes and sees.
#include <algorithm>
#include <utility>

#include "hires/base/text.h"
#include "hires/simulation/robot_simulator.h"
#include "simulation/start_checks.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;
using geometry::Pose3;

constexpr double kLookPeriod = 0.5;  // [s] between two looks of the camera
constexpr double kStillHead = 0.02;  // [rad/s] faster than this pictures blur

}  // namespace

Pose2 RobotSimulator::BelievedBase(base::Rng* rng) const {
  const Pose2 noise{rng->Normal(0.0, variation_.localisation_noise),
                    rng->Normal(0.0, variation_.localisation_noise),
                    rng->Normal(0.0, variation_.localisation_noise_yaw)};
  return state_.drive.motion().X_MB * variation_.localisation_bias * noise;
}

sensing::BodyReading RobotSimulator::FeltBody(const Pose2& X_MBbelieved) const {
  return {state_.time, X_MBbelieved, planar_->Joints()};
}

void RobotSimulator::Remember(const std::vector<robot::SeenObject>& objects) {
  for (const robot::SeenObject& object : objects) {
    RefuseUnknownModel({object.name, object.model, object.X_MO, {}, ""}, scene_->world);
    RefusePose("remembered object '" + object.name + "'", object.X_MO);
  }
  if (!state_.memory) return;
  const Pose2 X_MBbelieved = state_.drive.motion().X_MB * variation_.localisation_bias;
  for (const robot::SeenObject& object : objects) {
    const Pose3 X_BO = geometry::Lift(X_MBbelieved).Inverse() * object.X_MO;
    const auto& shapes = scene_->world.models.at(object.model)->collisions;
    const bool rides_along = StandsOn(scene_->base_shapes_B, shapes, X_BO);
    const auto known = state_.memory->objects().find(base::ToLower(object.name));
    if (known != state_.memory->objects().end() && known->second.is_held) continue;
    state_.memory->Believe(object.name, object.model,
                           rides_along ? scene_->robot.profile.base_link : "",
                           rides_along ? X_BO : object.X_MO);
  }
}

/// What hands hold at the start they know.
void RobotSimulator::BelieveHands() {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::string link = planar_->HolderOf(static_cast<int>(i));
    if (link.empty()) continue;
    state_.memory->Believe(objects_[i].name, objects_[i].model, link,
                           planar_->X_MLink(link).Inverse() * PoseOf(static_cast<int>(i)));
  }
}

void RobotSimulator::FeelAndLook() {
  state_.memory->Feel(FeltBody(state_.drive.motion().X_MB * variation_.localisation_bias));
  LookIfStill();
}

void RobotSimulator::LookIfStill() {
  if (state_.time - state_.last_look < kLookPeriod || planar_->IsHeadFaster(kStillHead)) return;
  state_.last_look = state_.time;
  const robot::Robot& robot = scene_->robot;
  const Pose3 X_MC = planar_->X_MLink(robot.profile.upper_body->camera_link);
  const perception::CameraView view = perception::ViewFrom(robot, X_MC);
  const std::vector<world::ObjectState> objects = GetWorldState().objects;
  const perception::LineOfSight sight(scene_->surroundings, objects, planar_->ShapesInMap());
  perception::DetectorParams params;
  params.position_noise = variation_.detection_noise;
  params.yaw_noise = variation_.detection_noise_yaw;
  const auto detections = perception::Detect(sight, view, objects, params, &state_.detection_rng);
  state_.memory->Look(FeltBody(BelievedBase(&state_.detection_rng)), detections);
}

/// Of torso, head and arms; a measured joint stays within its limits.
void RobotSimulator::AddEncoderNoise(robot::JointPositions* joints) {
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

void RobotSimulator::ObserveUpperBody(double action_start, robot::Observation* observation) {
  observation->joints = planar_->Joints();
  observation->joint_velocities = planar_->JointVelocities();
  if (variation_.encoder_noise > 0.0) AddEncoderNoise(&observation->joints);
  if (!state_.memory) return;
  observation->objects = state_.memory->Known(FeltBody(observation->X_MB));
  for (robot::SeenObject& seen : observation->objects) seen.time -= action_start;
}

robot::Observation RobotSimulator::Observe(double action_start) {
  const BaseMotion& motion = state_.drive.motion();
  robot::Observation observation;
  observation.time = state_.time - action_start;
  observation.X_MB = BelievedBase(&state_.sense_rng);
  observation.V_B = motion.V_B;
  state_.ghosts.Update(motion.X_MB, variation_.ghost_rate, state_.time);
  observation.obstacles_M = state_.ghosts.OutlinesInMap();
  if (planar_) ObserveUpperBody(action_start, &observation);
  return observation;
}

}  // namespace hires::simulation
