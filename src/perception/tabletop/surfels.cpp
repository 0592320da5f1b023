#include "perception/tabletop/surfels.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "hires/base/check.h"

namespace hires::perception {
namespace {

using Cell = Eigen::Vector3i;

Cell CellOf(const Eigen::Vector3d& p, double edge) {
  return (p / edge).array().floor().cast<int>();
}

// 21 bits for each coordinate: 2 million cells, 10 km of 5 mm.
std::uint64_t KeyOf(const Cell& cell) {
  const auto part = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)) & 0x1fffff; };
  return part(cell.x()) << 42 | part(cell.y()) << 21 | part(cell.z());
}

void GroupPoints(const PointCloud& cloud, const std::vector<int>& indices, double cell,
                 SurfelCloud* out) {
  std::unordered_map<std::uint64_t, int> of_cell;
  out->of_point.assign(cloud.points.size(), -1);
  for (const int i : indices) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    const auto [it, is_new] =
        of_cell.emplace(KeyOf(CellOf(p, cell)), static_cast<int>(out->surfels.size()));
    if (is_new) out->surfels.emplace_back();
    Surfel& surfel = out->surfels[it->second];
    surfel.p_C += p;
    ++surfel.num_points;
    out->of_point[i] = it->second;
  }
  for (Surfel& surfel : out->surfels) surfel.p_C /= surfel.num_points;
}

void FindNeighbours(double radius, SurfelCloud* out) {
  const std::vector<Surfel>& surfels = out->surfels;
  std::unordered_map<std::uint64_t, std::vector<int>> cells;
  for (std::size_t i = 0; i < surfels.size(); ++i)
    cells[KeyOf(CellOf(surfels[i].p_C, radius))].push_back(static_cast<int>(i));
  out->neighbours.resize(surfels.size());
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const Cell cell = CellOf(surfels[i].p_C, radius);
    for (int k = 0; k < 27; ++k) {
      const auto it = cells.find(KeyOf(cell + Cell(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (it == cells.end()) continue;
      for (const int j : it->second) {
        if (j != static_cast<int>(i) &&
            (surfels[i].p_C - surfels[j].p_C).squaredNorm() < radius * radius) {
          out->neighbours[i].push_back(j);
        }
      }
    }
  }
}

// The direction in which the points around a surfel spread least.
Eigen::Vector3d FitNormal(const SurfelCloud& all, int i, double radius) {
  const Eigen::Vector3d& centre = all.surfels[i].p_C;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double n = all.surfels[i].num_points;
  for (const int j : all.neighbours[i]) {
    const Eigen::Vector3d d = all.surfels[j].p_C - centre;
    if (d.squaredNorm() >= radius * radius) continue;
    const double weight = all.surfels[j].num_points;
    sum += weight * d;
    moments += weight * d * d.transpose();
    n += weight;
  }
  const Eigen::Vector3d mean = sum / n;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments / n - mean * mean.transpose());
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return normal.dot(centre) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace

SurfelCloud MakeSurfels(const PointCloud& cloud, const std::vector<int>& indices,
                        const SurfelParams& params) {
  HIRES_CHECK(params.border_radius >= params.normal_radius, "normals need a surfel's neighbours");
  SurfelCloud out;
  GroupPoints(cloud, indices, params.cell, &out);
  FindNeighbours(params.border_radius, &out);
  for (std::size_t i = 0; i < out.surfels.size(); ++i)
    out.surfels[i].normal = FitNormal(out, static_cast<int>(i), params.normal_radius);
  return out;
}

}  // namespace hires::perception
