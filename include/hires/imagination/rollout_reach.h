#pragma once

#include <Eigen/Core>
#include <vector>

namespace hires::imagination {

/// Which part of the room a rollout depends on: what stands apart from all of its discs was left
/// out of it, wherever it stood, and so cannot have changed it.
struct RolloutReach {
  struct Disc {
    Eigen::Vector2d p_M;  ///< [m]
    double radius;        ///< [m]
  };
  bool is_everything{true};  ///< nothing was left out
  std::vector<Disc> discs;   ///< seen from above; heights do not matter

  /// Whether a disc touches one of them.
  bool Touches(const Disc& other) const;
};

}  // namespace hires::imagination
