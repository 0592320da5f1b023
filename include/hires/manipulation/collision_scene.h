#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace hires::manipulation {

/// Two things that touch: robot links, held objects, loose objects, static bodies, or "floor".
struct Touch {
  std::string a, b;
};
std::string ToString(const Touch& touch);  ///< "r_forearm_link touches table1"

struct CollisionParams {
  /// [m] kept from whatever is no robot part. Boxes and cylinders grow by it along their axes, so
  /// that their edges keep up to 1.7 times as much.
  double padding{0.01};
  int num_samples{200};  ///< random postures that tell which robot parts touch whatever they do
};

/// One entry per link of the robot model: whether it counts.
using LinkMask = std::vector<bool>;

/// Robot, world, objects and held object as collision shapes (FCL). Static bodies never move;
/// objects are set once per motion. One instance belongs to one thread at a time; Clone is cheap
/// (shapes are shared). A mesh is its surface: what lies wholly inside does not touch it.
class CollisionScene {
 public:
  /// Pairs of robot parts are left out that are rigidly joined, neighbours or of one hand, or that
  /// touch in nearly all sampled postures. Pairs that touch in a named posture of the profile are
  /// taken smaller, by up to 0.06 m on each side, until they do not, and left out if that does not
  /// help: their shapes cover more than the real parts do.
  /// The floor is z = 0; robot parts that reach it at rest (wheels)
  /// may touch it.
  /// @throws base::ConfigError for a shape that is not supported.
  CollisionScene(std::shared_ptr<const world::World> world,
                 std::shared_ptr<const robot::Robot> robot, const CollisionParams& params);
  CollisionScene Clone() const;
  ~CollisionScene();
  CollisionScene(CollisionScene&&) noexcept;

  /// Loose objects in the map, instead of those that were set before; what was allowed stays
  /// allowed. An object whose attached_to names a link moves with it, and may touch that link, its
  /// gripper's fingers (links that hang on it), and nothing else.
  /// @param X_MB, posture  where the robot stands with the attached objects at their X_MO.
  /// @throws base::ConfigError for an unknown model or link.
  void SetObjects(const std::vector<world::ObjectState>& objects, const geometry::Pose2& X_MB,
                  const robot::JointPositions& posture);
  /// `part` (link, object or static body) may touch `other` from now on: fingers what they grasp, a
  /// held object what it stands on. What may touch a link keeps no distance (padding) from links
  /// that are rigidly joined to it. Names compare without regard to case, either order.
  void Allow(const std::string& part, const std::string& other);

  /// The first touch in a fixed order, or nothing. Loose objects do not count among themselves and
  /// against static bodies.
  /// @throws base::ConfigError for a joint that the robot lacks.
  std::optional<Touch> FindTouch(const geometry::Pose2& X_MB,
                                 const robot::JointPositions& posture) const;
  /// Likewise, but only touches in which one of the masked links or something held by one takes
  /// part: what a motion of theirs can be blamed for. Faster.
  std::optional<Touch> FindTouch(const geometry::Pose2& X_MB, const robot::JointPositions& posture,
                                 const LinkMask& links) const;
  /// Links that move when one of these joints does.
  /// @throws base::ConfigError for a joint that the robot lacks.
  LinkMask MovedBy(const std::vector<std::string>& joints) const;

  /// Pairs of links that are left out because they touch in nearly all postures or a named one.
  std::vector<std::pair<std::string, std::string>> LeftOutPairs() const;

 private:
  struct Impl;
  explicit CollisionScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::manipulation
