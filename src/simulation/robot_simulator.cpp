#include "hires/simulation/robot_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;
using geometry::Pose3;

constexpr int kSlowSteps = 10;            // slip, contacts: every tenth step
constexpr double kSlipCorrelation = 0.1;  // [s]
constexpr double kGhostLifetime = 4.6;    // [s] persistence of ground objects (navigation.md, 4)
constexpr double kGhostSize = 0.10;       // [m] edge: a voxel of the obstacle filter
constexpr double kStartSlack = 0.005;     // [m] bodies may overlap this much at the start
constexpr double kRestingGap = 0.06;      // [m] an object this far above the tray falls onto it
constexpr double kFarAway = 1000.0;       // [m]
constexpr double kStiffest = 2.0;         // half of what diverges
constexpr double kUnitSlack = 1e-6;       // how far a quaternion's length may be from 1

robot::BaseControllerParams Varied(robot::BaseControllerParams params, const Variation& variation) {
  params.command_lag += variation.command_delay;
  params.loop_damping *= variation.loop_damping_factor;
  params.sway_compliance *= variation.sway_factor;
  return params;
}

geometry::MassProperties Varied(geometry::MassProperties properties, const Variation& variation) {
  properties.mass *= variation.mass_factor;
  properties.I_BBcm *= variation.mass_factor;
  properties.p_BBcm.z() *= variation.com_height_factor;
  properties.p_BBcm.head<2>() += variation.com_offset;
  return properties;
}

std::vector<geometry::Collision> Varied(std::vector<geometry::Collision> shapes,
                                        const Variation& variation) {
  for (geometry::Collision& shape : shapes) {
    shape.friction *= variation.friction_factor;
    if (auto* cylinder = std::get_if<geometry::Cylinder>(&shape.shape)) {
      cylinder->radius *= variation.radius_factor;
    }
  }
  return shapes;
}

/// Does a shape of `a` reach more than the slack into a shape of `b`? Shapes count as upright
/// prisms, as in RobotClearance.
bool Overlap(const std::vector<geometry::Collision>& a, const Pose3& X_MA,
             const std::vector<geometry::Collision>& b, const Pose3& X_MB) {
  for (const geometry::Collision& first : a) {
    const Pose3 X_MF = X_MA * first.X_BS;
    const geometry::Aabb bounds = geometry::BoundsOf(first.shape, X_MF);
    const double z_min = bounds.lower.z() + kStartSlack, z_max = bounds.upper.z() - kStartSlack;
    if (z_min > z_max) continue;
    const auto outline = geometry::OutlineInBand(first.shape, X_MF, z_min, z_max);
    for (const geometry::Collision& second : b) {
      const Pose3 X_MS = X_MB * second.X_BS;
      if (!outline || !bounds.Overlaps(geometry::BoundsOf(second.shape, X_MS))) continue;
      const auto other = geometry::OutlineInBand(second.shape, X_MS, z_min, z_max);
      if (other && geometry::Distance(*outline, *other) == 0.0) return true;
    }
  }
  return false;
}

/// Does the object's lowest point lie on top of one of the robot's shapes?
bool StandsOn(const std::vector<geometry::Collision>& robot_B,
              const std::vector<geometry::Collision>& object, const Pose3& X_BO) {
  geometry::Aabb object_bounds;
  for (const geometry::Collision& shape : object) {
    object_bounds.Include(geometry::BoundsOf(shape.shape, X_BO * shape.X_BS));
  }
  const double bottom = object_bounds.lower.z();
  return std::any_of(robot_B.begin(), robot_B.end(), [&](const geometry::Collision& part) {
    const geometry::Aabb bounds = geometry::BoundsOf(part.shape, part.X_BS);
    if (std::abs(bounds.upper.z() - bottom) > kRestingGap) return false;
    const auto outline =
        geometry::OutlineInBand(part.shape, part.X_BS, bounds.lower.z(), bounds.upper.z());
    return outline && geometry::Contains(*outline, X_BO.translation.head<2>());
  });
}

void RefusePose(const std::string& what, const Pose3& X) {
  if (!X.IsFinite()) {
    throw base::ConfigError(fmt::format("{}: its pose is not finite; give numbers", what));
  }
  if (X.translation.norm() > kFarAway) {
    throw base::ConfigError(fmt::format(
        "{}: stands {:.0f} m from the map's origin, at most {:.0f} m make sense; check its pose",
        what, X.translation.norm(), kFarAway));
  }
}

void RefuseObject(const world::ObjectState& object) {
  const std::string what = fmt::format("object '{}'", object.name);
  RefusePose(what, object.X_MO);
  if (std::abs(object.X_MO.rotation.norm() - 1.0) > kUnitSlack) {
    throw base::ConfigError(
        fmt::format("{}: its quaternion has length {:.6g}, wanted unit length; no turn is (x, y, "
                    "z, w) = (0, 0, 0, 1)",
                    what, object.X_MO.rotation.norm()));
  }
  if (!object.V_MO.linear.allFinite() || !object.V_MO.angular.allFinite()) {
    throw base::ConfigError(
        fmt::format("{}: its velocity is not finite; give numbers, 0 at rest", what));
  }
}

void RefuseUnknownHolder(const world::ObjectState& object, const robot::RobotModel& robot) {
  if (object.attached_to.empty() || robot.FindLink(object.attached_to)) return;
  throw base::ConfigError(
      fmt::format("object '{}' is attached to the robot: {}", object.name,
                  base::UnknownName("link", object.attached_to, robot.LinkNames())));
}

/// The joints are frozen in the driving posture, but a name that is not the robot's means that
/// another robot is spoken of.
void RefuseUnknownJoints(const robot::JointPositions& joints, const robot::RobotModel& robot) {
  std::vector<std::string> known;
  for (const robot::Link& link : robot.links) {
    if (link.joint) known.push_back(link.joint->name);
  }
  for (const auto& [name, position] : joints) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw base::ConfigError(
          fmt::format("robot '{}': {}", robot.name, base::UnknownName("joint", name, known)));
    }
  }
}

/// Loop and leaning are integrated by the semi-implicit Euler method: x'' = -w^2 x - 2 zeta w x'
/// grows without bounds from (w dt)^2 + 4 zeta w dt = 4 on.
void RefuseStiff(const char* what, double frequency, double damping, double time_step) {
  const double h = frequency * time_step;
  if (h * h + 4.0 * damping * h < kStiffest) return;
  throw base::ConfigError(fmt::format(
      "base controller: {0}_frequency {1:g} rad/s with {0}_damping {2:g} is too stiff for a time "
      "step of {3:g} s; (w dt)^2 + 4 zeta w dt is {4:.3g}, wanted below {5:g}: lower one of the "
      "three",
      what, frequency, damping, time_step, h * h + 4.0 * damping * h, kStiffest));
}

void RefuseStiff(const robot::BaseControllerParams& params, double time_step) {
  RefuseStiff("loop", params.loop_frequency, params.loop_damping, time_step);
  RefuseStiff("sway", params.sway_frequency, params.sway_damping, time_step);
}

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
};

RobotSimulator::RobotSimulator(std::shared_ptr<const Scene> scene, const Variation& variation,
                             const world::WorldState& world_state,
                             const robot::RobotState& robot_state, base::Rng rng,
                             const physics::PhysicsParams& params)
    : scene_(std::move(scene)),
      variation_(variation),
      floor_(variation.floor_roughness, rng.Fork(0)),
      drive_(Varied(scene_->robot.profile.base_controller, variation),
             robot_state.X_MB * variation.start_offset),
      slip_rng_(rng.Fork(1)),
      sense_rng_(rng.Fork(2)),
      ghost_rng_(rng.Fork(3)) {
  physics::PhysicsParams physics_params = params;
  physics_params.gravity = scene_->world.gravity;
  physics_ = std::make_unique<physics::PhysicsWorld>(physics_params);
  RefuseStiff(Varied(scene_->robot.profile.base_controller, variation), time_step());
  RefusePose("the robot", geometry::Lift(robot_state.X_MB));
  RefuseUnknownJoints(robot_state.joints, scene_->robot.model);
  X_MB_ = LeaningPose(drive_.motion());
  physics_->AddFloor(scene_->world.floor_friction);
  for (const world::StaticBody& body : scene_->world.statics) {
    physics_->AddStatic(body.collisions, body.X_MB);
  }
  world::WorldState placed = world_state;
  for (world::ObjectState& object : placed.objects) {
    RefuseObject(object);
    X_BO_start_.push_back(geometry::Lift(robot_state.X_MB).Inverse() * object.X_MO);
  }
  AddObjects(placed);
  AddRobot();
  RefuseBadStart(GetWorldState());
}

void RobotSimulator::AddObjects(const world::WorldState& state) {
  for (std::size_t i = 0; i < state.objects.size(); ++i) {
    world::ObjectState object = state.objects[i];
    const auto model = scene_->world.models.find(object.model);
    if (model == scene_->world.models.end()) {
      std::vector<std::string> known;
      for (const auto& entry : scene_->world.models) known.push_back(entry.first);
      throw base::ConfigError(fmt::format("object '{}': {}", object.name,
                                          base::UnknownName("model", object.model, known)));
    }
    RefuseUnknownHolder(object, scene_->robot.model);
    const bool is_carried =
        StandsOn(scene_->robot_shapes_B, model->second->collisions, X_BO_start_[i]);
    if (is_carried && object.attached_to.empty()) {
      X_BO_start_[i].translation.head<2>() += variation_.object_offset;
      carried_.push_back(static_cast<int>(i));
    }
    if (is_carried || !object.attached_to.empty()) object.X_MO = X_MB_ * X_BO_start_[i];
    objects_.push_back(object);
    if (!object.attached_to.empty()) {  // becomes part of the robot
      object_bodies_.push_back(-1);
      continue;
    }
    object_bodies_.push_back(physics_->AddLoose(Varied(model->second->mass_properties, variation_),
                                                Varied(model->second->collisions, variation_),
                                                {object.X_MO, object.V_MO}));
  }
}

void RobotSimulator::AddRobot() {
  std::vector<geometry::Collision> shapes = scene_->robot_shapes_B;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].attached_to.empty()) continue;
    for (geometry::Collision shape : scene_->world.models.at(objects_[i].model)->collisions) {
      shape.X_BS = X_BO_start_[i] * shape.X_BS;
      shapes.push_back(std::move(shape));
    }
  }
  robot_body_ = physics_->AddDriven(shapes, X_MB_);
}

void RobotSimulator::RefuseBadStart(const world::WorldState& state) const {
  if (const auto contact = scene_->clearance.FindContact(drive_.motion().X_MB)) {
    throw base::ConfigError(fmt::format(
        "robot starts in collision: its '{}' touches '{}' at x {:.3f} m, y {:.3f} m, yaw {:.3f} "
        "rad; move the start",
        contact->robot_part, contact->obstacle, drive_.motion().X_MB.x, drive_.motion().X_MB.y,
        drive_.motion().X_MB.yaw));
  }
  for (std::size_t i = 0; i < state.objects.size(); ++i) {
    const world::ObjectState& object = state.objects[i];
    const auto& shapes = scene_->world.models.at(object.model)->collisions;
    for (std::size_t j = 0; j < i; ++j) RefuseTogether(object, shapes, state.objects[j]);
    if (!object.attached_to.empty()) continue;
    if (Overlap(shapes, object.X_MO, scene_->robot_shapes_B, X_MB_)) {
      throw base::ConfigError(
          fmt::format("object '{}' starts inside the robot; put it on a free place", object.name));
    }
    for (const world::StaticBody& body : scene_->world.statics) {
      if (Overlap(shapes, object.X_MO, body.collisions, body.X_MB)) {
        throw base::ConfigError(fmt::format(
            "object '{}' starts inside '{}'; put it on a free place", object.name, body.name));
      }
    }
  }
}

void RobotSimulator::RefuseTogether(const world::ObjectState& object,
                                   const std::vector<geometry::Collision>& shapes,
                                   const world::ObjectState& earlier) const {
  if (base::ToLower(object.name) == base::ToLower(earlier.name)) {
    throw base::ConfigError(
        fmt::format("object '{}' is there twice; name each instance once", object.name));
  }
  const auto& others = scene_->world.models.at(earlier.model)->collisions;
  if (Overlap(shapes, object.X_MO, others, earlier.X_MO)) {
    throw base::ConfigError(fmt::format("object '{}' starts inside '{}'; put it on a free place",
                                        object.name, earlier.name));
  }
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

physics::BodyState RobotSimulator::BodyMotion(const Pose3& X_now, const Pose3& X_next) const {
  const double dt = time_step();
  Eigen::Quaterniond turn = X_next.rotation * X_now.rotation.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  return {X_now, {(X_next.translation - X_now.translation) / dt, 2.0 / dt * turn.vec()}};
}

void RobotSimulator::Send(const robot::Command& command) {
  if (command.base_velocity) drive_.Send(*command.base_velocity, time_);
}

void RobotSimulator::Step() {
  if (steps_ % kSlowSteps == 0) {
    MoveSlip();
    if (!contact_) contact_ = scene_->clearance.FindContact(drive_.motion().X_MB);
  }
  drive_.Step(time_, time_step(), slip_);
  const Pose3 X_next = LeaningPose(drive_.motion());
  physics_->SetMotion(robot_body_, BodyMotion(X_MB_, X_next));
  physics_->Step();
  X_MB_ = X_next;
  ++steps_;
  time_ = steps_ * time_step();
  NoteDisturbances();
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

void RobotSimulator::UpdateGhosts(const Pose2& X_MB, double elapsed) {
  while (!ghosts_.empty() && ghosts_.front().until <= time_) ghosts_.pop_front();
  const double chance = 1.0 - std::exp(-variation_.ghost_rate * elapsed);
  if (variation_.ghost_rate == 0.0 || !ghost_rng_.Bernoulli(chance)) return;
  const double distance = ghost_rng_.Uniform(0.8, 2.5), bearing = ghost_rng_.Uniform(-1.0, 1.0);
  const Pose2 X_MG = X_MB * Pose2{distance * std::cos(bearing), distance * std::sin(bearing), 0.0};
  const double h = kGhostSize / 2;
  ghosts_.push_back(
      {geometry::Transformed(X_MG, {{-h, -h}, {h, -h}, {h, h}, {-h, h}}), time_ + kGhostLifetime});
}

robot::Observation RobotSimulator::Observe(double action_start) {
  const BaseMotion& motion = drive_.motion();
  robot::Observation observation;
  observation.time = time_ - action_start;
  const Pose2 noise{sense_rng_.Normal(0.0, variation_.localisation_noise),
                    sense_rng_.Normal(0.0, variation_.localisation_noise),
                    sense_rng_.Normal(0.0, variation_.localisation_noise_yaw)};
  observation.X_MB = motion.X_MB * variation_.localisation_bias * noise;
  observation.V_B = motion.V_B;
  UpdateGhosts(motion.X_MB, time_ - last_observation_);
  last_observation_ = time_;
  for (const Ghost& ghost : ghosts_) observation.obstacles_M.push_back(ghost.outline_M);
  return observation;
}

geometry::Pose3 RobotSimulator::X_MB() const { return X_MB_; }

geometry::Pose3 RobotSimulator::PoseOf(int object) const {
  if (object_bodies_[object] < 0) return X_MB_ * X_BO_start_[object];
  return physics_->GetState(object_bodies_[object]).X_WB;
}

world::WorldState RobotSimulator::GetWorldState() const {
  world::WorldState state;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    world::ObjectState object = objects_[i];
    object.X_MO = PoseOf(static_cast<int>(i));
    if (object_bodies_[i] >= 0) object.V_MO = physics_->GetState(object_bodies_[i]).V_WB;
    state.objects.push_back(std::move(object));
  }
  return state;
}

robot::RobotState RobotSimulator::GetRobotState() const {
  return {drive_.motion().X_MB, drive_.motion().V_B, scene_->robot.profile.joints};
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
               ghost_rng_, last_observation_, ghosts_, contact_, disturbances_});
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
}

}  // namespace hires::simulation
