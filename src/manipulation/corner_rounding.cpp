#include "manipulation/corner_rounding.h"

#include <algorithm>
#include <cmath>

namespace hires::manipulation {
namespace {

constexpr int kMaxHalvings = 4;
constexpr double kPointDistance = 0.04;  // [rad] largest joint step between points of a parabola
constexpr int kMaxPoints = 32;

/// Points of the parabola that touches both sides of the corner at `from` and `to`.
std::vector<ArmJoints> Parabola(const ArmJoints& from, const ArmJoints& corner,
                                const ArmJoints& to) {
  const double way = LargestDifference(from, corner) + LargestDifference(corner, to);
  const int steps = std::clamp(static_cast<int>(std::ceil(way / kPointDistance)), 2, kMaxPoints);
  std::vector<ArmJoints> points;
  for (int i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(i) / steps;
    points.push_back(Between(Between(from, corner, u), Between(corner, to, u), u));
  }
  return points;
}

bool IsWayFree(const MotionCheck& check, const std::vector<ArmJoints>& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!check.IsFree(points[i]) || !check.IsFree(points[i - 1], points[i])) return false;
  }
  return true;
}

std::vector<ArmJoints> RoundedCorner(const MotionCheck& check, const ArmJoints& before,
                                     const ArmJoints& corner, const ArmJoints& after) {
  double share = 0.5;  // of each side: half of it belongs to the neighbouring corner
  for (int i = 0; i < kMaxHalvings; ++i, share *= 0.5) {
    auto points = Parabola(Between(corner, before, share), corner, Between(corner, after, share));
    if (IsWayFree(check, points)) return points;
  }
  return {corner};
}

}  // namespace

std::vector<ArmJoints> RoundCorners(const MotionCheck& check, const std::vector<ArmJoints>& path) {
  if (path.size() < 3) return path;
  std::vector<ArmJoints> rounded{path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    for (ArmJoints& point : RoundedCorner(check, path[i - 1], path[i], path[i + 1])) {
      if (LargestDifference(point, rounded.back()) > 0.0) rounded.push_back(std::move(point));
    }
  }
  rounded.push_back(path.back());
  return rounded;
}

}  // namespace hires::manipulation
