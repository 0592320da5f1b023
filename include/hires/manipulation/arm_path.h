#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hires/manipulation/arm_kinematics.h"
#include "hires/manipulation/collision_scene.h"
#include "hires/robot/trajectory.h"

namespace hires::manipulation {

enum class ArmPathStatus { kFound, kStartBlocked, kGoalBlocked, kUnreachable, kNoPath };

struct ArmPathParams {
  int max_iterations{3000};  ///< of the planner: no clock decides, so that results repeat
  double resolution{0.05};   ///< [rad] largest joint step between two collision checks, > 0
  int max_simplifications{100};
  /// [rad] of a held object's axis, all along the way. What a hand holds cannot fall: this keeps
  /// its content in it.
  double max_held_tilt{0.5};
  int max_goals{8};  ///< free goals that the planner grows trees from
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

/// What keeps an arm from being somewhere. Valid from birth as "nothing".
struct Obstruction {
  std::vector<std::string> parts;  ///< the two that touch; empty: it is no touch
  std::string words;  ///< for people: "r_forearm_link touches table1", "held object tilts"

  explicit operator bool() const { return !words.empty(); }
};

struct ArmPathResult {
  ArmPathStatus status{ArmPathStatus::kNoPath};
  Obstruction obstruction;      ///< where something is in the way
  std::vector<ArmJoints> path;  ///< from start to goal, straight in joint space between points
};

/// A collision-free path to one of `goals`: the first to which the straight way is free, else one
/// that OMPL's RRT-Connect reaches among the first `max_goals` free ones; then simplified, and its
/// corners rounded where there is room. Only what the arm moves is looked at: that the base stands
/// close to a table leg blocks no arm. The same arguments and seed give the same path in any
/// process, whatever was planned before.
/// `obstruction` is in the way of the start, of the first goal if all are blocked, or, without a
/// path, of the straight way to the first free goal. A held object that tilts too far is one.
/// @pre resolution > 0; goals have one value per joint.
ArmPathResult PlanArmPath(const ArmScene& arm, const std::vector<ArmJoints>& goals,
                          std::uint64_t seed, const ArmPathParams& params = {});

/// The tool straight from where it is to X_BT, turning on the way: for the last stretch to an
/// object and back. Found only if the whole way is reachable without a jump of the joints
/// (kUnreachable else), and free (kStartBlocked, kGoalBlocked, kNoPath else).
/// @param step  [m] of the tool between two points of the path, and a tenth of it in rad, > 0.
ArmPathResult PlanStraight(const ArmScene& arm, const geometry::Pose3& X_BT, double step = 0.01,
                           const ArmPathParams& params = {});

/// Times along a path: every joint within its velocity limit (URDF) and acceleration limit
/// (UpperBodyProfile). Corners are rounded by at most 0.005 rad per joint and driven through as
/// fast as the limits allow, so that only both ends and reversals are stops. Time-optimal for that
/// path up to its discretisation, by the two sweeps of [Pham and Pham 2018, IEEE Trans. Robotics
/// 34:645-659]. Points have velocities, are at most `period` [s] apart, and lie closer where the
/// acceleration changes. A path whose points are all equal gives one point at time 0.
/// @param speed  share of the velocity limits that is used, in (0, 1]; accelerations take its
/// square, so that half the speed takes twice the time.
/// @throws base::ConfigError for a joint that the robot lacks or that has no velocity limit.
/// @pre path is not empty, one value per joint in every point.
robot::JointTrajectory TimePath(const robot::Robot& robot, const std::vector<std::string>& joints,
                                const std::vector<std::vector<double>>& path, double speed = 1.0,
                                double period = 0.05);

}  // namespace hires::manipulation
