#include "hires/simulation/robot_simulator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;
using geometry::Pose3;

constexpr int kSlowSteps = 10;             // slip, contacts: every tenth step
constexpr double kSlipCorrelation = 0.1;   // [s]
constexpr physics::BodyId kFloorBody = 0;  // statics follow in their order

}  // namespace

struct RobotSimulator::Snapshot {
  State state;
  physics::PhysicsState physics;
  std::optional<PlanarRobot::State> planar;
};

std::optional<RobotContact> RobotSimulator::FindContact() const {
  if (planar_) return planar_->FindContact(state_.drive.motion().X_MB, object_names_);
  if (!clearance_) return scene_->clearance.FindContact(state_.drive.motion().X_MB);
  const auto contact = clearance_->FindContact(state_.drive.motion().X_MB);
  if (!contact) return contact;
  // A raised arm's prism reaches down to where the arm is not: look exactly.
  const auto touch = physics_->FindFixedTouch(robot_body_, kFloorBody);
  if (!touch) return std::nullopt;
  return RobotContact{shape_names_[touch->shape],
                      scene_->world.statics[touch->fixed - kFloorBody - 1].name};
}

geometry::Pose3 RobotSimulator::LeaningPose(const BaseMotion& motion) const {
  double height = 0.0, pitch = motion.pitch, roll = motion.roll;
  if (!floor_.is_flat()) {
    // Four wheels at the corners of a square within the footprint carry the base.
    const double arm = 0.7 * geometry::InscribedRadius(scene_->robot.profile.footprint);
    double front = 0.0, left = 0.0;
    for (const double x : {arm, -arm}) {
      for (const double y : {arm, -arm}) {
        const double h = floor_.HeightAt(motion.X_MB * Eigen::Vector2d(x, y));
        height += h / 4.0;
        front += h / 2.0 * (x > 0.0 ? 1.0 : -1.0);
        left += h / 2.0 * (y > 0.0 ? 1.0 : -1.0);
      }
    }
    pitch -= front / (2.0 * arm);
    roll += left / (2.0 * arm);
  }
  return {{motion.X_MB.x, motion.X_MB.y, height},
          geometry::RotationFromRpy(roll, pitch, motion.X_MB.yaw)};
}

void RobotSimulator::Send(const robot::Command& command) {
  if (command.base_velocity) state_.drive.Send(*command.base_velocity, state_.time);
  if (planar_) planar_->Send(command, state_.time);
}

void RobotSimulator::Step() {
  if (state_.steps % kSlowSteps == 0) {
    MoveSlip();
    if (!state_.contact) state_.contact = FindContact();
    if (state_.memory) FeelAndLook();
  }
  state_.drive.Step(state_.time, time_step(), state_.slip);
  const Pose3 X_next = LeaningPose(state_.drive.motion());
  if (planar_) {
    planar_->Move(state_.time, X_next);
  } else {
    physics_->SetMotion(robot_body_, MotionBetween(state_.X_MB, X_next, time_step()));
  }
  physics_->Step();
  state_.X_MB = X_next;
  ++state_.steps;
  state_.time = state_.steps * time_step();
  NoteDisturbances();
  if (planar_) planar_->React();
}

void RobotSimulator::MoveSlip() {
  if (variation_.wheel_slip == 0.0) return;
  const double keep = std::exp(-kSlowSteps * time_step() / kSlipCorrelation);
  state_.slip = keep * state_.slip + variation_.wheel_slip * std::sqrt(1.0 - keep * keep) *
                                         state_.slip_rng.Normal(0.0, 1.0);
}

void RobotSimulator::NoteDisturbances() {
  const BaseMotion& motion = state_.drive.motion();
  const robot::MotionSet& limits = scene_->robot.profile.base_controller.limits;
  const double power = motion.A_B.vx * motion.V_B.vx + motion.A_B.vy * motion.V_B.vy;
  if (motion.timed_out) state_.disturbances.late_command = state_.time;
  if (std::hypot(motion.A_B.vx, motion.A_B.vy) > 0.5 * limits.max_linear_acceleration) {
    (power < 0.0 ? state_.disturbances.braking : state_.disturbances.accelerating) = state_.time;
  }
  if (std::abs(motion.A_B.wz) > 0.5 * limits.max_angular_acceleration) {
    state_.disturbances.turning = state_.time;
  }
}

geometry::Pose3 RobotSimulator::X_MB() const { return state_.X_MB; }

std::map<std::string, int> RobotSimulator::held() const {
  return planar_ ? planar_->Held() : std::map<std::string, int>();
}

Pose3 RobotSimulator::X_MLink(const std::string& link) const {
  if (planar_) return planar_->X_MLink(link);
  const robot::RobotModel& model = scene_->robot.model;
  const auto index = model.FindLink(link);
  if (!index) {
    throw base::ConfigError("robot: " + base::UnknownName("link", link, model.LinkNames()));
  }
  const std::vector<Pose3> X_R = robot::ForwardKinematics(model, joints_);
  const Pose3& X_RB = X_R[*model.FindLink(scene_->robot.profile.base_link)];
  return state_.X_MB * X_RB.Inverse() * X_R[*index];
}

geometry::Pose3 RobotSimulator::PoseOf(int object) const {
  if (object_bodies_[object] < 0) return state_.X_MB * X_BO_start_[object];
  return physics_->GetState(object_bodies_[object]).X_WB;
}

geometry::Twist3 RobotSimulator::VelocityOf(int object) const {
  if (object_bodies_[object] < 0) return {};
  return physics_->GetState(object_bodies_[object]).V_WB;
}

std::string RobotSimulator::HolderOf(int object) const {
  return planar_ ? planar_->HolderOf(object) : objects_[object].attached_to;
}

world::WorldState RobotSimulator::GetWorldState() const {
  world::WorldState state;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    world::ObjectState object = objects_[i];
    object.X_MO = PoseOf(static_cast<int>(i));
    object.attached_to = HolderOf(static_cast<int>(i));
    if (object_bodies_[i] >= 0) object.V_MO = physics_->GetState(object_bodies_[i]).V_WB;
    state.objects.push_back(std::move(object));
  }
  return state;
}

robot::RobotState RobotSimulator::GetRobotState() const {
  return {state_.drive.motion().X_MB, state_.drive.motion().V_B,
          planar_ ? planar_->Joints() : joints_};
}

void RobotSimulator::PutBack(int object) {
  HIRES_CHECK(object_bodies_.at(object) >= 0, "an attached object cannot be put back");
  const Pose3 X_MO = state_.X_MB * X_BO_start_[object];
  const geometry::Twist2& V_B = state_.drive.motion().V_B;
  const Eigen::Vector3d w_M(0.0, 0.0, V_B.wz);
  const Eigen::Vector3d v_MB = state_.X_MB.rotation * Eigen::Vector3d(V_B.vx, V_B.vy, 0.0);
  physics_->SetState(object_bodies_[object],
                     {X_MO, {v_MB + w_M.cross(X_MO.translation - state_.X_MB.translation), w_M}});
}

std::shared_ptr<const RobotSimulator::Snapshot> RobotSimulator::Save() {
  return std::make_shared<const Snapshot>(Snapshot{
      state_, physics_->Save(), planar_ ? std::make_optional(planar_->Save()) : std::nullopt});
}

void RobotSimulator::Restore(const Snapshot& snapshot) {
  HIRES_CHECK(snapshot.planar.has_value() == (planar_ != nullptr),
              "a simulator is restored from one of the same level of detail");
  state_ = snapshot.state;
  physics_->Restore(snapshot.physics);
  if (planar_) planar_->Restore(*snapshot.planar);
}

}  // namespace hires::simulation
