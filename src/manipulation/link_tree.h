#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "hires/robot/robot_model.h"

namespace hires::manipulation {

/// Forward kinematics of all links for many postures: names are resolved once. Limits are not
/// looked at.
class LinkTree {
 public:
  explicit LinkTree(const robot::RobotModel& model);

  /// Poses of all links in the root's frame, into `X_R` (resized). Joints that are not named stand
  /// at rest.
  /// @throws base::ConfigError for a joint that the robot lacks.
  void Compute(const robot::JointPositions& posture, std::vector<Eigen::Isometry3d>* X_R) const;

  int parent(int link) const { return nodes_[link].parent; }
  bool is_rigid(int link) const { return nodes_[link].type == robot::JointType::kFixed; }
  int size() const { return static_cast<int>(nodes_.size()); }
  int JointLink(const std::string& joint) const;  ///< the link that the joint carries
  bool IsBelow(int link, int ancestor) const;     ///< or the same

 private:
  struct Node {
    int parent{-1};
    robot::JointType type{robot::JointType::kFixed};
    Eigen::Isometry3d X_PJ;
    Eigen::Vector3d axis;
    int leader{-1};  // link of the joint that sets this one's position
    double multiplier{1.0}, offset{0.0};
    double rest{0.0};
    // Of a joint that follows another.
    double lower{-std::numeric_limits<double>::infinity()};
    double upper{std::numeric_limits<double>::infinity()};
  };
  static Node MakeNode(const robot::RobotModel& model, int link);

  std::string robot_;
  std::vector<Node> nodes_;
  std::unordered_map<std::string, int> links_by_joint_;
};

}  // namespace hires::manipulation
