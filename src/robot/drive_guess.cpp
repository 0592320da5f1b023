#include "robot/drive_guess.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "hires/base/text.h"

namespace hires::robot {
namespace {

constexpr double kHorizontal = 0.1;  // largest upward part of a wheel's axis
constexpr double kParallel = 0.99;   // least cosine between two axes

struct Wheels {
  std::vector<std::string> fixed;     // joints that keep their direction
  std::vector<Eigen::Vector3d> axes;  // of those, in the root frame
  std::vector<std::string> casters;
};

/// Whether something below the root turns the wheel's axle about the vertical.
bool IsSteered(const RobotModel& model, const std::vector<geometry::Pose3>& X_R, int link) {
  for (int above = link; model.links[above].joint; above = model.links[above].joint->parent) {
    const Joint& joint = *model.links[above].joint;
    const bool can_turn =
        joint.type == JointType::kContinuous || joint.type == JointType::kRevolute;
    if (can_turn && std::abs((X_R[above].rotation * joint.axis).z()) > 1.0 - kHorizontal)
      return true;
  }
  return false;
}

Wheels WheelsOf(const RobotModel& model) {
  const std::vector<geometry::Pose3> X_R = ForwardKinematics(model, {});
  Wheels wheels;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto& joint = model.links[i].joint;
    if (!joint || joint->type != JointType::kContinuous) continue;
    const Eigen::Vector3d axis = X_R[i].rotation * joint->axis;
    if (std::abs(axis.z()) > kHorizontal) continue;
    if (IsSteered(model, X_R, static_cast<int>(i))) {
      wheels.casters.push_back(joint->name);
    } else {
      wheels.fixed.push_back(joint->name);
      wheels.axes.push_back(axis);
    }
  }
  return wheels;
}

/// Two wheels with the same axle direction, or nothing.
std::optional<std::pair<std::size_t, std::size_t>> ParallelPair(const Wheels& wheels) {
  for (std::size_t i = 0; i < wheels.axes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(wheels.axes[i].dot(wheels.axes[j])) > kParallel) return std::make_pair(j, i);
    }
  }
  return std::nullopt;
}

}  // namespace

std::string ToString(Drive drive) {
  return drive == Drive::kDifferential ? "differential" : "omnidirectional";
}

DriveGuess GuessDrive(const RobotModel& model) {
  const Wheels wheels = WheelsOf(model);
  if (const auto pair = ParallelPair(wheels)) {
    return {Drive::kDifferential, fmt::format("parallel wheels: {}, {}", wheels.fixed[pair->first],
                                              wheels.fixed[pair->second])};
  }
  if (wheels.fixed.size() >= 3) {
    return {Drive::kOmnidirectional,
            "three wheels in three directions: " + base::Join(wheels.fixed, ", ")};
  }
  if (wheels.fixed.empty() && wheels.casters.size() >= 3) {
    return {Drive::kOmnidirectional, "steered casters alone: " + base::Join(wheels.casters, ", ")};
  }
  return {Drive::kDifferential, "no wheels (continuous joints) that could drive it sideways"};
}

}  // namespace hires::robot
