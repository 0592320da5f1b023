#pragma once

#include <string>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/shape.h"
#include "hires/sensing/scan_obstacles.h"

namespace hires::sensing {

struct TrayParams {
  double max_range{0.35};   ///< [m] from the laser; what is farther is not on the tray
  double gap{0.03};         ///< [m] points that are nearer belong to one thing
  int min_beams{10};        ///< of a thing; fewer are no thing, and tell nothing of one
  double tolerance{0.015};  ///< [m] between what is believed and what is measured
  double matching{0.6};     ///< of the beams that reach a thing's outline, on it
  double outside{0.02};     ///< [m] over the tray's edge that a point may be
  double thickness{0.005};  ///< [m] of the slice of things that the scan meets
  double padding{0.03};  ///< [m] a beam that ends this near to the robot's own parts says nothing
  double edge{0.0133};   ///< [rad] nor do those so far beside it: a beam may be split
};

/// Beams that end near each other, and the box whose sides their ends lie on best.
struct TrayThing {
  geometry::Pose2 X_TB;                           ///< the box's middle, x along its longer side
  Eigen::Vector2d size{Eigen::Vector2d::Zero()};  ///< [m] of the seen side only
  std::vector<Eigen::Vector2d> points_T;          ///< where its beams end
  int num_beams() const { return static_cast<int>(points_T.size()); }
};

/// What the robot believes to stand on its tray.
struct BelievedOnTray {
  std::string name;
  geometry::Pose3 X_TO;
  std::vector<geometry::Collision> shapes_O;
  bool is_box{false};  ///< its box alone is known: what ends anywhere in it is it, and it is looked
                       ///< for nowhere else
};

enum class TrayState {
  kInPlace,  ///< where it is believed
  kMoved,    ///< on the tray, but elsewhere, not turned
  kMissing,  ///< the scan looks through it
  kUnknown   ///< something stands before it, or it is lower than the scan
};

struct TrayObject {
  std::string name;
  TrayState state{TrayState::kUnknown};
  geometry::Pose3 X_TO;  ///< as believed, or where the beams that end on it say; never turned
  int num_beams{0};      ///< that end on it
};

struct TrayReading {
  std::vector<TrayThing> things;    ///< all that stand there, in the order of their first beams
  std::vector<TrayObject> objects;  ///< one for each that is believed, in that order
  std::vector<TrayThing> surplus;   ///< what no believed object explains
};

/// [rad] by which the laser may lean over the tray.
inline constexpr double kLevelLaser = 0.05;

/// What a planar laser over the tray (frame T) says of what stands on it, and how that fits to what
/// is believed. An object is known again by its outline at the scan's height alone: of two that
/// look alike there, a moved one may be taken for the other. A range that is no number, or not
/// more than the laser's least, says nothing of its direction; an infinite one that nothing is
/// there.
/// @param X_TL    the laser; it must be level with the tray.
/// @param tray_T  the tray's outline.
/// @param own_T   outlines, in the scan's height, of the robot's parts and of what it holds.
/// @throws std::logic_error for a laser that leans by more than kLevelLaser.
TrayReading ReadTray(const robot::ScanReading& scan, const geometry::Pose3& X_TL,
                     const geometry::Polygon& tray_T, const std::vector<BelievedOnTray>& believed,
                     const TrayParams& params, const std::vector<geometry::Polygon>& own_T = {});

/// Outlines, in frame T, of the parts of shapes that lie within half of `thickness` [m] of a
/// height.
std::vector<geometry::Polygon> SliceAt(double height, double thickness,
                                       const std::vector<geometry::Collision>& shapes_O,
                                       const geometry::Pose3& X_TO);

}  // namespace hires::sensing
