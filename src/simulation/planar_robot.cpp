#include "simulation/planar_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/robot/gripper.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using physics::BodyId;

constexpr double kGapResolution = 1e-5;  // [m] of the gap round what is held at the start

const robot::UpperBodyProfile& ProfileOf(const Scene& scene) {
  return *scene.robot.profile.upper_body;
}

bool IsSame(const Pose3& a, const Pose3& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

}  // namespace

physics::BodyState MotionBetween(const Pose3& X_now, const Pose3& X_next, double dt) {
  Eigen::Quaterniond turn = X_next.rotation * X_now.rotation.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  return {X_now, {(X_next.translation - X_now.translation) / dt, 2.0 / dt * turn.vec()}};
}

PlanarRobot::PlanarRobot(const Scene& scene, const robot::JointPositions& joints, const Pose3& X_MB,
                         std::vector<GraspableObject> objects, std::vector<std::string> fixed_names,
                         physics::PhysicsWorld* physics)
    : scene_(&scene),
      physics_(physics),
      frozen_(joints),
      objects_(std::move(objects)),
      fixed_names_(std::move(fixed_names)),
      drives_(scene.robot, joints),
      links_(scene.robot, MovingJoints(scene.robot, drives_), joints),
      hands_({}, 0.0),
      fixed_to_(objects_.size()) {
  links_.Place(MovingPositions(), &X_B_);
  for (std::size_t i = 0; i < X_B_.size(); ++i) {
    X_M_.push_back(X_MB * X_B_[i]);
    body_ids_.push_back(physics_->AddDriven(links_.bodies()[i].collisions, X_M_.back()));
  }
  moves_.assign(X_M_.size(), false);
  hands_ = Hands(MakeHands(), ProfileOf(scene).gripper.force);
}

std::vector<HandBodies> PlanarRobot::MakeHands() const {
  const auto bodies_of = [this](const std::vector<std::string>& links) {
    std::vector<BodyId> bodies;
    for (const std::string& link : links) bodies.push_back(body_ids_[links_.BodyOf(link)]);
    return bodies;
  };
  std::vector<HandBodies> hands;
  for (const auto& [name, arm] : ProfileOf(*scene_).arms) {
    hands.push_back({name, drives_.Find(arm.gripper_joint), bodies_of({arm.palm_link}).front(),
                     bodies_of(arm.left_finger_links), bodies_of(arm.right_finger_links)});
  }
  return hands;
}

std::vector<double> PlanarRobot::MovingPositions() const {
  std::vector<double> positions;
  for (int i = 0; i < drives_.num_joints(); ++i) positions.push_back(drives_.position(i));
  const robot::UpperBodyProfile& profile = ProfileOf(*scene_);
  for (const auto& [name, arm] : profile.arms) {
    double& position = positions[drives_.Find(arm.gripper_joint)];
    position = robot::FingerPositionOf(profile.gripper, position);
  }
  return positions;
}

bool PlanarRobot::IsTouched(const HandBodies& hand, int object) const {
  const std::vector<BodyId> parts = hand.All();
  for (const physics::Touch& touch : physics_->FindTouches()) {
    if (touch.loose != objects_[object].body || touch.other == hand.palm) continue;
    if (std::find(parts.begin(), parts.end(), touch.other) != parts.end()) return true;
  }
  return false;
}

void PlanarRobot::PlaceAll(const Pose3& X_MB) {
  placed_positions_.clear();
  placed_X_MB_.reset();
  links_.Place(MovingPositions(), &X_B_);
  for (std::size_t i = 0; i < X_B_.size(); ++i) {
    X_M_[i] = X_MB * X_B_[i];
    physics_->SetMotion(body_ids_[i], {X_M_[i], {}});
  }
}

void PlanarRobot::FitGap(int hand, int object) {
  const HandBodies& bodies = hands_.bodies()[hand];
  const Pose3 X_MB = X_M_[0];
  const double given = drives_.position(bodies.gap_joint);
  const auto is_touched_at = [&](double gap) {
    drives_.Place(bodies.gap_joint, gap);
    PlaceAll(X_MB);
    return IsTouched(bodies, object);
  };
  double narrow = 0.0, wide = drives_.limits(bodies.gap_joint).upper;
  if (is_touched_at(wide)) return;
  if (!is_touched_at(narrow)) {
    is_touched_at(given);
    return;
  }
  while (wide - narrow > kGapResolution) {
    const double middle = 0.5 * (narrow + wide);
    (is_touched_at(middle) ? narrow : wide) = middle;
  }
  is_touched_at(narrow);
}

void PlanarRobot::Attach(int object, const std::string& link, double friction) {
  const auto& bodies = hands_.bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (ProfileOf(*scene_).arms.at(bodies[i].arm).palm_link != link) continue;
    if (hands_.hands()[i].object >= 0) break;  // one is in the fingers, this one hangs on beside
    FitGap(static_cast<int>(i), object);
    hands_.Hold(static_cast<int>(i), object, friction, objects_, physics_);
    return;
  }
  const BodyId body = body_ids_[links_.BodyOf(link)];
  physics_->Hold(objects_[object].body, body, {body});
  fixed_to_[object] = link;
}

void PlanarRobot::Send(const robot::Command& command, double time) {
  for (const auto& [group, trajectory] : command.trajectories) {
    drives_.Send(group, trajectory, time);
  }
  for (const auto& [arm, gripper] : command.grippers) {
    hands_.Send(arm, gripper, objects_, &drives_, physics_);
  }
}

void PlanarRobot::Move(double time, const Pose3& X_MBnext) {
  const double dt = physics_->params().time_step;
  drives_.Step(time + dt, dt);
  moved_.assign(X_B_.size(), false);
  if (drives_.is_moving()) PlaceMoved();
  const bool base_stands = placed_X_MB_ && IsSame(*placed_X_MB_, X_MBnext);
  placed_X_MB_ = X_MBnext;
  for (std::size_t i = 0; i < X_M_.size(); ++i) {
    const bool stands = base_stands && !moved_[i];
    if (stands && !moves_[i]) continue;
    MoveBody(i, stands ? X_M_[i] : X_MBnext * X_B_[i]);
  }
}

/// The bodies in the base's frame, after the joints have moved.
void PlanarRobot::PlaceMoved() {
  std::vector<double> positions = MovingPositions();
  if (placed_positions_.empty()) {
    links_.Place(positions, &X_B_);
    moved_.assign(X_B_.size(), true);
  } else {
    links_.PlaceMoved(placed_positions_, positions, &X_B_, &moved_);
  }
  placed_positions_ = std::move(positions);
}

void PlanarRobot::MoveBody(std::size_t body, const Pose3& X_next) {
  const bool moves = !IsSame(X_next, X_M_[body]);
  if (moves || moves_[body]) {
    const double dt = physics_->params().time_step;
    physics_->SetMotion(body_ids_[body], MotionBetween(X_M_[body], X_next, dt));
  }
  moves_[body] = moves;
  X_M_[body] = X_next;
}

void PlanarRobot::React() { hands_.React(objects_, &drives_, physics_); }

robot::JointPositions PlanarRobot::Joints() const {
  robot::JointPositions joints = frozen_;
  for (int i = 0; i < drives_.num_joints(); ++i) joints[drives_.name(i)] = drives_.position(i);
  robot::CompleteGrippers(ProfileOf(*scene_), &joints);
  return joints;
}

robot::JointPositions PlanarRobot::JointVelocities() const {
  robot::JointPositions velocities;
  for (int i = 0; i < drives_.num_joints(); ++i) velocities[drives_.name(i)] = drives_.velocity(i);
  return velocities;
}

Pose3 PlanarRobot::X_MLink(const std::string& link) const {
  return X_M_[links_.BodyOf(link)] * links_.InBody(link);
}

bool PlanarRobot::IsHeadFaster(double speed) const {
  const robot::UpperBodyProfile& profile = ProfileOf(*scene_);
  return std::abs(drives_.velocity(drives_.Find(profile.head_pan_joint))) > speed ||
         std::abs(drives_.velocity(drives_.Find(profile.head_tilt_joint))) > speed;
}

std::string PlanarRobot::HolderOf(int object) const {
  const int hand = hands_.HolderOf(object);
  if (hand < 0) return fixed_to_[object];
  return ProfileOf(*scene_).arms.at(hands_.bodies()[hand].arm).palm_link;
}

std::map<std::string, int> PlanarRobot::Held() const {
  std::map<std::string, int> held;
  for (std::size_t i = 0; i < hands_.hands().size(); ++i) {
    if (hands_.hands()[i].object >= 0) held[hands_.bodies()[i].arm] = hands_.hands()[i].object;
  }
  return held;
}

std::vector<geometry::Collision> PlanarRobot::ShapesInMap() const {
  std::vector<geometry::Collision> shapes_M;
  for (std::size_t i = 0; i < X_M_.size(); ++i) {
    for (const geometry::Collision& shape : links_.bodies()[i].collisions) {
      shapes_M.push_back(shape);
      shapes_M.back().X_BS = X_M_[i] * shape.X_BS;
    }
  }
  return shapes_M;
}

std::string PlanarRobot::LinkOfBody(BodyId body) const {
  const auto found = std::find(body_ids_.begin(), body_ids_.end(), body);
  return found == body_ids_.end() ? "" : links_.bodies()[found - body_ids_.begin()].link;
}

std::optional<RobotContact> PlanarRobot::FindContact(
    const Pose2& X_MB, const std::vector<std::string>& object_names) const {
  if (auto contact = scene_->base_clearance.FindContact(X_MB)) return contact;
  for (std::size_t i = 1; i < body_ids_.size(); ++i) {
    const auto touch = physics_->FindFixedTouch(body_ids_[i]);
    if (!touch) continue;
    geometry::Collision part = links_.bodies()[i].collisions[touch->shape];
    part.X_BS = X_M_[i] * part.X_BS;
    if (touch->fixed == 0) return RobotContact{part.name, fixed_names_.front()};  // the floor
    return ContactWith(part, scene_->world.statics[touch->fixed - 1], scene_->world);
  }
  const std::optional<Hands::Blocked>& blocked = hands_.blocked();
  if (!blocked) return std::nullopt;
  std::string by = LinkOfBody(blocked->by);
  if (blocked->by < static_cast<int>(fixed_names_.size())) by = fixed_names_[blocked->by];
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].body == blocked->by) by = object_names[i];
  }
  return RobotContact{object_names[blocked->object], by};
}

PlanarRobot::State PlanarRobot::Save() const {
  return {drives_, hands_.hands(), hands_.blocked(), X_B_, X_M_, moves_, fixed_to_};
}

void PlanarRobot::Restore(const State& state) {
  drives_ = state.drives;
  hands_.Restore(state.hands);
  hands_.RestoreBlocked(state.blocked);
  X_B_ = state.X_B;
  X_M_ = state.X_M;
  moves_ = state.moves;
  fixed_to_ = state.fixed_to;
  placed_positions_.clear();
  placed_X_MB_.reset();
}

}  // namespace hires::simulation
