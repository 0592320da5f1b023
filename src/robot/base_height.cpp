#include "robot/base_height.h"

#include <cmath>
#include <utility>

#include "hires/geometry/pose.h"
#include "hires/robot/link_bounds.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

constexpr char kOnFloor[] = "base_footprint";  // REP-120

/// A root that carries the whole robot, at a pose in the frame of the root of before.
void PutRootBelow(const Pose3& X_RF, const std::string& name, RobotModel* model) {
  for (Link& link : model->links)
    if (link.joint) ++link.joint->parent;
  Joint joint;
  joint.name = name + "_joint";
  joint.parent = 0;
  joint.X_PJ = X_RF.Inverse();
  model->links.front().joint = std::move(joint);
  Link root;
  root.name = name;
  model->links.insert(model->links.begin(), std::move(root));
}

}  // namespace

double LowestShape(const std::vector<geometry::Aabb>& bounds) {
  geometry::Aabb all;
  for (const geometry::Aabb& of_one : bounds) all.Include(of_one);
  const bool has_any = all.lower.z() <= all.upper.z();
  return has_any ? all.lower.z() : 0.0;
}

void StandOnFloor(Robot* robot) {
  const double lowest = LowestShape(LinkBounds(*robot));
  if (lowest >= -kFloorSlack) return;
  const std::vector<Pose3> X_R = ForwardKinematics(robot->model, robot->profile.joints);
  const Pose3& X_RB = X_R[*robot->model.FindLink(robot->profile.base_link)];
  robot->base_height = -lowest;
  std::string name = kOnFloor;
  if (const auto known = robot->model.FindLink(name)) {
    const double z_BK = (X_RB.Inverse() * X_R[*known]).translation.z();
    if (std::abs(z_BK - lowest) <= kFloorSlack) {
      robot->profile.base_link = name;
      return;
    }
    name = robot->profile.base_link + "_on_floor";
  }
  const Pose3 X_BF{{0.0, 0.0, lowest}, Eigen::Quaterniond::Identity()};
  PutRootBelow(X_RB * X_BF, name, &robot->model);
  robot->profile.base_link = name;
}

}  // namespace hires::robot
