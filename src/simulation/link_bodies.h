#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/shape.h"
#include "hires/robot/robot_profile.h"

namespace hires::simulation {

/// A robot cut at its moving joints: links that never move relative to each other make one body.
/// Constant after building.
class LinkBodies {
 public:
  struct Body {
    std::string link;                ///< whose frame is the body's; the base's for body 0
    std::vector<std::string> links;  ///< all that it is made of
    std::vector<geometry::Collision>
        collisions;  ///< in the body's frame, named as FrozenCollisions
  };

  /// @param moving   joints that may move; those that mimic one of them move along.
  /// @param posture  where all other joints are frozen.
  /// @throws base::ConfigError as robot::ForwardKinematics.
  LinkBodies(const robot::Robot& robot, std::vector<std::string> moving,
             const robot::JointPositions& posture);

  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<std::string>& moving() const { return moving_; }

  /// Poses of all bodies in the base frame, in their order.
  /// @param positions  of the moving joints, in their order; their limits are not looked at.
  void Place(const std::vector<double>& positions, std::vector<geometry::Pose3>* X_B) const;

  /// The same where `X_B` was placed for the positions `before`: only what moved since is touched.
  /// @param moved  which bodies did, in their order.
  void PlaceMoved(const std::vector<double>& before, const std::vector<double>& positions,
                  std::vector<geometry::Pose3>* X_B, std::vector<bool>* moved) const;

  /// Body of a link and the link's place in it. @throws base::ConfigError if there is no such link.
  int BodyOf(const std::string& link) const;
  const geometry::Pose3& InBody(const std::string& link) const;

 private:
  struct Mount {
    int parent{0};         // body
    geometry::Pose3 X_PJ;  // joint frame in the parent body at position 0
    Eigen::Vector3d axis;  // in the joint frame
    bool is_prismatic{false};
    int moving{0};  // index of the joint that it follows
    double multiplier{1.0}, offset{0.0};
    std::optional<robot::JointLimits> stops{};  // of a joint that follows another
  };
  void AddShapes(const robot::RobotModel& model, const robot::JointPositions& posture);
  int LinkIndex(const std::string& link) const;
  /// Pose in the base frame of a body whose parent is placed already.
  geometry::Pose3 PoseOf(const Mount& mount, const std::vector<double>& positions,
                         const std::vector<geometry::Pose3>& X_B) const;
  int FindMoving(const robot::Joint& joint) const;  // -1: it is frozen

  std::vector<std::string> moving_, links_;
  std::vector<Body> bodies_;
  std::vector<Mount> mounts_;                // by body; that of body 0 means nothing
  std::vector<int> body_of_;                 // by link
  std::vector<geometry::Pose3> X_BodyLink_;  // by link
};

}  // namespace hires::simulation
