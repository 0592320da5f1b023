// Private to this layer: what is the matter where a base cannot stand or pass, for people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"
#include "hires/skills/move_base.h"
#include "skills/driving/narrow_place.h"

namespace hires::skills {

/// What is wrong with a place to stand at: it lies outside of the map, is unmapped, an obstacle
/// (which, how far), or too narrow (how wide it is, and the base). Where that stands only at
/// heights at which the robot is narrower than its footprint, the heights and how wide it is there.
/// @param place  "start", "goal".
std::string WhyBlocked(const DrivingContext& context, const navigation::Costmap& costmap,
                       const std::string& place, const geometry::Pose2& X_MB);

/// "the start at ... lies at the map's end: ...": of a base that reaches more than `slack` [m]
/// beyond the map, where all counts as an obstacle; none: it does not.
/// @param footprint  in the base frame
std::optional<std::string> WhyOffMap(const navigation::Costmap& costmap,
                                     const geometry::Polygon& footprint, const std::string& place,
                                     const geometry::Pose2& X_MB, double slack);

/// Why a base may have got stuck where it is, as far as the map tells: what is nearest to it are
/// cells that nobody has mapped (how many, where). Else empty.
std::string WhyStuck(const navigation::Costmap& costmap, const geometry::Polygon& footprint,
                     const geometry::Pose2& X_MB);

/// Of a base that can turn to neither side by 90 degrees where it stands: how large it is, by how
/// much it can, and what it touches then. Else empty.
std::string WhyNoTurn(const DrivingContext& context, const navigation::Costmap& costmap,
                      const geometry::Polygon& footprint, const geometry::Pose2& X_MB);

/// Of a base that came no further on a path: where it would touch something on the rest of it, and
/// what. Else empty.
std::string WhyNoWay(const DrivingContext& context, const navigation::Costmap& costmap,
                     const navigation::Footprint& footprint, const geometry::Pose2& X_MB,
                     const std::vector<geometry::Pose2>& path);

/// Of a base that found no motion where it stands: what is next to it, and how near. Else empty.
std::string WhyNoMotion(const DrivingContext& context, const navigation::Costmap& costmap,
                        const geometry::Polygon& footprint, const geometry::Pose2& X_MB);

/// Where the way from start to goal ends, and by what; heights as above.
/// @param narrow  where the footprint is too wide, if that is why; else null.
std::string WhyNoPath(const DrivingContext& context, const navigation::Costmap& costmap,
                      const geometry::Pose2& X_MStart, const geometry::Pose2& X_MGoal,
                      const NarrowPlace* narrow);

}  // namespace hires::skills
