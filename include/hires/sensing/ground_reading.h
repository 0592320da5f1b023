#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace hires::sensing {

/// The plane z = slope . (x, y) + offset in the frame of the base.
struct FloorPlane {
  Eigen::Vector2d slope{0.0, 0.0};
  double offset{0.0};   ///< [m]
  bool is_seen{false};  ///< else it is the base's own z = 0, as too little of a floor was seen
  int num_points{0};    ///< that it rests on

  double HeightOf(const Eigen::Vector3d& p_B) const {  ///< [m] over it, along the base's z axis
    return p_B.z() - slope.dot(p_B.head<2>()) - offset;
  }
};

/// Column and row in a grid through the map's origin.
using GroundCell = std::pair<long, long>;

/// A cell in which something stands out of the floor, or a hole begins.
struct GroundSpot {
  GroundCell cell;
  Eigen::Vector2d p_M{0.0, 0.0};  ///< [m] middle of what was seen
  double lowest{0.0};             ///< [m] over the floor, of what was seen; below 0 in a hole
  double highest{0.0};            ///< [m] likewise
};

/// What a cloud shows of the way.
struct GroundReading {
  FloorPlane floor;
  Eigen::Vector3d eye_M{0.0, 0.0, 0.0};  ///< [m] from where; z: over the floor
  std::vector<GroundSpot> spots;         ///< beyond the map, by cell
  std::vector<GroundCell> clear;         ///< where the floor is seen and nothing else, by cell
};

}  // namespace hires::sensing
