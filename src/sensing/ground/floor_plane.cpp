#include "sensing/ground/floor_plane.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

namespace hires::sensing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr int kPlanes = 60;           // with half of the points on the floor one is missed in 3000
constexpr std::size_t kRated = 2000;  // points by which planes are compared

bool IsAllowed(const FloorPlane& plane, const FloorParams& params) {
  return plane.slope.norm() <= std::tan(params.max_tilt) &&
         std::abs(plane.offset) <= params.max_offset;
}

std::optional<FloorPlane> PlaneThrough(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  constexpr double kThin = 0.01;  // [m^2] triangles that say nothing of the plane's slope
  const Vector3d n = (b - a).cross(c - a);
  if (std::abs(n.z()) < kThin) return std::nullopt;
  FloorPlane plane;
  plane.slope = -n.head<2>() / n.z();
  plane.offset = a.z() - plane.slope.dot(a.head<2>());
  return plane;
}

int CountNear(const FloorPlane& plane, const Points& points_B, double inlier) {
  return static_cast<int>(std::count_if(points_B.begin(), points_B.end(), [&](const Vector3d& p_B) {
    return std::abs(plane.HeightOf(p_B)) <= inlier;
  }));
}

/// The plane of least squares, along z, through the points near another one.
FloorPlane Fitted(const FloorPlane& near, const Points& points_B, double inlier) {
  Matrix3d squares = Matrix3d::Zero();
  Vector3d products = Vector3d::Zero();
  for (const Vector3d& p_B : points_B) {
    if (std::abs(near.HeightOf(p_B)) > inlier) continue;
    const Vector3d row(p_B.x(), p_B.y(), 1.0);
    squares += row * row.transpose();
    products += row * p_B.z();
  }
  const Vector3d solution = squares.ldlt().solve(products);
  FloorPlane plane;
  if (!solution.allFinite()) return near;
  plane.slope = solution.head<2>();
  plane.offset = solution.z();
  return plane;
}

/// Those that the allowed planes can reach.
Points Candidates(const Points& points_B, const FloorParams& params) {
  Points candidates;
  for (const Vector3d& p_B : points_B) {
    const double reach =
        params.max_offset + std::tan(params.max_tilt) * p_B.head<2>().norm() + params.inlier;
    if (std::abs(p_B.z()) <= reach) candidates.push_back(p_B);
  }
  return candidates;
}

}  // namespace

FloorPlane FindFloor(const Points& points_B, const FloorParams& params, base::Rng* rng) {
  const Points candidates = Candidates(points_B, params);
  if (static_cast<int>(candidates.size()) < params.min_points) return {};
  Points rated;
  const std::size_t stride = 1 + candidates.size() / kRated;
  for (std::size_t i = 0; i < candidates.size(); i += stride) rated.push_back(candidates[i]);
  const auto any = [&] { return rated[rng->Index(static_cast<int>(rated.size()))]; };
  FloorPlane best;
  int most = 0;
  for (int k = 0; k < kPlanes; ++k) {
    const Vector3d a = any(), b = any(), c = any();
    const auto plane = PlaneThrough(a, b, c);
    if (!plane || !IsAllowed(*plane, params)) continue;
    const int count = CountNear(*plane, rated, params.inlier);
    if (count <= most) continue;
    most = count;
    best = *plane;
  }
  if (most == 0) return {};
  for (int k = 0; k < 2; ++k) best = Fitted(best, candidates, params.inlier);
  best.num_points = CountNear(best, candidates, params.inlier);
  best.is_seen = IsAllowed(best, params) && best.num_points >= params.min_points &&
                 best.num_points >= params.min_share * static_cast<double>(candidates.size());
  return best.is_seen ? best : FloorPlane{};
}

}  // namespace hires::sensing
