#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace hires::manipulation {

/// Two things that touch: robot links, held objects, loose objects, static bodies.
struct Touch {
  std::string a, b;
};

struct CollisionParams {
  double padding{0.01};  ///< [m] kept from whatever is no robot part
};

/// Robot, world, objects and held object as collision shapes (FCL). Static bodies never move;
/// objects are set once per motion. One instance belongs to one thread at a time; Clone is cheap
/// (shapes are shared).
class CollisionScene {
 public:
  /// Pairs of robot parts that touch in every sampled posture or are neighbours are left out.
  /// @throws base::ConfigError for a shape that is not supported.
  CollisionScene(std::shared_ptr<const world::World> world,
                 std::shared_ptr<const robot::Robot> robot, const CollisionParams& params);
  CollisionScene Clone() const;
  ~CollisionScene();
  CollisionScene(CollisionScene&&) noexcept;

  /// Loose objects in the map; an object whose attached_to names a link moves with it, and may
  /// touch that link, its gripper's fingers, and nothing else.
  /// @throws base::ConfigError for an unknown model or link.
  void SetObjects(const std::vector<world::ObjectState>& objects, const geometry::Pose2& X_MB,
                  const robot::JointPositions& posture);
  /// `part` (link, object or static body) may touch `other` from now on: fingers what they grasp, a
  /// held object what it stands on.
  void Allow(const std::string& part, const std::string& other);

  /// The first touch in a fixed order, or nothing.
  std::optional<Touch> FindTouch(const geometry::Pose2& X_MB,
                                 const robot::JointPositions& posture) const;

 private:
  struct Impl;
  explicit CollisionScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::manipulation
