#include "manipulation/robot_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::manipulation {
namespace {

using LinkPair = std::pair<int, int>;

constexpr std::uint64_t kSamplingSeed = 20150301;
constexpr double kUsualShare = 0.95;  // touching in more sampled postures than this is no event

robot::JointPositions RandomPosture(const robot::RobotModel& model, base::Rng rng) {
  robot::JointPositions posture;
  for (const robot::Link& link : model.links) {
    if (!link.joint || link.joint->type == robot::JointType::kFixed) continue;
    const robot::Joint& joint = *link.joint;
    if (!joint.mimics.empty()) continue;
    const bool is_limited = joint.limits && joint.type != robot::JointType::kContinuous;
    posture[joint.name] = is_limited ? rng.Uniform(joint.limits->lower, joint.limits->upper)
                                     : rng.Uniform(-geometry::kPi, geometry::kPi);
  }
  return posture;
}

void SetArm(const robot::ArmProfile& arm, const std::vector<double>& values,
            robot::JointPositions* posture) {
  for (std::size_t i = 0; i < arm.joints.size(); ++i) (*posture)[arm.joints[i]] = values[i];
}

/// The driving posture at every named height of the torso, and every variant of a named posture of
/// every arm with the other joints as while driving.
std::vector<robot::JointPositions> NamedPostures(const robot::RobotProfile& profile) {
  std::vector<robot::JointPositions> postures{profile.joints};
  if (!profile.upper_body) return postures;
  for (const auto& [name, height] : profile.upper_body->torso_postures) {
    postures.push_back(profile.joints);
    postures.back()[profile.upper_body->torso_joint] = height;
  }
  for (const auto& [instance, arm] : profile.upper_body->arms) {
    for (const auto& [name, variants] : arm.postures) {
      for (const auto& values : variants) {
        postures.push_back(profile.joints);
        SetArm(arm, values, &postures.back());
      }
    }
  }
  return postures;
}

}  // namespace

RobotParts::RobotParts(const robot::Robot& robot, double padding, int num_samples)
    : tree_(robot.model), stands_on_floor_(robot.model.links.size(), false) {
  for (std::size_t i = 0; i < robot.model.links.size(); ++i) {
    const robot::Link& link = robot.model.links[i];
    const std::string what = fmt::format("robot '{}', link '{}'", robot.model.name, link.name);
    for (const geometry::Collision& collision : link.collisions) {
      parts_.push_back({static_cast<int>(i), MakeCollisionShape(collision, padding, what)});
      AddShrunk(collision.shape, &parts_.back().shape);
    }
  }
  FindPairs(robot);
  LeaveOutUsualTouches(robot, num_samples);
  ShrinkNamedTouches(robot);
  FindStandingLinks(robot, padding);
}

int RobotParts::RigidGroup(int link) const {
  while (tree_.parent(link) >= 0 && tree_.is_rigid(link)) link = tree_.parent(link);
  return link;
}

bool RobotParts::AreNeighbours(int a, int b) const {
  const int group_a = RigidGroup(a), group_b = RigidGroup(b);
  if (group_a == group_b) return true;
  const auto carries = [&](int above, int below) {
    return tree_.parent(below) >= 0 && RigidGroup(tree_.parent(below)) == above;
  };
  return carries(group_a, group_b) || carries(group_b, group_a);
}

bool RobotParts::AreInOneHand(const robot::Robot& robot, int a, int b) const {
  if (!robot.profile.upper_body) return false;
  for (const auto& [instance, arm] : robot.profile.upper_body->arms) {
    const auto palm = robot.model.FindLink(arm.palm_link);
    if (palm && tree_.IsBelow(a, *palm) && tree_.IsBelow(b, *palm)) return true;
  }
  return false;
}

void RobotParts::FindPairs(const robot::Robot& robot) {
  for (int a = 0; a < static_cast<int>(parts_.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(parts_.size()); ++b) {
      const int link_a = parts_[a].link, link_b = parts_[b].link;
      if (AreNeighbours(link_a, link_b) || AreInOneHand(robot, link_a, link_b)) continue;
      pairs_.push_back({a, b, 0});
    }
  }
}

std::set<LinkPair> RobotParts::TouchingLinks(const robot::JointPositions& posture) const {
  std::vector<Eigen::Isometry3d> X_ML;
  std::vector<PlacedCollisionShape> placed;
  PlaceAll(Eigen::Isometry3d::Identity(), posture, &X_ML, &placed);
  std::set<LinkPair> links;
  for (const Pair& pair : pairs_) {
    const LinkPair of(parts_[pair.a].link, parts_[pair.b].link);
    if (links.count(of) > 0) continue;
    if (AreTouchingShrunk(placed[pair.a], placed[pair.b], pair.level)) links.insert(of);
  }
  return links;
}

void RobotParts::LeaveOut(const std::set<LinkPair>& links) {
  const auto is_left_out = [&](const Pair& pair) {
    return links.count({parts_[pair.a].link, parts_[pair.b].link}) > 0;
  };
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), is_left_out), pairs_.end());
  left_out_.insert(left_out_.end(), links.begin(), links.end());
}

void RobotParts::LeaveOutUsualTouches(const robot::Robot& robot, int num_samples) {
  std::map<LinkPair, int> counts;
  const base::Rng rng(kSamplingSeed);
  for (int i = 0; i < num_samples; ++i) {
    for (const LinkPair& pair : TouchingLinks(RandomPosture(robot.model, rng.Fork(i)))) {
      ++counts[pair];
    }
  }
  std::set<LinkPair> usual;
  for (const auto& [pair, count] : counts) {
    if (count > kUsualShare * num_samples) usual.insert(pair);
  }
  LeaveOut(usual);
}

bool RobotParts::HaveLevel(const Pair& pair) const {
  return pair.level < kShrinkage.size() && parts_[pair.a].shape.shrunk[pair.level] &&
         parts_[pair.b].shape.shrunk[pair.level];
}

void RobotParts::ShrinkNamedTouches(const robot::Robot& robot) {
  std::set<LinkPair> hopeless;
  for (const robot::JointPositions& posture : NamedPostures(robot.profile)) {
    for (auto touching = TouchingLinks(posture); !touching.empty();
         touching = TouchingLinks(posture)) {
      for (Pair& pair : pairs_) {
        const LinkPair of(parts_[pair.a].link, parts_[pair.b].link);
        if (touching.count(of) == 0) continue;
        ++pair.level;
        if (!HaveLevel(pair)) hopeless.insert(of);
      }
      LeaveOut(hopeless);
      hopeless.clear();
    }
  }
}

void RobotParts::FindStandingLinks(const robot::Robot& robot, double padding) {
  const int base = robot.model.FindLink(robot.profile.base_link).value_or(0);
  std::vector<Eigen::Isometry3d> X_RL;
  std::vector<PlacedCollisionShape> placed;
  PlaceAll(Eigen::Isometry3d::Identity(), robot.profile.joints, &X_RL, &placed);
  const double floor = X_RL[base].translation().z();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (placed[i].lower.z() - floor < padding) stands_on_floor_[parts_[i].link] = true;
  }
}

void RobotParts::PlaceAll(const Eigen::Isometry3d& X_MR, const robot::JointPositions& posture,
                          std::vector<Eigen::Isometry3d>* X_ML,
                          std::vector<PlacedCollisionShape>* placed) const {
  tree_.Compute(posture, X_ML);
  for (Eigen::Isometry3d& X : *X_ML) X = X_MR * X;
  placed->resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Place(parts_[i].shape, (*X_ML)[parts_[i].link], &(*placed)[i]);
  }
}

}  // namespace hires::manipulation
