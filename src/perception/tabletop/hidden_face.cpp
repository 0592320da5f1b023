#include "perception/tabletop/hidden_face.h"

#include <algorithm>
#include <cmath>

namespace hires::perception {
namespace {

constexpr double kInFront = 0.005;        // [m] nearer to the camera than what it hides
constexpr double kStep = 0.01;            // [m] between places looked at, and of the table's cells
constexpr double kLowest = 0.05;          // of a part's surfels, below its lower end
constexpr std::size_t kLeastOnFace = 10;  // surfels of either part

std::pair<int, int> ColumnOf(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::floor(p.x() / kStep)), static_cast<int>(std::floor(p.y() / kStep))};
}

/// A plane's own two directions.
struct PlaneAxes {
  explicit PlaneAxes(const Face& face)
      : normal(face.normal),
        offset(face.offset),
        x(face.normal.unitOrthogonal()),
        y(face.normal.cross(x)) {}
  Eigen::Vector2d Drop(const Eigen::Vector3d& p_C) const { return {x.dot(p_C), y.dot(p_C)}; }
  Eigen::Vector3d Lift(const Eigen::Vector2d& p) const {
    return p.x() * x + p.y() * y - offset * normal;
  }
  Eigen::Vector3d normal;
  double offset;
  Eigen::Vector3d x, y;
};

std::vector<Eigen::Vector2d> OnFace(const SurfelCloud& all, const std::vector<int>& members,
                                    const Face& face, const PlaneAxes& axes, double tolerance) {
  std::vector<Eigen::Vector2d> out;
  for (const int i : members)
    if (face.Holds(all.surfels[i], tolerance)) out.push_back(axes.Drop(all.surfels[i].p_C));
  return out;
}

// Places within the hull of both outlines and in neither.
std::vector<Eigen::Vector2d> Between(const geometry::Polygon& a, const geometry::Polygon& b) {
  std::vector<Eigen::Vector2d> corners(a.begin(), a.end());
  corners.insert(corners.end(), b.begin(), b.end());
  Eigen::Vector2d lower = corners.front(), upper = lower;
  for (const Eigen::Vector2d& p : corners) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const geometry::Polygon both = geometry::ConvexHull(corners);
  std::vector<Eigen::Vector2d> out;
  for (double x = lower.x(); x < upper.x(); x += kStep) {
    for (double y = lower.y(); y < upper.y(); y += kStep) {
      const Eigen::Vector2d p(x, y);
      if (geometry::Contains(both, p) && !geometry::Contains(a, p) && !geometry::Contains(b, p))
        out.push_back(p);
    }
  }
  return out;
}

}  // namespace

HiddenFaces::HiddenFaces(const PointCloud& cloud, const Table& table, const SurfelCloud& all,
                         const SeenDepth& seen, std::vector<int> part)
    : cloud_(cloud), table_(table), all_(all), seen_(seen), part_(std::move(part)) {
  for (std::size_t i = 0; i < all.surfels.size(); ++i)
    columns_[ColumnOf(table.FromAbove(all.surfels[i].p_C))].push_back(static_cast<int>(i));
  std::map<int, std::vector<double>> heights;
  for (std::size_t i = 0; i < part_.size(); ++i)
    if (part_[i] >= 0) heights[part_[i]].push_back(table.HeightOf(all.surfels[i].p_C));
  for (auto& [one, of_one] : heights) {
    const auto low = of_one.begin() + static_cast<std::ptrdiff_t>(kLowest * of_one.size());
    std::nth_element(of_one.begin(), low, of_one.end());
    lowest_[one] = *low;
  }
}

// Another thing is seen straight above that reaches as low: it does not lie on what is hidden.
bool HiddenFaces::IsFilled(const Eigen::Vector3d& p_C, int a, int b) const {
  const auto column = columns_.find(ColumnOf(table_.FromAbove(p_C)));
  const double height = table_.HeightOf(p_C);
  return column != columns_.end() &&
         std::any_of(column->second.begin(), column->second.end(), [&](int i) {
           return part_[i] != a && part_[i] != b && table_.HeightOf(all_.surfels[i].p_C) > height &&
                  LowestOf(part_[i]) < height;
         });
}

double HiddenFaces::LowestOf(int part) const {
  const auto lowest = lowest_.find(part);
  return lowest == lowest_.end() ? 0.0 : lowest->second;
}

HiddenFaces::Place HiddenFaces::Look(const Eigen::Vector3d& p_C, int a, int b) const {
  const int point = p_C.z() > 0.0 ? seen_.PointTowards(p_C) : -1;
  if (point < 0) return Place::kUnknown;
  const double in_front = p_C.z() - cloud_.points[point].z();
  if (in_front < -kInFront) return Place::kOpen;
  const int surfel = all_.of_point[point];
  if (surfel >= 0 && (part_[surfel] == a || part_[surfel] == b)) return Place::kUnknown;
  return in_front <= kInFront || IsFilled(p_C, a, b) ? Place::kOpen : Place::kHidden;
}

double HiddenFaces::ShareHidden(const Face& face, const std::vector<int>& a,
                                const std::vector<int>& b, double tolerance) const {
  const PlaneAxes axes(face);
  const auto of_a = OnFace(all_, a, face, axes, tolerance);
  const auto of_b = OnFace(all_, b, face, axes, tolerance);
  if (of_a.size() < kLeastOnFace || of_b.size() < kLeastOnFace || LieOnOneLine(of_a) ||
      LieOnOneLine(of_b)) {
    return -1.0;
  }
  const auto between = Between(geometry::ConvexHull(of_a), geometry::ConvexHull(of_b));
  int hidden = 0, known = 0;
  for (const Eigen::Vector2d& p : between) {
    const Place place = Look(axes.Lift(p), part_[a.front()], part_[b.front()]);
    known += place != Place::kUnknown;
    hidden += place == Place::kHidden;
  }
  return known == 0 ? -1.0 : static_cast<double>(hidden) / known;
}

void HiddenFaces::Merge(int into, int from) {
  std::replace(part_.begin(), part_.end(), from, into);
}

}  // namespace hires::perception
