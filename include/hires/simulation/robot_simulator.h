#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/physics/physics_world.h"
#include "hires/robot/observation.h"
#include "hires/simulation/base_drive.h"
#include "hires/simulation/disturbances.h"
#include "hires/simulation/robot_clearance.h"
#include "hires/simulation/scene.h"
#include "hires/simulation/variation.h"
#include "hires/world/world.h"

namespace hires::simulation {

class FrozenRobot;
class HeadCamera;
class LooseObjects;
class MovingBase;
class PlanarRobot;
class RobotSensors;
class SelfLocaliser;

/// How much of the robot moves.
enum class LevelOfDetail {
  kTray,    ///< the base with its controller; joints are frozen as the robot state has them
  kPlanar,  ///< also torso, head, arms and grippers, within the limits of their joints
};

/// The PR2 (or any robot) with its tray in one steppable world: the base is a driven body with the
/// behaviour of its controller, objects are loose; at level `planar` torso, head, arms and hands
/// are driven bodies too (JointDrives, Hands), and the camera on the head looks for objects twice a
/// second while the head is still.
/// One instance belongs to one thread at a time. The same calls give the same bits.
class RobotSimulator {
 public:
  /// What stands up to 5 mm deep in its support starts on it.
  /// @param robot_state  joints that it does not name are as in the driving posture.
  /// @throws base::ConfigError if an object's model is unknown to the world or the link that holds
  /// it to the robot, the robot or an object starts inside a static body or has a pose or velocity
  /// that is not finite, a joint is unknown or beyond its limits, the base's loop or leaning is too
  /// stiff for the time step, or the level is `planar` and the robot has no upper body.
  RobotSimulator(std::shared_ptr<const Scene> scene, const Variation& variation,
                 const world::WorldState& world_state, const robot::RobotState& robot_state,
                 base::Rng rng, const physics::PhysicsParams& params = {},
                 LevelOfDetail level = LevelOfDetail::kTray);
  ~RobotSimulator();

  /// Takes over a skill's wishes; no base velocity means that no command is sent. At level `tray`
  /// nothing but the base listens.
  /// @throws base::ConfigError as JointDrives::Send and Hands::Send.
  void Send(const robot::Command& command);
  /// What the robot knows of loose objects though it has not looked: imagination starts with what
  /// the Blackboard knows, a robot with nothing. In the map as the robot believes it. What its
  /// hands hold it knows by itself.
  void Remember(const std::vector<robot::SeenObject>& objects);
  /// Something pushes the base: BaseDrive::Push.
  void Push(const std::optional<geometry::Twist2>& acceleration);
  void Step();  ///< advances by time_step()

  double time() const { return state_.time; }  ///< [s] since construction
  double time_step() const { return physics_->params().time_step; }

  /// What the robot believes and sees; draws sensor noise. `time` counts from `action_start`.
  robot::Observation Observe(double action_start);

  /// Where the robot believes that it is, if it finds its place by itself; else null. As of the
  /// last Observe.
  const SelfLocaliser* self_localiser() const;
  /// The believed base in the true one as of the last Observe; nothing: it errs as drawn.
  std::optional<geometry::Pose2> place_error() const;
  /// Goes on believing what the robot believed in another simulator, from which it was lifted.
  /// @pre both or none find their place by themselves
  void BelieveAs(const RobotSimulator& before);

  const BaseMotion& base() const;
  geometry::Pose3 X_MB() const;             ///< of the base, leaning and floor included
  world::WorldState GetWorldState() const;  ///< loose objects now
  /// Joints with gaps and finger angles at level `planar`.
  robot::RobotState GetRobotState() const;
  geometry::Pose3 PoseOf(int object) const;       ///< of the loose object with that index
  geometry::Twist3 VelocityOf(int object) const;  ///< in map axes; 0 for one that is held rigidly
  std::string HolderOf(int object) const;         ///< link that holds it now, or empty
  /// It stands on, or up to 0.06 m above, a part of the robot that moves with its base.
  bool StandsOnRobot(int object) const;

  /// The first object that gained energy which nothing gave it (PhysicsWorld::broken): what is
  /// played from there on means nothing.
  std::optional<int> broken_object() const;

  /// Something touches it, or a hand holds it; as of the beginning of the last step.
  bool IsTouched(int object) const;
  /// The robot, what it carries or holds, or something that one of these has touched has touched it
  /// so far. What was not reached moved by its own weight alone.
  bool IsReached(int object) const;
  /// A ball, which stands however it is turned.
  bool IsBall(int object) const;

  /// Indices of the objects that stood on a part of the robot at the start.
  const std::vector<int>& carried() const;
  /// What the hands hold: object index by arm, hands that hold nothing left out.
  std::map<std::string, int> held() const;
  LevelOfDetail level() const { return planar_ ? LevelOfDetail::kPlanar : LevelOfDetail::kTray; }
  /// True pose of a link in the map. @throws base::ConfigError if there is no such link.
  geometry::Pose3 X_MLink(const std::string& link) const;
  /// Puts an object upright back to where it stood on the robot at the start, moving with it.
  /// @pre nothing holds it
  void PutBack(int object);

  /// The robot touches a static body; checked every 10 ms. At level `planar` also an object in a
  /// hand (then it is the `robot_part`) that cannot go where the hand goes.
  const std::optional<RobotContact>& contact() const { return state_.contact; }
  const Disturbances& disturbances() const;
  const Scene& scene() const { return *scene_; }

  /// All that changes about the simulator. Restoring it in a simulator that was built from the same
  /// scene, variation, objects and seed continues with the same bits.
  struct Snapshot;
  std::shared_ptr<const Snapshot> Save();
  void Restore(const Snapshot& snapshot);

 private:
  /// What changes beside what the parts keep themselves.
  struct State {
    double time{0.0};  // [s]
    long steps{0};
    std::optional<RobotContact> contact;
  };
  void AddObjects(const std::vector<world::ObjectState>& objects,
                  const geometry::Pose3& X_MBnominal, LevelOfDetail level);
  void AddObject(world::ObjectState object, geometry::Pose3 X_BO, LevelOfDetail level);
  void AddPlanarRobot();
  void AddCamera(const base::Rng& rng);
  void RefuseBadStart();
  std::string WhyInsideRobot(const world::ObjectState& object, physics::BodyId body,
                             const std::vector<physics::Touch>& touches) const;
  std::optional<RobotContact> FindContact() const;
  geometry::Pose2 Believed() const;  // base in the map, without the noise of what is drawn
  void Sense();
  void FindPlace();
  void Scan(base::Rng* noise, robot::Observation* observation);

  std::shared_ptr<const Scene> scene_;
  Variation variation_;
  std::unique_ptr<physics::PhysicsWorld> physics_;
  std::unique_ptr<MovingBase> base_;
  std::unique_ptr<FrozenRobot> frozen_;  // as at the start; at level `tray` always
  std::unique_ptr<LooseObjects> objects_;
  std::unique_ptr<PlanarRobot> planar_;  // null at level `tray`
  std::unique_ptr<RobotSensors> sensors_;
  std::unique_ptr<HeadCamera> camera_;  // null at level `tray`, or with nothing to look at
  State state_;
};

}  // namespace hires::simulation
