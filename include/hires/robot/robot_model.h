#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/inertia.h"
#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::robot {

enum class JointType { kFixed, kRevolute, kContinuous, kPrismatic };

struct JointLimits {
  double lower{0.0};  ///< [rad] or [m]; not used by continuous joints
  double upper{0.0};
  double velocity{0.0};  ///< [rad/s] or [m/s]
  double effort{0.0};    ///< [N m] or [N]
};

/// The joint that carries a link; the root link has none.
struct Joint {
  std::string name;
  JointType type{JointType::kFixed};
  int parent{-1};                                  ///< index of the parent link
  geometry::Pose3 X_PJ;                            ///< joint frame in the parent link at position 0
  Eigen::Vector3d axis{Eigen::Vector3d::UnitX()};  ///< unit vector in the joint frame
  std::optional<JointLimits> limits;
  std::string mimics;  ///< name of the joint that this one follows, or empty
  double mimic_multiplier{1.0};
  double mimic_offset{0.0};
};

struct Link {
  std::string name;
  std::optional<Joint> joint;  ///< empty for the root link
  std::optional<geometry::MassProperties> inertial;
  std::vector<geometry::Collision> collisions;
};

/// Joint name -> position [rad] or [m]; joints that are not named stand at 0, or at the nearest
/// limit to 0.
using JointPositions = std::map<std::string, double>;

/// What a URDF file says about a robot; constant after loading. Links are sorted so that parents
/// come before children, link 0 is the root.
struct RobotModel {
  std::string name;
  std::vector<Link> links;
  std::uint64_t hash{0};               ///< of everything above, independent of the file's layout
  std::vector<std::string> plugins{};  ///< of a simulator: their files

  std::optional<int> FindLink(const std::string& name) const;
  std::vector<std::string> LinkNames() const;
  std::vector<std::string> JointNames() const;  ///< movable ones that mimic no other
};

/// Whether any link has a collision shape.
bool HasShapes(const RobotModel& model);
/// The joint of that name, or nullptr.
const Joint* FindJoint(const RobotModel& model, const std::string& name);
/// Index of the link that the joint of that name carries.
std::optional<int> FindLinkOf(const RobotModel& model, const std::string& joint);
/// Whether `link` is `above` itself or carried by it, whatever joints lie between. Indices.
bool IsBelow(const RobotModel& model, int link, int above);

/// Reads a URDF. Collision meshes (package:// by ROS_PACKAGE_PATH or a folder above the file,
/// model:// as worlds have it, file://, or relative to the file) are loaded; a missing one is an
/// error. Friction comes from `<gazebo reference="link">` (mu1, mu2) and the link's `<contact>`
/// (lateral_friction), the smallest of them; 1 where there is none, 1000 for an infinite or a
/// negative one.
/// A mass that is not positive, inertias that are not positive definite and what is no number leave
/// their `inertial` out; principal moments that break the triangle inequality, as invented ones of
/// tiny frames do, are kept. One warning names the links of both. Joints that float are fixed,
/// those that need limits and have none are held at 0; limits in the wrong order are swapped, and
/// joints without an axis or that follow nothing that moves are fixed: each kind with a warning.
/// Joints that follow one that follows another name the one that leads.
/// @throws base::ConfigError with all that is wrong: file, element, line and remedy.
RobotModel LoadRobotModel(const std::string& urdf_path);
/// The same for text; `where` is the file's path in messages and for relative meshes.
RobotModel ParseRobotModel(const std::string& urdf_xml, const std::string& where);

/// Pose of every link in the root link's frame, in the order of `model.links`.
/// @throws base::ConfigError for a joint that is unknown, fixed or mimics another (set the one that
/// leads), or for a position outside the limits of a joint (slack 1e-6); one that follows it stops
/// at its own limits.
std::vector<geometry::Pose3> ForwardKinematics(const RobotModel& model,
                                               const JointPositions& positions);

/// All collision shapes of the robot as one rigid body in the root frame, its joints frozen.
/// A collision is named "link" or "link/collision"; "link/1", "link/2" where several have no name.
/// @throws base::ConfigError as ForwardKinematics.
std::vector<geometry::Collision> FrozenCollisions(const RobotModel& model,
                                                  const JointPositions& positions);

}  // namespace hires::robot
