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
  physics::PhysicsState physics;
  double time;
  long steps;
  BaseDrive drive;
  Pose3 X_MB;
  double slip;
  base::Rng slip_rng, sense_rng, ghost_rng;
  double last_observation;
  std::deque<Ghost> ghosts;
  std::optional<RobotContact> contact;
  Disturbances disturbances;
  std::optional<PlanarRobot::State> planar;
  base::Rng encoder_rng, detection_rng;
  std::optional<sensing::ObjectMemory> memory;
  double last_look;
};

std::optional<RobotContact> RobotSimulator::FindContact() const {
  if (planar_) return planar_->FindContact(drive_.motion().X_MB, object_names_);
  if (!clearance_) return scene_->clearance.FindContact(drive_.motion().X_MB);
  const auto contact = clearance_->FindContact(drive_.motion().X_MB);
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
  if (command.base_velocity) drive_.Send(*command.base_velocity, time_);
  if (planar_) planar_->Send(command, time_);
}

void RobotSimulator::Step() {
  if (steps_ % kSlowSteps == 0) {
    MoveSlip();
    if (!contact_) contact_ = FindContact();
    if (memory_) FeelAndLook();
  }
  drive_.Step(time_, time_step(), slip_);
  const Pose3 X_next = LeaningPose(drive_.motion());
  if (planar_) {
    planar_->Move(time_, X_next);
  } else {
    physics_->SetMotion(robot_body_, MotionBetween(X_MB_, X_next, time_step()));
  }
  physics_->Step();
  X_MB_ = X_next;
  ++steps_;
  time_ = steps_ * time_step();
  NoteDisturbances();
  if (planar_) planar_->React();
}

void RobotSimulator::MoveSlip() {
  if (variation_.wheel_slip == 0.0) return;
  const double keep = std::exp(-kSlowSteps * time_step() / kSlipCorrelation);
  slip_ = keep * slip_ +
          variation_.wheel_slip * std::sqrt(1.0 - keep * keep) * slip_rng_.Normal(0.0, 1.0);
}

void RobotSimulator::NoteDisturbances() {
  const BaseMotion& motion = drive_.motion();
  const robot::MotionSet& limits = scene_->robot.profile.base_controller.limits;
  const double power = motion.A_B.vx * motion.V_B.vx + motion.A_B.vy * motion.V_B.vy;
  if (motion.timed_out) disturbances_.late_command = time_;
  if (std::hypot(motion.A_B.vx, motion.A_B.vy) > 0.5 * limits.max_linear_acceleration) {
    (power < 0.0 ? disturbances_.braking : disturbances_.accelerating) = time_;
  }
  if (std::abs(motion.A_B.wz) > 0.5 * limits.max_angular_acceleration) {
    disturbances_.turning = time_;
  }
}

geometry::Pose3 RobotSimulator::X_MB() const { return X_MB_; }

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
  return X_MB_ * X_RB.Inverse() * X_R[*index];
}

geometry::Pose3 RobotSimulator::PoseOf(int object) const {
  if (object_bodies_[object] < 0) return X_MB_ * X_BO_start_[object];
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
  return {drive_.motion().X_MB, drive_.motion().V_B, planar_ ? planar_->Joints() : joints_};
}

void RobotSimulator::PutBack(int object) {
  HIRES_CHECK(object_bodies_.at(object) >= 0, "an attached object cannot be put back");
  const Pose3 X_MO = X_MB_ * X_BO_start_[object];
  const geometry::Twist2& V_B = drive_.motion().V_B;
  const Eigen::Vector3d w_M(0.0, 0.0, V_B.wz);
  const Eigen::Vector3d v_MB = X_MB_.rotation * Eigen::Vector3d(V_B.vx, V_B.vy, 0.0);
  physics_->SetState(object_bodies_[object],
                     {X_MO, {v_MB + w_M.cross(X_MO.translation - X_MB_.translation), w_M}});
}

std::shared_ptr<const RobotSimulator::Snapshot> RobotSimulator::Save() {
  return std::make_shared<const Snapshot>(
      Snapshot{physics_->Save(), time_, steps_, drive_, X_MB_, slip_, slip_rng_, sense_rng_,
               ghost_rng_, last_observation_, ghosts_, contact_, disturbances_,
               planar_ ? std::make_optional(planar_->Save()) : std::nullopt, encoder_rng_,
               detection_rng_, memory_, last_look_});
}

void RobotSimulator::Restore(const Snapshot& snapshot) {
  physics_->Restore(snapshot.physics);
  time_ = snapshot.time;
  steps_ = snapshot.steps;
  drive_ = snapshot.drive;
  X_MB_ = snapshot.X_MB;
  slip_ = snapshot.slip;
  slip_rng_ = snapshot.slip_rng;
  sense_rng_ = snapshot.sense_rng;
  ghost_rng_ = snapshot.ghost_rng;
  last_observation_ = snapshot.last_observation;
  ghosts_ = snapshot.ghosts;
  contact_ = snapshot.contact;
  disturbances_ = snapshot.disturbances;
  HIRES_CHECK(snapshot.planar.has_value() == (planar_ != nullptr),
              "a simulator is restored from one of the same level of detail");
  if (planar_) planar_->Restore(*snapshot.planar);
  encoder_rng_ = snapshot.encoder_rng;
  detection_rng_ = snapshot.detection_rng;
  memory_ = snapshot.memory;
  last_look_ = snapshot.last_look;
}

}  // namespace hires::simulation
