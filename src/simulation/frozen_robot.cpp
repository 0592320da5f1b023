#include "simulation/frozen_robot.h"

#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/posture.h"
#include "simulation/planar_robot.h"

namespace hires::simulation {
namespace {

using geometry::Pose3;

constexpr physics::BodyId kFloorBody = 0;  // statics follow in their order

}  // namespace

FrozenRobot::FrozenRobot(std::shared_ptr<const Scene> scene, const robot::JointPositions& joints)
    : scene_(std::move(scene)), joints_(PostureOf(scene_->robot, joints)) {
  if (joints_ == PostureOf(scene_->robot, {})) return;
  shapes_B_ = FrozenShapes(scene_->robot, joints_);
}

const std::vector<geometry::Collision>& FrozenRobot::shapes_B() const {
  return shapes_B_ ? *shapes_B_ : scene_->robot_shapes_B;
}

Pose3 FrozenRobot::X_MLink(const Pose3& X_MB, const std::string& link) const {
  const robot::RobotModel& model = scene_->robot.model;
  const auto index = model.FindLink(link);
  if (!index) {
    throw base::ConfigError("robot: " + base::UnknownName("link", link, model.LinkNames()));
  }
  const std::vector<Pose3> X_R = robot::ForwardKinematics(model, joints_);
  const Pose3& X_RB = X_R[*model.FindLink(scene_->robot.profile.base_link)];
  return X_MB * X_RB.Inverse() * X_R[*index];
}

void FrozenRobot::AddBody(const Pose3& X_MB, const std::vector<geometry::Collision>& held_B,
                          physics::PhysicsWorld* physics) {
  std::vector<geometry::Collision> shapes = shapes_B();
  shapes.insert(shapes.end(), held_B.begin(), held_B.end());
  physics_ = physics;
  body_ = physics_->AddDriven(shapes, X_MB);
  if (!shapes_B_) return;
  clearance_.emplace(shapes, scene_->world);
}

void FrozenRobot::Move(const Pose3& X_MB, const Pose3& X_MBnext) {
  physics_->SetMotion(body_, MotionBetween(X_MB, X_MBnext, physics_->params().time_step));
}

std::optional<RobotContact> FrozenRobot::FindContact(const geometry::Pose2& X_MB) const {
  if (!clearance_) return scene_->clearance.FindContact(X_MB);
  const auto contact = clearance_->FindContact(X_MB);
  if (!contact) return contact;
  // A raised arm's prism reaches down to where the arm is not: look exactly. Physics answers for
  // what touches nothing, quickly; wheels touch a slab that bears them.
  if (!physics_->FindFixedTouch(body_, kFloorBody)) return std::nullopt;
  return clearance_->FindExactContact(X_MB);
}

}  // namespace hires::simulation
