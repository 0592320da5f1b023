#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace hires::mapping {

/// How near each cell of a plane is to what was measured: 255 on a measured point, less within
/// 0.15 m of one, 0 elsewhere and beside the grid.
class Nearness {
 public:
  static constexpr double kCell = 0.05;  ///< [m]

  Nearness() = default;
  /// @param lower  [m] corner of the first cell.
  /// @param size  [m]
  Nearness(const Eigen::Array2d& lower, const Eigen::Array2d& size);

  /// @pre at least 0.2 m within the border.
  void Stamp(const Eigen::Vector2d& p);

  /// Column and row, which may be beside the grid.
  Eigen::Array2i CellOf(const Eigen::Vector2d& p) const {
    return ((p.array() - lower_) / kCell).floor().cast<int>();
  }
  int At(int column, int row) const {
    const int x = column + before_, y = row + before_;
    const bool is_within = x >= 0 && y >= 0 && x < width_ && y < height_;
    return is_within ? cells_[static_cast<std::size_t>(y) * width_ + x] : 0;
  }
  /// Each cell the most of the square of `edge` cells that begins with it; also of the squares that
  /// begin beside the grid.  @param edge  a power of 2
  Nearness MostOfSquares(int edge) const;

 private:
  Eigen::Array2d lower_{Eigen::Array2d::Zero()};
  int before_{0};             // cells that are kept before the first column and row
  int width_{0}, height_{0};  // cells that are kept
  std::vector<std::uint8_t> cells_;
};

}  // namespace hires::mapping
