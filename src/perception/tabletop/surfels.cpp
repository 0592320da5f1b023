#include "perception/tabletop/surfels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

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

/// Numbers for cells, in the order in which they are first met: a hash table without deletion,
/// whose places follow each other in memory.
class CellNumbers {
 public:
  /// @param most  cells that there can be.
  explicit CellNumbers(std::size_t most) {
    while ((std::size_t{1} << bits_) < 2 * most) ++bits_;
    keys_.assign(std::size_t{1} << bits_, kFree);
    numbers_.resize(keys_.size());
  }
  /// The cell's number, new or old.
  int Of(const Cell& cell) {
    const std::uint64_t key = KeyOf(cell);
    const std::size_t place = PlaceOf(key);
    if (keys_[place] == kFree) {
      keys_[place] = key;
      numbers_[place] = count_++;
    }
    return numbers_[place];
  }
  /// -1: never met.
  int Find(const Cell& cell) const {
    const std::size_t place = PlaceOf(KeyOf(cell));
    return keys_[place] == kFree ? -1 : numbers_[place];
  }
  int count() const { return count_; }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // no key has all of its bits set

  std::size_t PlaceOf(std::uint64_t key) const {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio [Knuth, TAOCP 6.4]
    const std::size_t mask = keys_.size() - 1;
    std::size_t place = key * kGolden >> (64 - bits_);
    while (keys_[place] != kFree && keys_[place] != key) place = (place + 1) & mask;
    return place;
  }

  int bits_{4}, count_{0};
  std::vector<std::uint64_t> keys_;
  std::vector<int> numbers_;
};

void GroupPoints(const PointCloud& cloud, const std::vector<int>& indices, double cell,
                 SurfelCloud* out) {
  CellNumbers cells(indices.size());
  out->of_point.assign(cloud.points.size(), -1);
  for (const int i : indices) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    const int number = cells.Of(CellOf(p, cell));
    if (number == static_cast<int>(out->surfels.size())) out->surfels.emplace_back();
    Surfel& surfel = out->surfels[number];
    surfel.p_C += p;
    ++surfel.num_points;
    out->of_point[i] = number;
  }
  for (Surfel& surfel : out->surfels) surfel.p_C /= surfel.num_points;
}

void FindNeighbours(double radius, SurfelCloud* out) {
  const std::vector<Surfel>& surfels = out->surfels;
  CellNumbers numbers(surfels.size());
  std::vector<std::vector<int>> cells;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const int number = numbers.Of(CellOf(surfels[i].p_C, radius));
    if (number == static_cast<int>(cells.size())) cells.emplace_back();
    cells[number].push_back(static_cast<int>(i));
  }
  out->neighbours.resize(surfels.size());
  for (const std::vector<int>& members : cells) {
    const Cell cell = CellOf(surfels[members.front()].p_C, radius);
    for (int k = 0; k < 27; ++k) {
      const int beside = numbers.Find(cell + Cell(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
      if (beside < 0) continue;
      for (const int i : members) {
        for (const int j : cells[beside]) {
          if (j != i && (surfels[i].p_C - surfels[j].p_C).squaredNorm() < radius * radius)
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
  const double crowding = static_cast<double>(out.surfels.size()) / params.many;
  if (crowding > 1.0) {  // of a surface, by the square of the edge
    out.surfels.clear();
    GroupPoints(cloud, indices, std::min(params.cell * std::sqrt(crowding), params.max_cell), &out);
  }
  FindNeighbours(params.border_radius, &out);
  for (std::size_t i = 0; i < out.surfels.size(); ++i)
    out.surfels[i].normal = FitNormal(out, static_cast<int>(i), params.normal_radius);
  return out;
}

}  // namespace hires::perception
