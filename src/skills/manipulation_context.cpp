#include "hires/skills/manipulation_context.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/robot/gripper.h"
#include "hires/robot/posture.h"

namespace hires::skills {
namespace {

using robot::JointPositions;

// From everything in the world: what touches there are parts of the robot.
const geometry::Pose2 kFarAway{1e4, 1e4, 0.0};

/// Way points lead one arm past the other where it is folded: what touches there with the other
/// arms in the driving posture are shapes that are coarser than the real parts.
void AllowWayPoints(const ManipulationContext& context, manipulation::CollisionScene* scene) {
  constexpr int kMaxTouches = 50;  // of one posture
  for (const auto& [name, arm] : context.upper_body().arms) {
    const manipulation::LinkMask links = scene->MovedBy(arm.joints);
    for (const auto& [point, positions] : arm.way_points) {
      JointPositions posture = PostureOf(*context.robot, context.robot->profile.joints);
      SetJoints(arm.joints, positions, &posture);
      for (int i = 0; i < kMaxTouches; ++i) {
        const auto touch = scene->FindTouch(kFarAway, posture, links);
        if (!touch) break;
        scene->Allow(touch->a, touch->b);
      }
    }
  }
}

}  // namespace

std::shared_ptr<const ManipulationContext> MakeManipulationContext(
    std::shared_ptr<const world::World> world, std::shared_ptr<const robot::Robot> robot,
    const ManipulationParams& params, const world::StandingCriterion& standing) {
  HIRES_CHECK(robot->profile.upper_body.has_value(), "a context of a robot without upper body");
  auto context = std::make_shared<ManipulationContext>();
  context->world = std::move(world);
  context->robot = std::move(robot);
  context->params = params;
  context->standing = standing;
  for (const auto& [name, arm] : context->upper_body().arms) {
    context->arms[name] =
        std::make_shared<const manipulation::ArmKinematics>(*context->robot, name);
  }
  auto scene = std::make_shared<manipulation::CollisionScene>(context->world, context->robot,
                                                              params.collision);
  AllowWayPoints(*context, scene.get());
  context->empty_scene = std::move(scene);
  return context;
}

std::uint64_t SeedOf(const ManipulationParams& params, const base::ActionCall& action) {
  base::Hasher hasher;
  hasher.Add(base::ToLower(base::ToString(action)));
  hasher.Add(static_cast<std::uint64_t>(params.seed));
  return hasher.value();
}

std::uint64_t AttemptSeed(std::uint64_t seed, int attempt) {
  return base::Rng(seed).Fork(static_cast<std::uint64_t>(attempt)).seed();
}

void SetJoints(const std::vector<std::string>& joints, const std::vector<double>& positions,
               JointPositions* posture) {
  for (std::size_t i = 0; i < joints.size(); ++i) (*posture)[joints[i]] = positions[i];
}

std::vector<double> JointsOf(const std::vector<std::string>& joints,
                             const JointPositions& posture) {
  std::vector<double> positions;
  for (const std::string& joint : joints) {
    const auto found = posture.find(joint);
    positions.push_back(found == posture.end() ? 0.0 : found->second);
  }
  return positions;
}

std::vector<double> NearestTurn(const robot::RobotModel& model,
                                const std::vector<std::string>& joints, std::vector<double> goal,
                                const std::vector<double>& near) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const robot::Joint* joint = robot::FindJoint(model, joints[i]);
    if (joint != nullptr && joint->type == robot::JointType::kContinuous) {
      goal[i] = near[i] + geometry::WrapToPi(goal[i] - near[i]);
    }
  }
  return goal;
}

std::string KnownArm(const ManipulationContext& context, const std::string& arm) {
  const auto& arms = context.upper_body().arms;
  if (arms.count(base::ToLower(arm)) > 0) return base::ToLower(arm);
  std::vector<std::string> names;
  for (const auto& entry : arms) names.push_back(entry.first);
  throw base::ConfigError(base::UnknownName("arm", arm, names));
}

void RequireTray(const ManipulationContext& context) {
  if (!context.robot->profile.tray_link.empty()) return;
  throw base::ConfigError("robot '" + context.robot->model.name +
                          "' has no tray to put anything on; name a tray_link in its profile");
}

geometry::Pose3 TrayFrame(const ManipulationContext& context,
                          const robot::Observation& observation) {
  const robot::RobotProfile& profile = context.robot->profile;
  return LinkPose(*context.robot, observation.X_MB, PostureOf(*context.robot, observation.joints),
                  profile.tray_link) *
         profile.X_TO;
}

geometry::Pose3 LinkPose(const robot::Robot& robot, const geometry::Pose2& X_MB,
                         const JointPositions& posture, const std::string& link) {
  const std::vector<geometry::Pose3> X_RL = robot::ForwardKinematics(robot.model, posture);
  const geometry::Pose3& X_RB =
      X_RL[static_cast<std::size_t>(*robot.model.FindLink(robot.profile.base_link))];
  return geometry::Lift(X_MB) * X_RB.Inverse() *
         X_RL[static_cast<std::size_t>(*robot.model.FindLink(link))];
}

base::Failure WhyNotKnown(const ManipulationContext& context, const robot::Observation& seen) {
  for (const robot::SeenObject& object : seen.objects) {
    if (context.world->FindModel(object.model)) continue;
    return {base::FailureCode::kUnknownModel, {object.model}};
  }
  return {};
}

const robot::SeenObject* HeldBy(const robot::ArmProfile& arm, const robot::Observation& seen) {
  for (const robot::SeenObject& object : seen.objects) {
    if (object.attached_to == arm.palm_link) return &object;
  }
  return nullptr;
}

const robot::SeenObject* FindSeen(const robot::Observation& seen, const std::string& name) {
  for (const robot::SeenObject& object : seen.objects) {
    if (base::ToLower(object.name) == name) return &object;
  }
  return nullptr;
}

}  // namespace hires::skills
