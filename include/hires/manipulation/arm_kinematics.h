#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_profile.h"

namespace hires::manipulation {

using ArmJoints = std::vector<double>;  ///< [rad], in the order of ArmProfile::joints

struct InverseParams {
  int max_tries{40};        ///< starts of the iteration; the first is the given seed posture
  int max_iterations{100};  ///< of each
  double position_tolerance{1e-4};  ///< [m]
  double angle_tolerance{1e-3};     ///< [rad]
};

/// An arm from the torso to its tool, on KDL. Constant after building; Solve may be called from
/// several threads at once.
class ArmKinematics {
 public:
  /// @throws base::ConfigError if the robot has no such arm, or its joints are no chain.
  ArmKinematics(const robot::Robot& robot, const std::string& arm);
  ~ArmKinematics();
  ArmKinematics(ArmKinematics&&) noexcept;

  const std::string& arm() const;  ///< instance, lower case
  const std::vector<std::string>& joint_names() const;
  /// Limits per joint [rad]; a continuous joint has -infinity and infinity.
  const ArmJoints& lower() const;
  const ArmJoints& upper() const;

  /// Tool in the base frame, the other joints as in `posture`.
  /// @throws base::ConfigError for a joint in `posture` that the robot lacks.
  /// @pre one value per joint.
  geometry::Pose3 ToolPose(const robot::JointPositions& posture, const ArmJoints& joints) const;

  /// All different joint positions found that bring the tool to X_BT, within the limits, the one
  /// nearest to `near` first (largest joint difference); continuous joints lie within half a turn
  /// of `near`. An arm of seven joints has a whole curve of solutions, of which each try finds one.
  /// Levenberg and Marquardt's iteration with the damping of [Sugihara 2011, IEEE Trans. Robotics
  /// 27:984-991], joints at a limit held there. Deterministic: the starts of the iterations are
  /// drawn from `seed`. Empty: unreachable as far as was tried.
  std::vector<ArmJoints> Solve(const robot::JointPositions& posture, const geometry::Pose3& X_BT,
                               const ArmJoints& near, std::uint64_t seed,
                               const InverseParams& params = {}) const;

  /// This arm's part of a posture; joints that it does not name stand at the nearest limit to 0.
  ArmJoints JointsOf(const robot::JointPositions& posture) const;
  void SetJoints(const ArmJoints& joints, robot::JointPositions* posture) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::manipulation
