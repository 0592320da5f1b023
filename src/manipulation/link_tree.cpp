#include "manipulation/link_tree.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "manipulation/collision_shapes.h"
#include "robot/limit_stop.h"

namespace hires::manipulation {
namespace {

using robot::JointType;

int LinkOfJoint(const robot::RobotModel& model, const std::string& joint) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (model.links[i].joint && model.links[i].joint->name == joint) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

LinkTree::Node LinkTree::MakeNode(const robot::RobotModel& model, int link) {
  Node node;
  node.X_PJ.setIdentity();
  node.axis = Eigen::Vector3d::UnitX();
  node.leader = link;
  if (!model.links[link].joint) return node;
  const robot::Joint& joint = *model.links[link].joint;
  node.parent = joint.parent;
  node.type = joint.type;
  node.X_PJ = ToIsometry(joint.X_PJ);
  node.axis = joint.axis;
  if (joint.limits && joint.type != JointType::kContinuous) {
    node.rest = std::clamp(0.0, joint.limits->lower, joint.limits->upper);
  }
  if (!joint.mimics.empty()) {
    node.leader = LinkOfJoint(model, joint.mimics);
    node.multiplier = joint.mimic_multiplier;
    node.offset = joint.mimic_offset;
    if (joint.limits && joint.type != JointType::kContinuous) {
      node.lower = joint.limits->lower;
      node.upper = joint.limits->upper;
    }
  }
  return node;
}

LinkTree::LinkTree(const robot::RobotModel& model) : robot_(model.name) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    nodes_.push_back(MakeNode(model, static_cast<int>(i)));
    if (model.links[i].joint) links_by_joint_[model.links[i].joint->name] = static_cast<int>(i);
  }
}

int LinkTree::JointLink(const std::string& joint) const {
  const auto found = links_by_joint_.find(joint);
  if (found != links_by_joint_.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [name, link] : links_by_joint_) known.push_back(name);
  std::sort(known.begin(), known.end());
  throw base::ConfigError(
      fmt::format("robot '{}': {}", robot_, base::UnknownName("joint", joint, known)));
}

bool LinkTree::IsBelow(int link, int ancestor) const {
  while (link >= 0 && link != ancestor) link = nodes_[link].parent;
  return link == ancestor;
}

void LinkTree::Compute(const robot::JointPositions& posture,
                       std::vector<Eigen::Isometry3d>* X_R) const {
  std::vector<double> positions(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) positions[i] = nodes_[i].rest;
  for (const auto& [joint, position] : posture) positions[JointLink(joint)] = position;
  X_R->resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    Eigen::Isometry3d& X = (*X_R)[i];
    X = node.parent < 0 ? node.X_PJ : (*X_R)[node.parent] * node.X_PJ;
    const double position = robot::StoppedAt(
        node.lower, node.upper, node.multiplier * positions[node.leader] + node.offset);
    if (node.type == JointType::kPrismatic) {
      X.translation() += X.linear() * (position * node.axis);
    } else if (node.type != JointType::kFixed) {
      X.linear() = X.linear() * Eigen::AngleAxisd(position, node.axis).toRotationMatrix();
    }
  }
}

}  // namespace hires::manipulation
