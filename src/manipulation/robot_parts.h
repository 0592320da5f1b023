#pragma once

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/robot/robot_profile.h"
#include "manipulation/collision_shapes.h"
#include "manipulation/link_tree.h"

namespace hires::manipulation {

/// The robot's collision shapes, and which pairs of them have to be looked at. Constant.
class RobotParts {
 public:
  RobotParts(const robot::Robot& robot, double padding, int num_samples);

  struct Part {
    int link;
    CollisionShape shape;
  };

  const LinkTree& tree() const { return tree_; }
  const std::vector<Part>& parts() const { return parts_; }
  /// Two parts that must not touch each other, by index, lower one first.
  struct Pair {
    int a, b;
    std::size_t level;  ///< of kShrinkage, for both
  };
  const std::vector<Pair>& pairs() const { return pairs_; }
  int RigidGroup(int link) const;  ///< the topmost link that is rigidly joined
  /// May this link touch the floor?
  bool stands_on_floor(int link) const { return stands_on_floor_[link]; }
  /// Pairs of links that touch in nearly all postures, or in a named one however much they are
  /// shrunk: hence left out.
  const std::vector<std::pair<int, int>>& left_out() const { return left_out_; }

  /// All parts in place. @param X_MR  the root link in the map.
  void PlaceAll(const Eigen::Isometry3d& X_MR, const robot::JointPositions& posture,
                std::vector<Eigen::Isometry3d>* X_ML,
                std::vector<PlacedCollisionShape>* placed) const;

 private:
  void FindPairs(const robot::Robot& robot);
  void LeaveOutUsualTouches(const robot::Robot& robot, int num_samples);
  void ShrinkNamedTouches(const robot::Robot& robot);
  std::set<std::pair<int, int>> TouchingLinks(const robot::JointPositions& posture) const;
  void LeaveOut(const std::set<std::pair<int, int>>& links);
  bool HaveLevel(const Pair& pair) const;
  void FindStandingLinks(const robot::Robot& robot, double padding);
  bool AreNeighbours(int a, int b) const;
  bool AreInOneHand(const robot::Robot& robot, int a, int b) const;

  LinkTree tree_;
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;
  std::vector<bool> stands_on_floor_;
  std::vector<std::pair<int, int>> left_out_;
};

}  // namespace hires::manipulation
