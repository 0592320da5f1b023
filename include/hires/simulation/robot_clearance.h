#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"
#include "hires/world/world.h"

namespace hires::simulation {

/// Two things that touch.
struct RobotContact {
  std::string robot_part;  ///< collision of the robot, "l_forearm_link"
  std::string obstacle;    ///< of the world, as world::NameOf: "table1", "house::coat_stand"
  std::optional<Eigen::Vector2d> p_M{};  ///< [m] where; none: unknown
  std::string source{};                  ///< where the obstacle stands in its file; or empty
};

/// " at x 0.15 m, y 0.00 m (hall.world:12)", as far as it is known.
std::string PlaceText(const RobotContact& contact);
/// "base touches house::coat_stand", and its PlaceText.
std::string ToString(const RobotContact& contact);

/// A part of the robot that touches a body; which of the body's shapes, and where, is found here.
/// @param part_M  with its pose in the map.
RobotContact ContactWith(const geometry::Collision& part_M, const world::StaticBody& body,
                         const world::World& world);

class TouchShape;

/// Tells whether the robot, moving in the plane with its joints frozen, touches a static body. Each
/// shape that is no mesh counts as the upright prism over its outline between its lowest and its
/// highest point: exact for upright boxes and cylinders, never too small for anything else. A mesh,
/// the robot's own or an obstacle's, is where its triangles are: what a wall goes round is free,
/// and so is what is below a table. What reaches no higher than 5 mm over the robot's lowest shape,
/// or over z = 0 where that is lower, is the floor that bears it, and touches nothing; of a mesh
/// the part that is so low.
class RobotClearance {
 public:
  /// @param robot_B  collision shapes in the base frame.
  RobotClearance(const std::vector<geometry::Collision>& robot_B, const world::World& world);

  /// The first contact in the order of the shapes, or nothing; a shape that is no mesh fills the
  /// prism round it.
  std::optional<RobotContact> FindContact(const geometry::Pose2& X_MB) const;
  /// Likewise, each shape as it is. Costs more.
  std::optional<RobotContact> FindExactContact(const geometry::Pose2& X_MB) const;

  /// Horizontal distance from the robot's nearest part to the nearest body at its height [m], at
  /// most `limit`; 0 on contact. To and from meshes it is the distance in space.
  double Clearance(const geometry::Pose2& X_MB, double limit) const;

 private:
  struct Prism {
    std::string name;
    std::string source;  // of an obstacle
    geometry::Polygon outline;
    double z_min{0.0}, z_max{0.0};
    Eigen::Vector2d centre{0.0, 0.0};  // of a circle around the outline
    double radius{0.0};
    std::shared_ptr<const TouchShape> shape;
    geometry::Pose3 X_FS;  // in the frame of the outline
  };
  static std::optional<Prism> MakePrism(const std::string& name, const std::string& source,
                                        const geometry::Collision& shape,
                                        const geometry::Pose3& X_WB);
  static bool IsExact(const Prism& part, const Prism& obstacle);
  std::optional<RobotContact> ContactAt(const geometry::Pose2& X_MB, bool exactly) const;
  /// Calls visit(part, obstacle, distance) for all pairs of one height that may lie within `limit`.
  template <typename Visit>
  void ForNearPairs(const geometry::Pose2& X_MB, double limit, Visit visit) const;

  std::vector<Prism> robot_;      // in the base frame
  std::vector<Prism> obstacles_;  // in the map
  double robot_radius_{0.0};      // around the base's origin
};

}  // namespace hires::simulation
