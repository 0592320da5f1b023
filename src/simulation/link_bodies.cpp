#include "simulation/link_bodies.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "robot/limit_stop.h"

namespace hires::simulation {

using geometry::Pose3;

LinkBodies::LinkBodies(const robot::Robot& robot, std::vector<std::string> moving,
                       const robot::JointPositions& posture)
    : moving_(std::move(moving)), links_(robot.model.LinkNames()) {
  const std::vector<Pose3> X_R = robot::ForwardKinematics(robot.model, posture);
  bodies_.push_back({robot.profile.base_link, {}, {}});
  mounts_.emplace_back();
  std::vector<Pose3> X_RBody{X_R[LinkIndex(robot.profile.base_link)]};
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const std::optional<robot::Joint>& joint = robot.model.links[i].joint;
    const int parent = joint ? body_of_[joint->parent] : 0;
    const int leader = joint ? FindMoving(*joint) : -1;
    if (leader >= 0) {
      mounts_.push_back({parent, X_RBody[parent].Inverse() * X_R[joint->parent] * joint->X_PJ,
                         joint->axis, joint->type == robot::JointType::kPrismatic, leader,
                         joint->mimic_multiplier, joint->mimic_offset});
      const bool stops =
          !joint->mimics.empty() && joint->limits && joint->type != robot::JointType::kContinuous;
      if (stops) mounts_.back().stops = joint->limits;
      bodies_.push_back({links_[i], {}, {}});
      X_RBody.push_back(X_R[i]);
    }
    body_of_.push_back(leader >= 0 ? static_cast<int>(bodies_.size()) - 1 : parent);
    bodies_[body_of_[i]].links.push_back(links_[i]);
    X_BodyLink_.push_back(X_RBody[body_of_[i]].Inverse() * X_R[i]);
  }
  AddShapes(robot.model, posture);
}

void LinkBodies::AddShapes(const robot::RobotModel& model, const robot::JointPositions& posture) {
  const std::vector<geometry::Collision> frozen = robot::FrozenCollisions(model, posture);
  auto named = frozen.begin();  // sorted by link
  for (std::size_t i = 0; i < links_.size(); ++i) {
    for (const geometry::Collision& shape : model.links[i].collisions) {
      bodies_[body_of_[i]].collisions.push_back(shape);
      bodies_[body_of_[i]].collisions.back().name = (named++)->name;
      bodies_[body_of_[i]].collisions.back().X_BS = X_BodyLink_[i] * shape.X_BS;
    }
  }
}

int LinkBodies::LinkIndex(const std::string& link) const {
  const auto found = std::find(links_.begin(), links_.end(), link);
  if (found == links_.end()) {
    throw base::ConfigError("robot: " + base::UnknownName("link", link, links_));
  }
  return static_cast<int>(found - links_.begin());
}

int LinkBodies::FindMoving(const robot::Joint& joint) const {
  const std::string& leader = joint.mimics.empty() ? joint.name : joint.mimics;
  const auto found = std::find(moving_.begin(), moving_.end(), leader);
  return found == moving_.end() ? -1 : static_cast<int>(found - moving_.begin());
}

int LinkBodies::BodyOf(const std::string& link) const { return body_of_[LinkIndex(link)]; }

const Pose3& LinkBodies::InBody(const std::string& link) const {
  return X_BodyLink_[LinkIndex(link)];
}

Pose3 LinkBodies::PoseOf(const Mount& mount, const std::vector<double>& positions,
                         const std::vector<Pose3>& X_B) const {
  double q = mount.multiplier * positions[mount.moving] + mount.offset;
  if (mount.stops) q = robot::StoppedAt(mount.stops->lower, mount.stops->upper, q);
  Pose3 X_JBody;
  if (mount.is_prismatic) {
    X_JBody.translation = q * mount.axis;
  } else {
    X_JBody.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(q, mount.axis));
  }
  Pose3 X_BBody = X_B[mount.parent] * mount.X_PJ * X_JBody;
  X_BBody.rotation.normalize();
  return X_BBody;
}

void LinkBodies::Place(const std::vector<double>& positions, std::vector<Pose3>* X_B) const {
  HIRES_CHECK(positions.size() == moving_.size(), "one position for each moving joint");
  X_B->resize(bodies_.size());
  (*X_B)[0] = Pose3();
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    (*X_B)[i] = PoseOf(mounts_[i], positions, *X_B);
  }
}

void LinkBodies::PlaceMoved(const std::vector<double>& before, const std::vector<double>& positions,
                            std::vector<Pose3>* X_B, std::vector<bool>* moved) const {
  HIRES_CHECK(before.size() == moving_.size() && positions.size() == moving_.size(),
              "one position for each moving joint");
  HIRES_CHECK(X_B->size() == bodies_.size(), "all bodies are placed already");
  moved->assign(bodies_.size(), false);
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Mount& mount = mounts_[i];
    const bool is_still =
        !(*moved)[mount.parent] && before[mount.moving] == positions[mount.moving];
    if (is_still) continue;
    (*moved)[i] = true;
    (*X_B)[i] = PoseOf(mount, positions, *X_B);
  }
}

}  // namespace hires::simulation
