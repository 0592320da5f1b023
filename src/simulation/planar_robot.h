#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/physics/physics_world.h"
#include "hires/robot/observation.h"
#include "hires/simulation/scene.h"
#include "simulation/hands.h"
#include "simulation/joint_drives.h"
#include "simulation/link_bodies.h"

namespace hires::simulation {

/// The motion of a body that goes from one pose to another within `dt` [s].
physics::BodyState MotionBetween(const geometry::Pose3& X_now, const geometry::Pose3& X_next,
                                 double dt);

/// A robot whose upper body moves, as driven bodies in a PhysicsWorld: each as its joints say, on a
/// base that goes where it is told.
class PlanarRobot {
 public:
  /// Adds its bodies to `physics`, which outlives it.
  /// @param joints  of all, gaps and finger angles included (robot::CompleteGrippers).
  /// @param objects  every loose object of the world.
  /// @param fixed_names  of the static bodies, by BodyId.
  /// @throws base::ConfigError as robot::ForwardKinematics.
  PlanarRobot(const Scene& scene, const robot::JointPositions& joints, const geometry::Pose3& X_MB,
              std::vector<GraspableObject> objects, std::vector<std::string> fixed_names,
              physics::PhysicsWorld* physics);

  /// Takes a hold of an object at the start: as a grasp if the link is a palm, else without end.
  /// A hand's gap becomes the one at which its fingers just touch the object, where there is one.
  void Attach(int object, const std::string& link, double friction);

  /// @throws base::ConfigError as JointDrives::Send and Hands::Send.
  void Send(const robot::Command& command, double time);
  /// Before a step of physics from `time` on, in which the base moves to X_MBnext.
  void Move(double time, const geometry::Pose3& X_MBnext);
  void React();  ///< after it

  robot::JointPositions Joints() const;
  robot::JointPositions JointVelocities() const;
  geometry::Pose3 X_MLink(const std::string& link) const;
  /// Whether the joints of the head move [rad/s] faster than `speed`.
  bool IsHeadFaster(double speed) const;

  /// Link that holds an object, or empty.
  std::string HolderOf(int object) const;
  std::map<std::string, int> Held() const;  ///< object by arm; hands that hold nothing are left out

  /// The base by RobotClearance, the rest by its exact shapes, and held objects that are blocked.
  /// @param object_name  tells an object's name by its index.
  std::optional<RobotContact> FindContact(const geometry::Pose2& X_MB,
                                          const std::vector<std::string>& object_names) const;

  std::vector<geometry::Collision> ShapesInMap() const;  ///< named by their links

  /// Name of a robot link by body, or empty.
  std::string LinkOfBody(physics::BodyId body) const;

  struct State {
    JointDrives drives;
    std::vector<Hand> hands;
    std::optional<Hands::Blocked> blocked;
    std::vector<geometry::Pose3> X_B, X_M;
    std::vector<bool> moves;
    std::vector<std::string> fixed_to;
  };
  State Save() const;
  void Restore(const State& state);

 private:
  std::vector<HandBodies> MakeHands() const;
  std::vector<double> MovingPositions() const;
  bool IsTouched(const HandBodies& hand, int object) const;
  void FitGap(int hand, int object);
  void PlaceAll(const geometry::Pose3& X_MB);
  void PlaceMoved();
  void MoveBody(std::size_t body, const geometry::Pose3& X_next);

  const Scene* scene_;
  physics::PhysicsWorld* physics_;
  robot::JointPositions frozen_;
  std::vector<GraspableObject> objects_;
  std::vector<std::string> fixed_names_;
  JointDrives drives_;
  LinkBodies links_;
  std::vector<physics::BodyId> body_ids_;  // by body of links_
  Hands hands_;
  std::vector<geometry::Pose3> X_B_;   // of the bodies in the base frame
  std::vector<geometry::Pose3> X_M_;   // in the map
  std::vector<bool> moves_;            // in the last step
  std::vector<std::string> fixed_to_;  // by object: link that holds it without a hand

  // What X_B_ and X_M_ were made of: what has not moved since need not be placed again, and most
  // does not most of the time. Empty: not known.
  std::vector<double> placed_positions_;
  std::optional<geometry::Pose3> placed_X_MB_;
  std::vector<bool> moved_;  // scratch: which bodies moved within the robot
};

}  // namespace hires::simulation
