#include "skills/driving/narrow_place.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hires/geometry/angles.h"
#include "hires/geometry/polygon.h"
#include "skills/driving/cell_room.h"

namespace hires::skills {
namespace {

using geometry::Pose2;
using navigation::Costmap;

constexpr double kStraightWay = 0.3;     // [m] before and behind the middle of a passage
constexpr double kSlack = 0.03;          // [m] that lies between what is tried
constexpr double kTight = 2.0;           // cells of spare room; with more a base winds through
constexpr double kFineSteps = 10.0;      // places tried per cell of what is tight
constexpr double kFineHeading = 0.0175;  // [rad]

/// A footprint that is smaller by what lies between two places or headings that are tried.
navigation::Footprint Shrunk(const navigation::Footprint& footprint) {
  const auto shrink = [](const Eigen::Vector2d& middle, geometry::Polygon* outline) {
    double radius = 0.0;
    for (const Eigen::Vector2d& p : *outline) radius = std::max(radius, (p - middle).norm());
    const double share = std::max(0.0, 1.0 - kSlack / radius);
    for (Eigen::Vector2d& p : *outline) p = middle + share * (p - middle);
  };
  navigation::Footprint shrunk = footprint;
  shrink(Eigen::Vector2d::Zero(), &shrunk.outline);
  for (geometry::Polygon& part : shrunk.by_layer) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : part) middle += p / static_cast<double>(part.size());
    shrink(middle, &part);
  }
  return shrunk;
}

/// Across the way: the direction in which a place is narrowest.
struct Cut {
  Eigen::Vector2d left{0.0, 1.0};
  double to_left{0.0}, to_right{0.0};  // [m] free
  double width() const { return to_left + to_right; }
  double yaw() const { return std::atan2(-left.x(), left.y()); }
};

Cut NarrowestCut(const Costmap& costmap, const Eigen::Vector2d& p_M, double yaw) {
  constexpr int kDirections = 36;
  Cut narrowest;
  for (int i = 0; i < kDirections; ++i) {
    const double turned = yaw + geometry::kPi * (i / static_cast<double>(kDirections) - 0.5);
    Cut cut{{-std::sin(turned), std::cos(turned)}, 0.0, 0.0};
    cut.to_left = FreeTowards(costmap, p_M, cut.left);
    cut.to_right = FreeTowards(costmap, p_M, -cut.left);
    if (i == 0 || cut.width() < narrowest.width()) narrowest = cut;
  }
  return narrowest;
}

/// In the map or in one of its layers in which the footprint touches something.
Cut NarrowestCut(const Costmap& costmap, const navigation::Footprint& footprint,
                 const Pose2& X_MB) {
  Cut narrowest = NarrowestCut(costmap, X_MB.position(), X_MB.yaw);
  for (std::size_t i = 0; i < costmap.layers().size(); ++i) {
    const Costmap& layer = *costmap.layers()[i];
    if (layer.FootprintCost(footprint.AtLayer(i), X_MB) < navigation::kLethalCost) continue;
    const Cut cut = NarrowestCut(layer, X_MB.position(), X_MB.yaw);
    if (cut.width() < narrowest.width()) narrowest = cut;
  }
  return narrowest;
}

/// Whether the path goes straight on through a cut: at a bend a base may turn as it passes.
bool GoesStraight(const std::vector<Pose2>& path, std::size_t at, double yaw) {
  constexpr double kChord = 0.6;     // [m]
  constexpr double kStraight = 0.9;  // [rad]
  const Eigen::Vector2d here = path[at].position();
  std::size_t before = at, after = at;
  while (before > 0 && (path[before].position() - here).norm() < kChord) --before;
  while (after + 1 < path.size() && (path[after].position() - here).norm() < kChord) ++after;
  const auto is_along = [&](const Eigen::Vector2d& chord) {
    return std::abs(geometry::WrapToPi(std::atan2(chord.y(), chord.x()) - yaw)) < kStraight;
  };
  return is_along(here - path[before].position()) && is_along(path[after].position() - here);
}

/// Whether it drives straight on through a place, a little before and behind it, too: a base does
/// not wind itself through.
bool DrivesThrough(const Costmap& costmap, const navigation::Footprint& footprint,
                   const Pose2& X_MB) {
  for (double way = 0.0; way <= kStraightWay; way += costmap.resolution()) {
    for (const double x : {way, -way}) {
      if (costmap.FootprintCost(footprint, X_MB * Pose2{x, 0.0, 0.0}) >= navigation::kLethalCost)
        return false;
    }
  }
  return true;
}

/// How densely places and headings are tried.
struct Trials {
  double place_steps;   // per cell
  double heading_step;  // [rad]
};
constexpr Trials kCoarse{kPlaceSteps, kHeadingStep}, kFine{kFineSteps, kFineHeading};

bool FitsAt(const Costmap& costmap, const navigation::Footprint& footprint,
            const Eigen::Vector2d& p_M, double yaw, const Trials& trials) {
  for (double off = 0.0; off <= kDrivenHeading; off += trials.heading_step) {
    for (const double heading : {yaw + off, yaw - off}) {
      if (DrivesThrough(costmap, footprint, {p_M.x(), p_M.y(), heading})) return true;
    }
  }
  return false;
}

/// Places across the way, from its middle outwards.
bool FitsAcross(const Costmap& costmap, const navigation::Footprint& footprint,
                const Eigen::Vector2d& middle, const Cut& cut, const Trials& trials) {
  const double step = costmap.resolution() / trials.place_steps;
  for (double y = 0.0; y <= 0.5 * cut.width(); y += step) {
    if (FitsAt(costmap, footprint, middle + y * cut.left, cut.yaw(), trials) ||
        FitsAt(costmap, footprint, middle - y * cut.left, cut.yaw(), trials))
      return true;
  }
  return false;
}

}  // namespace

std::optional<NarrowPlace> FindTooNarrow(const Costmap& costmap,
                                         const navigation::Footprint& footprint,
                                         const std::vector<Pose2>& path) {
  const double reach = geometry::CircumscribedRadius(footprint.outline);
  const double needed = NarrowestWidth(footprint.outline);
  const navigation::Footprint shrunk = Shrunk(footprint);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Pose2& pose = path[i];
    const bool is_at_end = (pose.position() - path.front().position()).norm() <= reach ||
                           (pose.position() - path.back().position()).norm() <= reach;
    if (is_at_end || costmap.FootprintCost(footprint, pose) < navigation::kLethalCost) continue;
    const bool is_clear = costmap.FootprintCost(shrunk, pose) < navigation::kLethalCost;
    const Cut cut = NarrowestCut(costmap, is_clear ? footprint : shrunk, pose);
    if (cut.width() >= 2.0 * reach || !GoesStraight(path, i, cut.yaw())) continue;
    const bool is_tight = cut.width() < needed + kTight * costmap.resolution();
    const Eigen::Vector2d middle = pose.position() + 0.5 * (cut.to_left - cut.to_right) * cut.left;
    const bool fits = (is_clear || FitsAcross(costmap, shrunk, middle, cut, kCoarse)) &&
                      (!is_tight || FitsAcross(costmap, footprint, middle, cut, kFine));
    if (fits) continue;
    return NarrowPlace{{middle.x(), middle.y(), cut.yaw()}, cut.width(), needed};
  }
  return std::nullopt;
}

Costmap WithClosed(const Costmap& costmap, const NarrowPlace& place) {
  const Eigen::Vector2d left(-std::sin(place.X_MW.yaw), std::cos(place.X_MW.yaw));
  const double half = 0.5 * place.width + costmap.resolution();
  std::vector<Eigen::Vector2d> points;
  for (double y = -half; y <= half; y += 0.5 * costmap.resolution())
    points.push_back(place.X_MW.position() + y * left);
  return costmap.WithObstaclesAt(points);
}

}  // namespace hires::skills
