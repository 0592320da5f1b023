#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"

namespace hires::translation {

constexpr char kUnnamedArmPosture[] = "armunnamedposture";
constexpr char kUnnamedTorsoPosture[] = "torsoposture";

/// The robot's links in the map.
class Body {
 public:
  /// @throws base::ConfigError as robot::ForwardKinematics.
  Body(const robot::Robot& robot, const robot::RobotState& state);
  /// @throws base::ConfigError for a link that the robot does not have.
  geometry::Pose3 X_ML(const std::string& link) const;

 private:
  const robot::RobotModel* model_;
  geometry::Pose3 X_MR_;
  std::vector<geometry::Pose3> X_RL_;
};

/// How far off a posture may be: sum of the distances of the arm's joints [rad].
struct PostureParams {
  double tucked{0.1}, others{0.3};
  std::string before;      ///< lower case: its tolerance is wider ...
  double hysteresis{1.2};  ///< ... by this factor
};
/// The nearest posture within tolerance, of all its variants; else kUnnamedArmPosture.
std::string NameArmPosture(const robot::Robot& robot, const robot::ArmProfile& arm,
                           const robot::JointPositions& joints, const PostureParams& params);

/// Joints of the arm for a posture's name; nothing if there is no such posture.
std::optional<std::vector<double>> ArmJointsFor(const robot::Robot& robot,
                                                const robot::ArmProfile& arm,
                                                const std::string& posture, bool holds);
/// [m] likewise.
std::optional<double> TorsoHeightFor(const robot::UpperBodyProfile& body,
                                     const std::string& posture);

}  // namespace hires::translation
