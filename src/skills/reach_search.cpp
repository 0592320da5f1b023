#include "skills/reach_search.h"

#include <cmath>

#include "hires/base/text.h"
#include "hires/robot/posture.h"

namespace hires::skills {
namespace {

constexpr double kLeastLevel = 0.3;  // horizontal share of an axis that has a heading

}  // namespace

world::ObjectState* FindObject(std::vector<world::ObjectState>* objects, const std::string& name) {
  for (world::ObjectState& object : *objects) {
    if (base::ToLower(object.name) == base::ToLower(name)) return &object;
  }
  return nullptr;
}

geometry::Pose3 Raised(geometry::Pose3 X_WT, double height) {
  X_WT.translation.z() += height;
  return X_WT;
}

geometry::Pose3 DrawnBack(const geometry::Pose3& X_WT, double distance) {
  geometry::Pose3 X_TBack;
  X_TBack.translation.x() = -distance;
  return X_WT * X_TBack;
}

Eigen::Vector3d ShoulderOf(const ManipulationContext& context, const std::string& arm,
                           const robot::Observation& observation) {
  const robot::RobotModel& model = context.robot->model;
  const int link = *robot::FindLinkOf(model, context.arm(arm).joints.front());
  return LinkPose(*context.robot, observation.X_MB, PostureOf(*context.robot, observation.joints),
                  model.links[static_cast<std::size_t>(link)].name)
      .translation;
}

double HeadingOf(const Eigen::Quaterniond& R_WT) {
  const Eigen::Vector3d x = R_WT * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d axis =
      x.head<2>().norm() >= kLeastLevel ? x : Eigen::Vector3d(R_WT * Eigen::Vector3d::UnitZ());
  return std::atan2(axis.y(), axis.x());
}

}  // namespace hires::skills
