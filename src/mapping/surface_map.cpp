#include "mapping/surface_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hires::mapping {
namespace {

constexpr double kPieceCell = 0.1;   // [m]
constexpr double kFacesAlike = 0.7;  // cosine between normals
constexpr int kNear = 5;             // cells to either side
constexpr double kBorder = 0.5;      // [m] around all points

/// The quarter of the circle that a normal points to: two sides of a thin wall, and two walls of a
/// corner, are kept apart.
int QuarterOf(const Eigen::Vector2d& n) {
  if (std::abs(n.x()) >= std::abs(n.y())) return n.x() > 0.0 ? 0 : 2;
  return n.y() > 0.0 ? 1 : 3;
}

}  // namespace

SurfaceMap::SurfaceMap(const std::vector<PlacedPoints>& scans) {
  Eigen::Array2d lower = Eigen::Array2d::Constant(std::numeric_limits<double>::max());
  Eigen::Array2d upper = -lower;
  for (const PlacedPoints& scan : scans) {
    for (const SurfacePoint& point : *scan.points) {
      const Eigen::Array2d p = (scan.X_MB * point.p).array();
      lower = lower.min(p);
      upper = upper.max(p);
    }
  }
  if (upper.x() < lower.x()) return;
  lower_ = lower - kBorder;
  const Eigen::Array2d size = upper - lower + 2.0 * kBorder;
  nearness_ = Nearness(lower_, size);
  piece_width_ = static_cast<int>(std::ceil(size.x() / kPieceCell));
  piece_height_ = static_cast<int>(std::ceil(size.y() / kPieceCell));
  piece_of_.assign(std::size_t{4} * piece_width_ * piece_height_, -1);
  for (const PlacedPoints& scan : scans) {
    const geometry::Pose2 turn{0.0, 0.0, scan.X_MB.yaw};
    for (const SurfacePoint& point : *scan.points) {
      const Eigen::Vector2d p = scan.X_MB * point.p;
      nearness_.Stamp(p);
      if (point.has_normal()) AddPiece(p, turn * point.n);
    }
  }
  for (Piece& piece : pieces_) {
    piece.p /= piece.num_points;
    piece.n.normalize();
  }
}

void SurfaceMap::AddPiece(const Eigen::Vector2d& p, const Eigen::Vector2d& n) {
  const Eigen::Vector2d at = (p - lower_) / kPieceCell;
  const std::size_t cell =
      static_cast<std::size_t>(at.y()) * piece_width_ + static_cast<std::size_t>(at.x());
  std::int32_t& index = piece_of_[4 * cell + QuarterOf(n)];
  if (index < 0) {
    index = static_cast<std::int32_t>(pieces_.size());
    pieces_.emplace_back();
  }
  pieces_[index].p += p;
  pieces_[index].n += n;
  ++pieces_[index].num_points;
}

const SurfaceMap::Piece* SurfaceMap::Nearest(const Eigen::Vector2d& p,
                                             const Eigen::Vector2d& n) const {
  const Eigen::Vector2d at = (p - lower_) / kPieceCell;
  const int column = static_cast<int>(std::floor(at.x())),
            row = static_cast<int>(std::floor(at.y()));
  const Piece* nearest = nullptr;
  double best = std::numeric_limits<double>::max();
  for (int r = std::max(0, row - 1); r <= std::min(piece_height_ - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(piece_width_ - 1, column + 1); ++c) {
      const std::size_t cell = 4 * (static_cast<std::size_t>(r) * piece_width_ + c);
      for (int quarter = 0; quarter < 4; ++quarter) {
        const std::int32_t index = piece_of_[cell + quarter];
        if (index < 0 || pieces_[index].n.dot(n) < kFacesAlike) continue;
        const double distance = (pieces_[index].p - p).squaredNorm();
        if (distance >= best) continue;
        best = distance;
        nearest = &pieces_[index];
      }
    }
  }
  return nearest;
}

bool SurfaceMap::HasNear(const Eigen::Vector2d& p) const {
  const Eigen::Array2i at = ((p - lower_) / kPieceCell).array().floor().cast<int>();
  for (int row = std::max(0, at.y() - kNear); row <= std::min(piece_height_ - 1, at.y() + kNear);
       ++row) {
    for (int column = std::max(0, at.x() - kNear);
         column <= std::min(piece_width_ - 1, at.x() + kNear); ++column) {
      const auto first =
          piece_of_.begin() + 4 * (static_cast<std::ptrdiff_t>(row) * piece_width_ + column);
      if (std::any_of(first, first + 4, [](std::int32_t index) { return index >= 0; })) return true;
    }
  }
  return false;
}

}  // namespace hires::mapping
