#pragma once

#include <cstdint>
#include <vector>

#include "hires/geometry/pose.h"
#include "mapping/nearness.h"
#include "mapping/scan_points.h"

namespace hires::mapping {

/// Points of a keyframe and where it stands.
struct PlacedPoints {
  const SurfacePoints* points{nullptr};
  geometry::Pose2 X_MB;
};

/// What several scans met, as small pieces of wall: in each cell of 0.1 m the mean of the points
/// that face one way and of their normals; and how near any point of the plane is to it.
class SurfaceMap {
 public:
  struct Piece {
    Eigen::Vector2d p{Eigen::Vector2d::Zero()};  ///< [m] mean of the points
    Eigen::Vector2d n{Eigen::Vector2d::Zero()};  ///< unit normal towards where it was seen from
    int num_points{0};
  };

  explicit SurfaceMap(const std::vector<PlacedPoints>& scans);

  /// The nearest piece that faces as `n` within the cells around; nullptr if there is none.
  const Piece* Nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& n) const;

  /// Whether a piece lies within some 0.5 m.
  bool HasNear(const Eigen::Vector2d& p) const;

  const Nearness& nearness() const { return nearness_; }

 private:
  void AddPiece(const Eigen::Vector2d& p, const Eigen::Vector2d& n);

  Eigen::Vector2d lower_{Eigen::Vector2d::Zero()};
  Nearness nearness_;
  int piece_width_{0}, piece_height_{0};  // cells of pieces
  std::vector<std::int32_t> piece_of_;    // by cell and quarter that it faces; -1: none
  std::vector<Piece> pieces_;
};

}  // namespace hires::mapping
