#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/physics/physics_world.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/robot_clearance.h"
#include "simulation/joint_drives.h"

namespace hires::simulation {

/// One of the loose objects that hands may hold.
struct GraspableObject {
  physics::BodyId body{-1};
  double mass{0.0};                                 ///< [kg] true
  Eigen::Vector3d p_OOcm{Eigen::Vector3d::Zero()};  ///< [m] centre of mass in the object's frame
};

/// The bodies that make up one hand in a PhysicsWorld.
struct HandBodies {
  std::string arm;
  int gap_joint{-1};  ///< index in JointDrives
  physics::BodyId palm{-1};
  std::vector<physics::BodyId> left_fingers, right_fingers;
  std::vector<physics::BodyId> All() const;
};

/// What a hand is about. A value: copy it to save it.
struct Hand {
  std::optional<robot::GripperCommand> command;  ///< the latest one
  double force{0.0};                             ///< [N] with which it closes
  int object{-1};                                ///< index of what it holds
  double friction{0.0};                          ///< between fingers and object
  double yielded{0.0};                           ///< [m] that the object was pushed in the grip
  bool has_slipped{false};                       ///< lost what it held; waits for another command
  std::optional<Eigen::Vector3d> v_MOcm;         ///< [m/s] of the held object one step ago
};

/// Closes and opens the hands of a robot and decides what they hold.
///
/// A hand that closes holds an object as soon as fingers of both sides touch it and the line
/// between both touches lies within both friction cones (two-finger force closure); nothing else
/// makes a grasp. What is held follows the palm. It is let go when the hand opens, and it slips
/// when its weight and acceleration need more than the fingers' friction: m |a - g| > 2 mu F.
///
/// What is held and pressed against something yields in the grip along the contact's normal, as
/// the arm's and the fingers' compliance let it; more than 0.015 m of that, and it is blocked.
/// (Shoulder lift of the PR2: 1200 N m/rad at 0.6 m make 0.015 m at 50 N, the grip's force.)
class Hands {
 public:
  Hands(std::vector<HandBodies> bodies, double max_force);

  /// @throws base::ConfigError for an unknown arm or numbers that are not finite.
  void Send(const std::string& arm, const robot::GripperCommand& command,
            const std::vector<GraspableObject>& objects, JointDrives* drives,
            physics::PhysicsWorld* physics);

  /// Holds an object from the start. @pre the hand holds nothing
  void Hold(int hand, int object, double friction, const std::vector<GraspableObject>& objects,
            physics::PhysicsWorld* physics);

  /// Looks at what the last step of physics did.
  void React(const std::vector<GraspableObject>& objects, JointDrives* drives,
             physics::PhysicsWorld* physics);

  const std::vector<HandBodies>& bodies() const { return bodies_; }
  const std::vector<Hand>& hands() const { return hands_; }
  void Restore(std::vector<Hand> hands) { hands_ = std::move(hands); }
  /// The hand that holds an object, or -1.
  int HolderOf(int object) const;
  /// The first hand whose object is blocked: by which body; or nothing.
  struct Blocked {
    int object{-1};
    physics::BodyId by{-1};
  };
  const std::optional<Blocked>& blocked() const { return blocked_; }
  void RestoreBlocked(std::optional<Blocked> blocked) { blocked_ = blocked; }

 private:
  void LetGo(int hand, const std::vector<GraspableObject>& objects, physics::PhysicsWorld* physics);
  void TryGrasp(int hand, const std::vector<GraspableObject>& objects, JointDrives* drives,
                physics::PhysicsWorld* physics);
  void Yield(int hand, const std::vector<GraspableObject>& objects, physics::PhysicsWorld* physics);
  void TrySlip(int hand, const std::vector<GraspableObject>& objects,
               physics::PhysicsWorld* physics);

  std::vector<HandBodies> bodies_;  // by hand
  double max_force_;
  std::vector<Hand> hands_;
  std::optional<Blocked> blocked_;
};

/// Whether two fingers hold what they touch: the line between the touches lies within both friction
/// cones. Normals point into the object.
bool IsForceClosure(const physics::Touch& left, const physics::Touch& right);

/// Largest acceleration [m/s^2], weight included, under which a grip of `force` [N] on both sides
/// keeps an object of `mass` [kg].
double HoldingAcceleration(double force, double friction, double mass);

}  // namespace hires::simulation
