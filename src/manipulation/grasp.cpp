#include "hires/manipulation/grasp.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/shape.h"

namespace hires::manipulation {
namespace {

using geometry::Pose3;

constexpr double kMinTopDepth = 0.01;  // [m] that the tips have to reach down at an object's side
constexpr double kHeightStep = 0.02;   // [m] between the heights of side grasps
constexpr int kMaxHeights = 5;         // nearest to the centre of mass
constexpr double kRimMargin = 0.005;   // [m] on both sides, between the open fingers and a rim
constexpr double kMinGap = 0.005;      // [m] below this the fingers touch each other rather

/// Extent of a band of an object along the axes of a frame.
struct Extent {
  Eigen::Vector2d lower{1e300, 1e300}, upper{-1e300, -1e300};
  bool is_empty() const { return lower.x() > upper.x(); }
  double size(int axis) const { return upper[axis] - lower[axis]; }
  double middle(int axis) const { return 0.5 * (upper[axis] + lower[axis]); }
};

/// The object between two heights over its frame, seen from a frame turned by `yaw`.
Extent ExtentInBand(const world::ObjectModel& object, double yaw, double z_min, double z_max) {
  const Pose3 X_YO{{0.0, 0.0, 0.0}, geometry::RotationFromRpy(0.0, 0.0, -yaw)};
  Extent extent;
  for (const geometry::Collision& part : object.collisions) {
    const auto outline = geometry::OutlineInBand(part.shape, X_YO * part.X_BS, z_min, z_max);
    if (!outline) continue;
    for (const Eigen::Vector2d& corner : *outline) {
      extent.lower = extent.lower.cwiseMin(corner);
      extent.upper = extent.upper.cwiseMax(corner);
    }
  }
  return extent;
}

geometry::Aabb BoundsOf(const world::ObjectModel& object) {
  geometry::Aabb bounds;
  for (const geometry::Collision& part : object.collisions) {
    bounds.Include(geometry::BoundsOf(part.shape, part.X_BS));
  }
  return bounds;
}

double HeightShare(const world::ObjectModel& object, const geometry::Aabb& bounds, double height) {
  const double away = std::abs(height - object.mass_properties.p_BBcm.z());
  return 1.0 / (1.0 + away / (bounds.upper.z() - bounds.lower.z()));
}

double GapShare(double gap, double max_gap) {
  return 1.0 - std::abs(gap - 0.5 * max_gap) / max_gap;
}

/// Finds grasps of one object; keeps what all of them need.
class Finder {
 public:
  Finder(const world::ObjectModel& object, const robot::GripperProfile& gripper)
      : object_(object),
        fingers_(gripper.shape),
        max_gap_(gripper.max_gap),
        max_width_(std::min(gripper.max_gap, gripper.shape.max_gap_used)),
        bounds_(BoundsOf(object)) {}

  std::vector<double> SideHeights() const;
  std::optional<Grasp> Side(double heading, double height) const;
  std::optional<Grasp> Top(double heading) const;

 private:
  bool FitsBetweenFingers(double width) const { return width >= kMinGap && width <= max_width_; }
  double TopHeight() const;
  double DepthInV(double width) const;

  const world::ObjectModel& object_;
  const robot::FingerShape& fingers_;
  double max_gap_, max_width_;
  geometry::Aabb bounds_;
};

/// From the lowest at which the fingers keep clear of the supporting face to the highest at which
/// their pads are on the object; those nearest to the centre of mass.
std::vector<double> Finder::SideHeights() const {
  const double lowest = bounds_.lower.z() + fingers_.half_height + kGraspClearance;
  const double highest = bounds_.upper.z() - fingers_.pad_half_height;
  std::vector<double> heights;
  if (lowest > highest) return heights;
  const int steps = static_cast<int>(std::floor((highest - lowest) / kHeightStep));
  for (int i = 0; i <= steps; ++i) heights.push_back(lowest + i * kHeightStep);
  const double centre = object_.mass_properties.p_BBcm.z();
  std::stable_sort(heights.begin(), heights.end(),
                   [&](double a, double b) { return std::abs(a - centre) < std::abs(b - centre); });
  if (heights.size() > kMaxHeights) heights.resize(kMaxHeights);
  return heights;
}

std::optional<Grasp> Finder::Side(double heading, double height) const {
  const Extent pads = ExtentInBand(object_, heading, height - fingers_.pad_half_height,
                                   height + fingers_.pad_half_height);
  if (pads.is_empty() || !FitsBetweenFingers(pads.size(1))) return std::nullopt;
  const Extent hand =
      ExtentInBand(object_, heading, height - fingers_.half_height, height + fingers_.half_height);
  // Up to the middle of the object, unless the palm would meet it first.
  const double most = fingers_.palm_distance - kGraspClearance;
  const double x = std::min(pads.middle(0), hand.lower.x() + most);
  const double depth = x + fingers_.tip_reach - pads.lower.x();
  if (depth <= kGraspClearance) return std::nullopt;
  Grasp grasp;
  grasp.kind = "side";
  grasp.gap = pads.size(1);
  const Eigen::Quaterniond turn = geometry::RotationFromRpy(0.0, 0.0, heading);
  grasp.X_OT = {turn * Eigen::Vector3d(x, pads.middle(1), height), turn};
  const double wanted = std::min(0.5 * pads.size(0), most) + fingers_.tip_reach;
  grasp.quality = HeightShare(object_, bounds_, height) * std::min(1.0, depth / wanted) *
                  GapShare(grasp.gap, max_gap_);
  return grasp;
}

/// [m] from the tool's origin towards the palm that a rim of some width fits between open fingers.
double Finder::DepthInV(double width) const {
  const double room = fingers_.open_width - width - 2.0 * kRimMargin;
  if (fingers_.narrowing > 0.0) return room / fingers_.narrowing;
  return room >= 0.0 ? fingers_.palm_distance : 0.0;  // parallel: up to the palm
}

/// Height of the tool for a grasp from above: as deep as the palm and the supporting face allow,
/// but not beyond the centre of mass.
double Finder::TopHeight() const {
  const double by_palm = bounds_.upper.z() - fingers_.palm_distance + kGraspClearance;
  const double by_face = bounds_.lower.z() + fingers_.tip_reach + kGraspClearance;
  const double by_mass = std::min(object_.mass_properties.p_BBcm.z(), bounds_.upper.z());
  return std::max({by_palm, by_face, by_mass});
}

std::optional<Grasp> Finder::Top(double heading) const {
  const Extent whole = ExtentInBand(object_, heading, bounds_.lower.z(), bounds_.upper.z());
  const double height =
      std::max(TopHeight(), bounds_.upper.z() - DepthInV(whole.is_empty() ? 0.0 : whole.size(1)));
  const double depth = bounds_.upper.z() - (height - fingers_.tip_reach);
  if (depth < kMinTopDepth) return std::nullopt;
  const Extent pads =
      ExtentInBand(object_, heading, height - fingers_.tip_reach, bounds_.upper.z());
  if (pads.is_empty() || !FitsBetweenFingers(pads.size(1))) return std::nullopt;
  Grasp grasp;
  grasp.kind = "top";
  grasp.gap = pads.size(1);
  const Eigen::Quaterniond turn = geometry::RotationFromRpy(0.0, 0.0, heading);
  grasp.X_OT = {turn * Eigen::Vector3d(pads.middle(0), pads.middle(1), height),
                turn * geometry::RotationFromRpy(0.0, 0.5 * geometry::kPi, 0.0)};
  const double wanted = fingers_.palm_distance - kGraspClearance + fingers_.tip_reach;
  grasp.quality = HeightShare(object_, bounds_, height) * std::min(1.0, depth / wanted) *
                  GapShare(grasp.gap, max_gap_);
  return grasp;
}

}  // namespace

std::vector<Grasp> GraspsFor(const world::ObjectModel& object, const robot::GripperProfile& gripper,
                             int headings) {
  HIRES_CHECK(headings >= 1, "at least one heading");
  const Finder finder(object, gripper);
  std::vector<Grasp> grasps;
  const auto add = [&](const std::optional<Grasp>& grasp) {
    if (grasp) grasps.push_back(*grasp);
  };
  for (int i = 0; i < headings; ++i) {
    const double heading = geometry::WrapToPi(2.0 * geometry::kPi * i / headings);
    for (const double height : finder.SideHeights()) add(finder.Side(heading, height));
    add(finder.Top(heading));
  }
  std::stable_sort(grasps.begin(), grasps.end(),
                   [](const Grasp& a, const Grasp& b) { return a.quality > b.quality; });
  return grasps;
}

}  // namespace hires::manipulation
