#include "hires/perception/camera_view.h"

#include <cmath>

#include "hires/base/check.h"
#include "hires/perception/pinhole_camera.h"

namespace hires::perception {

bool CameraView::Contains(const Eigen::Vector3d& p_M) const {
  const Eigen::Vector3d p_C = X_MC.Inverse() * p_M;
  if (p_C.x() <= 0.0) return false;
  const double range = p_C.norm();
  if (range < min_range || range > max_range) return false;
  return std::abs(std::atan2(p_C.y(), p_C.x())) <= width / 2 &&
         std::abs(std::atan2(p_C.z(), p_C.x())) <= height / 2;
}

CameraView ViewOf(const robot::Robot& robot, const geometry::Pose2& X_MB,
                  const robot::JointPositions& posture) {
  HIRES_CHECK(robot.profile.upper_body, "robot '" + robot.model.name + "' has no camera");
  return ViewFrom(robot, X_MLink(robot, X_MB, posture, robot.profile.upper_body->camera_link));
}

geometry::Pose3 X_MLink(const robot::Robot& robot, const geometry::Pose2& X_MB,
                        const robot::JointPositions& posture, const std::string& link) {
  const auto wanted = robot.model.FindLink(link);
  const auto base = robot.model.FindLink(robot.profile.base_link);
  HIRES_CHECK(wanted && base, "robot '" + robot.model.name + "' lacks '" + link + "' or its base");
  const auto X_RL = robot::ForwardKinematics(robot.model, posture);
  return geometry::Lift(X_MB) * X_RL[*base].Inverse() * X_RL[*wanted];
}

CameraView ViewFrom(const robot::Robot& robot, const geometry::Pose3& X_MC) {
  HIRES_CHECK(robot.profile.upper_body, "robot '" + robot.model.name + "' has no camera");
  const robot::UpperBodyProfile& body = *robot.profile.upper_body;
  return {X_MC, body.camera_width, body.camera_height, body.camera_min_range,
          body.camera_max_range};
}

std::optional<std::string> FindOpticalLink(const robot::RobotModel& model,
                                           const std::string& link) {
  constexpr double kSame = 1e-4;  // [m] or [rad]: as well as URDFs write a right angle
  const std::optional<int> camera = model.FindLink(link);
  const geometry::Pose3 X_CO = OpticalFrame();
  for (const robot::Link& child : model.links) {
    if (!camera || !child.joint || child.joint->parent != *camera ||
        child.joint->type != robot::JointType::kFixed) {
      continue;
    }
    const geometry::Pose3& X_CL = child.joint->X_PJ;
    if (X_CL.translation.norm() < kSame && X_CL.rotation.angularDistance(X_CO.rotation) < kSame) {
      return child.name;
    }
  }
  return std::nullopt;
}

void AddShapesOf(const robot::Link& link, const geometry::Pose3& X_FL,
                 std::vector<geometry::Collision>* shapes_F) {
  for (const geometry::Collision& collision_L : link.collisions) {
    geometry::Collision& collision_F = shapes_F->emplace_back(collision_L);
    collision_F.name = link.name;
    collision_F.X_BS = X_FL * collision_L.X_BS;
  }
}

std::vector<geometry::Collision> ShapesOf(const robot::Robot& robot, const geometry::Pose2& X_MB,
                                          const robot::JointPositions& posture) {
  const auto base = robot.model.FindLink(robot.profile.base_link);
  HIRES_CHECK(base, "robot '" + robot.model.name + "' lacks its base link");
  const auto X_RL = robot::ForwardKinematics(robot.model, posture);
  const geometry::Pose3 X_MR = geometry::Lift(X_MB) * X_RL[*base].Inverse();
  std::vector<geometry::Collision> shapes_M;
  for (std::size_t link = 0; link < X_RL.size(); ++link)
    AddShapesOf(robot.model.links[link], X_MR * X_RL[link], &shapes_M);
  return shapes_M;
}

}  // namespace hires::perception
