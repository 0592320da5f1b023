#include "mapping/nearness.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hires::mapping {
namespace {

constexpr double kSd = 0.06;  // [m]
constexpr int kReach = 3;     // cells to either side

using NearnessStamp = std::array<std::uint8_t, (2 * kReach + 1) * (2 * kReach + 1)>;

NearnessStamp MakeStamp() {
  NearnessStamp stamp{};
  std::size_t i = 0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx, ++i) {
      const double d = Nearness::kCell * std::hypot(dx, dy) / kSd;
      stamp[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::exp(-0.5 * d * d)));
    }
  }
  return stamp;
}

}  // namespace

Nearness::Nearness(const Eigen::Array2d& lower, const Eigen::Array2d& size)
    : lower_(lower),
      width_(static_cast<int>(std::ceil(size.x() / kCell))),
      height_(static_cast<int>(std::ceil(size.y() / kCell))),
      cells_(static_cast<std::size_t>(width_) * height_, 0) {}

void Nearness::Stamp(const Eigen::Vector2d& p) {
  static const NearnessStamp kStamp = MakeStamp();
  const Eigen::Array2i at = CellOf(p);
  if (At(at.x(), at.y()) == 255) return;  // stamped before
  std::size_t i = 0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx, ++i) {
      std::uint8_t& cell = cells_[static_cast<std::size_t>(at.y() + dy) * width_ + at.x() + dx];
      cell = std::max(cell, kStamp[i]);
    }
  }
}

Nearness Nearness::MostOfSquares(int edge) const {
  Nearness most;
  most.lower_ = lower_;
  most.before_ = edge;
  most.width_ = width_ + edge;
  most.height_ = height_ + edge;
  const auto size = static_cast<std::size_t>(most.width_) * most.height_;
  most.cells_.assign(size, 0);
  for (int row = 0; row < height_; ++row) {
    std::copy_n(cells_.begin() + static_cast<std::ptrdiff_t>(row) * width_, width_,
                most.cells_.begin() + static_cast<std::ptrdiff_t>(row + edge) * most.width_ + edge);
  }
  // Squares of twice the edge from four of half. Those at a row's end go on in the next row's
  // first cells, which are 0 as far as they reach.
  for (int half = 1; half < edge; half *= 2) {
    for (const std::size_t ahead :
         {static_cast<std::size_t>(half), static_cast<std::size_t>(half) * most.width_}) {
      for (std::size_t i = 0; i + ahead < size; ++i)
        most.cells_[i] = std::max(most.cells_[i], most.cells_[i + ahead]);
    }
  }
  return most;
}

}  // namespace hires::mapping
