#include "perception/tabletop/part_shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hires::perception {
namespace {

constexpr int kMostFaces = 3;
constexpr int kFaceSamples = 60;
constexpr int kMinFaceSurfels = 20;
constexpr double kMinFaceShare = 0.15;
constexpr double kSameDirection = 0.95;  // cosine, 18 degrees: what noise does to normals
constexpr double kHighest = 0.98;
constexpr double kWall = 0.5;  // sine of 30 degrees: steeper surfaces are walls

Face FitFace(const SurfelCloud& all, const std::vector<int>& members,
             const Eigen::Vector3d& direction) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int i : members) mean += all.surfels[i].p_C;
  mean /= static_cast<double>(members.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const int i : members) {
    const Eigen::Vector3d d = all.surfels[i].p_C - mean;
    moments += d * d.transpose();
  }
  Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  if (normal.dot(direction) < 0.0) normal = -normal;
  return {normal, -normal.dot(mean)};
}

}  // namespace

bool LieOnOneLine(const std::vector<Eigen::Vector2d>& points) {
  const Eigen::Vector2d& a = points.front();
  const auto b = std::max_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
    return (p - a).squaredNorm() < (q - a).squaredNorm();
  });
  const Eigen::Vector2d along = *b - a;
  return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
    return std::abs(along.x() * (p - a).y() - along.y() * (p - a).x()) < 1e-9;
  });
}

bool Face::Holds(const Surfel& surfel, double tolerance) const {
  return std::abs(normal.dot(surfel.p_C) + offset) < tolerance &&
         normal.dot(surfel.normal) > kSameDirection;
}

std::optional<PartShape> ShapeOf(const SurfelCloud& all, const std::vector<int>& members,
                                 const Table& table) {
  std::vector<Eigen::Vector2d> from_above;
  std::vector<double> heights;
  for (const int i : members) {
    from_above.push_back(table.FromAbove(all.surfels[i].p_C));
    heights.push_back(table.HeightOf(all.surfels[i].p_C));
  }
  if (from_above.size() < 3 || LieOnOneLine(from_above)) return std::nullopt;
  PartShape shape;
  shape.outline = geometry::ConvexHull(from_above);
  for (const Eigen::Vector2d& corner : shape.outline) shape.middle += corner;
  shape.middle /= static_cast<double>(shape.outline.size());
  const auto highest = heights.begin() + static_cast<std::ptrdiff_t>(kHighest * heights.size());
  std::nth_element(heights.begin(), highest, heights.end());
  shape.top = *highest;
  double inward = 0.0, sideways = 0.0;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Eigen::Vector2d normal = table.FromAbove(all.surfels[members[k]].normal);
    const double towards = normal.dot((shape.middle - from_above[k]).normalized());
    inward += towards;
    sideways += normal.norm();
    if (towards > kWall) shape.inner_share += 1.0 / static_cast<double>(members.size());
  }
  shape.inward = sideways > 0.0 ? inward / sideways : 0.0;
  return shape;
}

std::vector<Face> FacesOf(const SurfelCloud& all, std::vector<int> members, double tolerance,
                          base::Rng rng) {
  const auto least = std::max<std::size_t>(
      kMinFaceSurfels, static_cast<std::size_t>(kMinFaceShare * members.size()));
  std::vector<Face> faces;
  while (faces.size() < kMostFaces && members.size() > kMinFaceSurfels) {
    Face best{};
    std::ptrdiff_t most = 0;
    for (int k = 0; k < kFaceSamples; ++k) {
      const Surfel& sample = all.surfels[members[rng.Index(static_cast<int>(members.size()))]];
      const Face face{sample.normal, -sample.normal.dot(sample.p_C)};
      const auto held = std::count_if(members.begin(), members.end(),
                                      [&](int i) { return face.Holds(all.surfels[i], tolerance); });
      if (held <= most) continue;
      most = held;
      best = face;
    }
    if (static_cast<std::size_t>(most) < least) break;
    const auto rest = std::stable_partition(members.begin(), members.end(), [&](int i) {
      return best.Holds(all.surfels[i], tolerance);
    });
    faces.push_back(FitFace(all, {members.begin(), rest}, best.normal));
    members.erase(members.begin(), rest);
  }
  return faces;
}

}  // namespace hires::perception
