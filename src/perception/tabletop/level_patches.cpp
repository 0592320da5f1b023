#include "perception/tabletop/level_patches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "hires/perception/depth_sensor.h"

namespace hires::perception {
namespace {

constexpr std::size_t kPatches = 400;      // points that are looked about
constexpr double kPatchReach = 0.1;        // of the distance from the camera
constexpr double kNearestPatch = 0.8;      // [m] below, it stays as it is there
constexpr std::size_t kFewestPoints = 12;  // of a patch, for its scatter to be worth something
constexpr double kMostFlat = 0.25;         // of its variances; else it is no surface
constexpr float kBesideHalf = 1.5F;        // lengths of the shortest half beside it: 2.7 sd in all
constexpr double kOnPlane = 0.25;          // of its reach, up to which its middle is on a plane
constexpr std::size_t kFewestPatches = 8;  // on a plane, that tell its scatter

/// Points in columns, for many distances at once.
class PatchPoints {
 public:
  explicit PatchPoints(const std::vector<Eigen::Vector3d>& points)
      : x_(points.size()), y_(points.size()), z_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      x_[k] = static_cast<float>(points[i].x());
      y_[k] = static_cast<float>(points[i].y());
      z_[k] = static_cast<float>(points[i].z());
    }
  }
  std::optional<LevelPatch> About(const Eigen::Vector3d& p_C, const Eigen::Vector3d& up_C,
                                  double least_cosine);

 private:
  Eigen::ArrayXf x_, y_, z_, squares_;  // of distances, each time
};

/// Within the shortest interval that holds half of them, and twice as far again on either side:
/// all of a level surface but for what is beside it.
std::pair<float, float> Densest(std::vector<float> heights) {
  std::sort(heights.begin(), heights.end());
  const std::size_t half = heights.size() / 2;
  std::size_t best = 0;
  for (std::size_t i = 0; i + half < heights.size(); ++i)
    if (heights[i + half] - heights[i] < heights[best + half] - heights[best]) best = i;
  const float length = heights[best + half] - heights[best];
  return {heights[best] - kBesideHalf * length, heights[best + half] + kBesideHalf * length};
}

std::optional<LevelPatch> PatchPoints::About(const Eigen::Vector3d& p_C,
                                             const Eigen::Vector3d& up_C, double least_cosine) {
  LevelPatch patch;
  patch.reach = kPatchReach * std::max(kNearestPatch, p_C.z());
  const Eigen::Vector3f p = p_C.cast<float>(), up = up_C.cast<float>();
  squares_ = (x_ - p.x()).square() + (y_ - p.y()).square() + (z_ - p.z()).square();
  const auto most = static_cast<float>(patch.reach * patch.reach);
  std::vector<Eigen::Vector3f> near;
  std::vector<float> heights;
  for (Eigen::Index k = 0; k < squares_.size(); ++k) {
    if (squares_[k] >= most) continue;
    near.emplace_back(x_[k] - p.x(), y_[k] - p.y(), z_[k] - p.z());
    heights.push_back(up.dot(near.back()));
  }
  if (near.size() < kFewestPoints) return std::nullopt;
  const auto [lower, upper] = Densest(heights);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double n = 0.0;
  for (std::size_t k = 0; k < near.size(); ++k) {
    if (heights[k] < lower || heights[k] > upper) continue;
    const Eigen::Vector3d d = near[k].cast<double>();
    sum += d;
    moments += d * d.transpose();
    n += 1.0;
  }
  const Eigen::Vector3d mean = sum / n;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments / n - mean * mean.transpose());
  const Eigen::Vector3d variances = solver.eigenvalues().cwiseMax(0.0);
  const bool is_level = std::abs(solver.eigenvectors().col(0).dot(up_C)) >= least_cosine;
  if (!is_level || variances[0] > kMostFlat * variances[1]) return std::nullopt;
  patch.p_C = p_C + mean;
  patch.scatter = std::sqrt(variances[0] * n / (n - 3.0));  // of three numbers of a plane
  return patch;
}

}  // namespace

std::vector<LevelPatch> LevelPatchesIn(const std::vector<Eigen::Vector3d>& points,
                                       const Eigen::Vector3d& up_C, double max_inclination) {
  PatchPoints about(points);
  std::vector<LevelPatch> patches;
  const std::size_t step = points.size() / kPatches + 1;
  for (std::size_t k = 0; k < points.size(); k += step) {
    if (const auto patch = about.About(points[k], up_C, std::cos(max_inclination)))
      patches.push_back(*patch);
  }
  return patches;
}

double ScatterOf(const std::vector<LevelPatch>& patches) {
  if (patches.size() < kFewestPatches) return 0.0;
  std::vector<double> scatters;
  for (const LevelPatch& patch : patches)
    scatters.push_back(patch.scatter / DepthNoise(patch.p_C.z()));
  const auto quartile = scatters.begin() + static_cast<std::ptrdiff_t>(scatters.size() / 4);
  std::nth_element(scatters.begin(), quartile, scatters.end());
  return *quartile;
}

double ScatterOn(const std::vector<LevelPatch>& patches, const Eigen::Vector3d& up_C,
                 double offset) {
  std::vector<LevelPatch> on_it;
  for (const LevelPatch& patch : patches)
    if (std::abs(up_C.dot(patch.p_C) + offset) < kOnPlane * patch.reach) on_it.push_back(patch);
  return ScatterOf(on_it);
}

}  // namespace hires::perception
