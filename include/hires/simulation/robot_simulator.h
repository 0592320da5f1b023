#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/physics/physics_world.h"
#include "hires/robot/observation.h"
#include "hires/simulation/base_drive.h"
#include "hires/simulation/floor_profile.h"
#include "hires/simulation/scene.h"
#include "hires/simulation/variation.h"
#include "hires/world/world.h"

namespace hires::simulation {

/// What happened to the robot that may disturb its load; the latest time of each [s].
struct Disturbances {
  double late_command{-1e9};  ///< the base braked because no command came in time
  double braking{-1e9};       ///< more than half of the largest acceleration, against the motion
  double accelerating{-1e9};  ///< ... with the motion
  double turning{-1e9};       ///< angular acceleration above half of the largest
};

/// How much of the robot moves.
enum class LevelOfDetail {
  kTray,    ///< the base with its controller; joints are frozen as the robot state has them
  kPlanar,  ///< also torso, head, arms and grippers, within the limits of their joints
};

/// The PR2 (or any robot) with its tray in one steppable world: the base is a driven body with the
/// behaviour of its controller, objects are loose.
/// One instance belongs to one thread at a time. The same calls give the same bits.
class RobotSimulator {
 public:
  /// @throws base::ConfigError if an object's model is unknown to the world or the link that holds
  /// it to the robot, the robot or an object starts inside a static body or has a pose or velocity
  /// that is not finite, or the base's loop or leaning is too stiff for the time step.
  RobotSimulator(std::shared_ptr<const Scene> scene, const Variation& variation,
                const world::WorldState& world_state, const robot::RobotState& robot_state,
                base::Rng rng, const physics::PhysicsParams& params = {});

  /// Takes over a skill's wishes; no base velocity means that no command is sent.
  void Send(const robot::Command& command);
  void Step();  ///< advances by time_step()

  double time() const { return time_; }  ///< [s] since construction
  double time_step() const { return physics_->params().time_step; }

  /// What the robot believes and sees; draws sensor noise. `time` counts from `action_start`.
  robot::Observation Observe(double action_start);

  const BaseMotion& base() const { return drive_.motion(); }
  geometry::Pose3 X_MB() const;             ///< of the base, leaning and floor included
  world::WorldState GetWorldState() const;  ///< loose objects now
  robot::RobotState GetRobotState() const;
  geometry::Pose3 PoseOf(int object) const;  ///< of the loose object with that index

  /// Indices of the objects that stood on a part of the robot at the start.
  const std::vector<int>& carried() const { return carried_; }
  /// Puts an object upright back to where it stood on the robot at the start, moving with it.
  void PutBack(int object);

  /// The robot touches a static body; checked every 10 ms.
  const std::optional<RobotContact>& contact() const { return contact_; }
  const Disturbances& disturbances() const { return disturbances_; }
  const Scene& scene() const { return *scene_; }

  /// All that changes about the simulator. Restoring it in a simulator that was built from the same
  /// scene, variation, objects and seed continues with the same bits.
  struct Snapshot;
  std::shared_ptr<const Snapshot> Save();
  void Restore(const Snapshot& snapshot);

 private:
  struct Ghost {
    geometry::Polygon outline_M;
    double until{0.0};
  };
  void AddRobot();
  void AddObjects(const world::WorldState& state);
  geometry::Pose3 LeaningPose(const BaseMotion& motion) const;
  physics::BodyState BodyMotion(const geometry::Pose3& X_now, const geometry::Pose3& X_next) const;
  void NoteDisturbances();
  void MoveSlip();
  void UpdateGhosts(const geometry::Pose2& X_MB, double elapsed);
  void RefuseBadStart(const world::WorldState& state) const;
  void RefuseTogether(const world::ObjectState& object,
                      const std::vector<geometry::Collision>& shapes,
                      const world::ObjectState& earlier) const;

  std::shared_ptr<const Scene> scene_;
  Variation variation_;
  FloorProfile floor_;
  std::unique_ptr<physics::PhysicsWorld> physics_;
  physics::BodyId robot_body_{0};
  std::vector<physics::BodyId> object_bodies_;
  std::vector<world::ObjectState> objects_;  // names and models; poses as at the start
  std::vector<geometry::Pose3> X_BO_start_;  // objects in the base frame at the start
  std::vector<int> carried_;

  double time_{0.0};
  long steps_{0};
  BaseDrive drive_;
  geometry::Pose3 X_MB_;  // leaning pose at time_
  double slip_{0.0};
  base::Rng slip_rng_, sense_rng_, ghost_rng_;
  double last_observation_{0.0};
  std::deque<Ghost> ghosts_;
  std::optional<RobotContact> contact_;
  Disturbances disturbances_;
};

}  // namespace hires::simulation
