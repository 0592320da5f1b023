#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hires/manipulation/arm_kinematics.h"
#include "hires/manipulation/collision_scene.h"
#include "hires/robot/trajectory.h"

namespace hires::manipulation {

enum class ArmPathStatus { kFound, kStartBlocked, kGoalBlocked, kUnreachable, kNoPath };
std::string ToString(ArmPathStatus status);  ///< "found", "start_blocked", "no_path", ...

struct ArmPathParams {
  int max_iterations{3000};  ///< of the planner: no clock decides, so that results repeat
  double resolution{0.05};   ///< [rad] largest joint step between two collision checks
  int max_simplifications{100};
  double max_held_tilt{0.5};  ///< [rad] of a held object's axis, all along the way
};

/// What a motion of one arm begins with and has to keep clear of.
struct ArmScene {
  const ArmKinematics* kinematics;
  const CollisionScene* scene;
  geometry::Pose2 X_MB;
  robot::JointPositions posture;  ///< all joints now, those of the arm included
  /// Axis in the tool frame that has to stay upright (a held object's z axis); empty: none held.
  std::optional<Eigen::Vector3d> upright_T;
};

struct ArmPathResult {
  ArmPathStatus status{ArmPathStatus::kNoPath};
  std::string touch;            ///< "r_forearm_link touches table1" where something is in the way
  std::vector<ArmJoints> path;  ///< from start to goal, straight in joint space between points
};

/// A collision-free path to one of `goals` (the first that is free and can be reached), by OMPL's
/// RRT-Connect, simplified. The straight way is tried first. The same arguments and seed give the
/// same path in any process.
ArmPathResult PlanArmPath(const ArmScene& arm, const std::vector<ArmJoints>& goals,
                          std::uint64_t seed, const ArmPathParams& params = {});

/// The tool straight from where it is to X_BT, turning on the way: for the last stretch to an
/// object and back. Found only if the whole way is reachable without a jump of the joints, and
/// free.
ArmPathResult PlanStraight(const ArmScene& arm, const geometry::Pose3& X_BT, double step = 0.01);

/// Times along a path: every joint within its velocity and acceleration limit, stopping only at
/// both ends and at sharp corners; points at most `period` [s] apart.
/// @param speed  share of the limits that is used, in (0, 1].
robot::JointTrajectory TimePath(const robot::Robot& robot, const std::vector<std::string>& joints,
                                const std::vector<std::vector<double>>& path, double speed = 1.0,
                                double period = 0.05);

}  // namespace hires::manipulation
