// Private to this layer: what a simulator's start must satisfy. Refuse... throw base::ConfigError.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/shape.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/scene.h"
#include "hires/world/world.h"

namespace hires::simulation {

constexpr double kRestingGap = 0.06;  ///< [m] an object this far above the tray falls onto it

/// Whether it stands where the world's file has it.
bool IsOfWorld(const world::ObjectState& object, const world::World& world);

/// A shape that something starts inside of.
struct Inside {
  std::string part;   ///< name of that shape
  double depth{0.0};  ///< [m] by which both heights overlap
  double sunk{0.0};   ///< [m] from the lowest point of what is inside up to the top of the shape
};
/// The one of the robot's shapes that the object reaches into deepest, as Overlap judges.
std::optional<Inside> FindInside(const std::vector<geometry::Collision>& object,
                                 const geometry::Pose3& X_MO,
                                 const std::vector<geometry::Collision>& robot_B,
                                 const geometry::Pose3& X_MB);

/// Which object is inside of which part, how deep, and what is the likely cause. What stands where
/// the world's file has it is not to blame: the robot begins there.
std::string WhyInsideRobot(const world::ObjectState& object, const Scene& scene,
                           const geometry::Pose3& X_MB, const Inside& inside);

/// Does the object's lowest point lie on top of one of the robot's shapes? Its origin, or the
/// middle of its outline, is over that shape.
bool StandsOn(const std::vector<geometry::Collision>& robot_B,
              const std::vector<geometry::Collision>& object, const geometry::Pose3& X_BO);

void RefusePose(const std::string& what, const geometry::Pose3& X);
/// Pose and velocity.
void RefuseObject(const world::ObjectState& object);
void RefuseUnknownHolder(const world::ObjectState& object, const robot::RobotModel& robot);
/// A joint's name that is not the robot's means that another robot is spoken of.
void RefuseUnknownJoints(const robot::JointPositions& joints, const robot::RobotModel& robot);
/// A base whose loop or leaning would diverge at this time step.
void RefuseStiff(const robot::BaseControllerParams& params, double time_step);
/// A base laser that does not scan in the plane of the base, nor upside down in it.
void RefuseTiltedLaser(const robot::Robot& robot);
/// Two objects of one name.
void RefuseSameNames(const std::vector<world::ObjectState>& objects);
/// Who starts inside of whom; "" if none does. Who was put there is to blame, of two the later one.
std::string WhyInOther(const world::ObjectState& object, const world::ObjectState& earlier,
                       const world::World& world);
/// The same of an object in what never moves.
std::string WhyInStatics(const world::ObjectState& object, const world::World& world);

}  // namespace hires::simulation
