#include "perception/self/shape_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hires::perception {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr float kCell = 0.08f;       // [m] near the quickest for a PR2; changes no result
constexpr float kMaxCells = 200.0f;  // along an axis; larger robots have larger cells

}  // namespace

ShapeGrid::ShapeGrid(const std::vector<PaddedShape>* shapes) : shapes_(*shapes) {
  for (const PaddedShape& shape : shapes_) {
    bounds_.extend(shape.bounds());
    if (!shape.Contains(Vector3f::Zero())) hiding_.push_back(&shape);
  }
  if (shapes_.empty()) return;
  cell_ = std::max(kCell, bounds_.sizes().maxCoeff() / kMaxCells);
  size_ = (bounds_.sizes() / cell_).cast<int>() + Vector3i::Ones();
  Fill();
}

void ShapeGrid::Fill() {
  const float reach = cell_ * std::sqrt(3.0f) / 2.0f;  // of a cell from its middle
  std::vector<std::pair<int, const PaddedShape*>> entries;
  for (const PaddedShape& shape : shapes_) {
    const Vector3f lower = (shape.bounds().min() - bounds_.min()) / cell_;
    const Vector3f upper = (shape.bounds().max() - bounds_.min()) / cell_;
    const auto last = [&](int axis) {
      return std::min(size_[axis] - 1, static_cast<int>(upper[axis]));
    };
    for (int z = static_cast<int>(lower.z()); z <= last(2); ++z) {
      for (int y = static_cast<int>(lower.y()); y <= last(1); ++y) {
        for (int x = static_cast<int>(lower.x()); x <= last(0); ++x) {
          const Vector3f middle =
              bounds_.min() + cell_ * (Vector3f(x, y, z) + Vector3f::Constant(0.5f));
          if (shape.IsWithin(middle, reach)) {
            entries.emplace_back((z * size_.y() + y) * size_.x() + x, &shape);
          }
        }
      }
    }
  }
  std::sort(entries.begin(), entries.end());
  first_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
  for (const auto& [cell, shape] : entries) {
    ++first_[cell + 1];
    candidates_.push_back(shape);
  }
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
}

bool ShapeGrid::Contains(const Vector3f& p_S) const {
  if (!bounds_.contains(p_S)) return false;  // nor NaN
  const Vector3i at = ((p_S - bounds_.min()) / cell_).cast<int>();
  const int cell = (at.z() * size_.y() + at.y()) * size_.x() + at.x();
  for (int i = first_[cell]; i < first_[cell + 1]; ++i) {
    if (candidates_[i]->Contains(p_S)) return true;
  }
  return false;
}

bool ShapeGrid::HidesFromOrigin(const Vector3f& p_S) const {
  return std::any_of(hiding_.begin(), hiding_.end(),
                     [&](const PaddedShape* shape) { return shape->IsCrossed(p_S); });
}

}  // namespace hires::perception
