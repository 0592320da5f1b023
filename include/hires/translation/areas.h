#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace hires::translation {

/// What an area is for.
enum class AreaKind {
  kStanding,  ///< of the base: manipulation and pre-manipulation areas, home, start
  kRoom,      ///< a whole floor: where the robot is when it stands at no area of the first kind
  kSeat,      ///< of a guest
  kPlacing,   ///< on top of furniture
  kTray,      ///< on the robot
};

/// A rectangle with a name.
struct Area {
  std::string name;  ///< lower case
  AreaKind kind{AreaKind::kStanding};
  geometry::Pose3 X_FA;                           ///< its middle, x and y along its edges
  std::string link;                               ///< F: a link of the robot, or empty: map
  Eigen::Vector2d size{Eigen::Vector2d::Zero()};  ///< [m] full lengths; 0: no more than its middle
};

/// Areas by name.
struct Areas {
  std::vector<Area> all;  ///< by name

  const Area* Find(const std::string& name) const;  ///< case ignored; null if there is none
  /// @throws base::ConfigError with the names that come near.
  const Area& Require(const std::string& name) const;
};

constexpr char kTrayArea[] = "trayarea1";

/// The room of a world that names none, as one made of a map: wherever on its floor the robot is
/// seen, if it stands at no area. It has no size and no pose.
constexpr char kFloorArea[] = "floorarea";

/// Areas from the world's frames, told apart by the words that their names begin with:
/// `placingArea`, `sittingArea`, `floorArea`; all others are for standing. A robot with a tray has
/// trayArea1: what of the tray's shapes lies highest. Placing areas have the world's extents. A
/// world without a room has kFloorArea.
Areas AreasOf(const world::World& world, const robot::Robot& robot);

/// The same with what the Blackboard knows: kinds by concept (PlacingArea and below, FloorArea,
/// SittingArea; TrayArea is the robot's own), sizes by hasBoundingBox. Poses stay the world's. An
/// area that is only on the Blackboard is not in the world and left out.
Areas WithKnowledge(Areas areas, const knowledge::FluentView& view,
                    const knowledge::Ontology& ontology);

}  // namespace hires::translation
