#include "hires/perception/self_filter.h"

#include <algorithm>
#include <limits>

#include "hires/base/check.h"
#include "perception/self/shape_grid.h"

namespace hires::perception {
namespace {

using Eigen::Vector3f;

constexpr float kFar = 1e6f;  // [m] nothing measures as far

/// Calls visit(index) for the neighbours of a point in row and column.
template <typename Visit>
void VisitNeighbours(const PointCloud& cloud, int column, int row, const Visit& visit) {
  const int i = row * cloud.width + column;
  if (column > 0) visit(i - 1);
  if (column + 1 < cloud.width) visit(i + 1);
  if (row > 0) visit(i - cloud.width);
  if (row + 1 < cloud.height) visit(i + cloud.width);
}

/// Points next to one that is nearer to the sensor by more than `jump`.
std::vector<int> FindBehindEdges(const PointCloud& cloud, float jump) {
  std::vector<float> ranges(cloud.points.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) ranges[i] = cloud.points[i].norm();
  std::vector<int> found;
  for (int row = 0; row < cloud.height; ++row) {
    for (int column = 0; column < cloud.width; ++column) {
      const int i = row * cloud.width + column;
      const float limit = ranges[i] - jump;
      if (!(limit < kFar)) continue;  // not measured
      bool is_behind = false;
      VisitNeighbours(cloud, column, row, [&](int other) { is_behind |= ranges[other] < limit; });
      if (is_behind) found.push_back(i);
    }
  }
  return found;
}

}  // namespace

struct SelfFilter::Impl {
  SelfFilterParams params;
  MeshLibrary library;  // keeps what it has read
};

SelfFilter::SelfFilter(const SelfFilterParams& params) : impl_(new Impl{params, {}}) {}
SelfFilter::~SelfFilter() = default;
SelfFilter::SelfFilter(SelfFilter&&) noexcept = default;
SelfFilter& SelfFilter::operator=(SelfFilter&&) noexcept = default;

int SelfFilter::Cut(const std::vector<geometry::Collision>& shapes_S, PointCloud* cloud) {
  HIRES_CHECK(cloud->points.size() == static_cast<std::size_t>(cloud->width) * cloud->height,
              "a cloud's points are not its width times its height");
  const auto padding = static_cast<float>(impl_->params.padding);
  std::vector<PaddedShape> shapes;
  shapes.reserve(shapes_S.size());
  for (const geometry::Collision& shape_S : shapes_S) {
    impl_->library.Add(shape_S.shape);
    shapes.emplace_back(shape_S, impl_->library, padding);
  }
  const ShapeGrid grid(&shapes);
  std::vector<int> cut;
  for (const int i : FindBehindEdges(*cloud, static_cast<float>(impl_->params.jump))) {
    if (grid.HidesFromOrigin(cloud->points[i])) cut.push_back(i);
  }
  for (std::size_t i = 0; i < cloud->points.size(); ++i) {
    if (grid.Contains(cloud->points[i])) cut.push_back(static_cast<int>(i));
  }
  int num_cut = 0;
  for (const int i : cut) {
    if (IsMeasured(cloud->points[i])) ++num_cut;  // a point may be both
    cloud->points[i].setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  return num_cut;
}

}  // namespace hires::perception
