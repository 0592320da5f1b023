#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hires::sensing {

/// A thing that a recogniser sees and of which it knows the kind alone.
struct SeenThing {
  std::vector<std::string> kinds{};  ///< that it may be, the likeliest first
  Eigen::Vector3d p_M{Eigen::Vector3d::Zero()};
};

/// An instance that may be what is seen.
struct Anchor {
  std::string kind{};
  Eigen::Vector3d p_M{Eigen::Vector3d::Zero()};  ///< where it is expected
};

struct Anchoring {
  std::vector<int> anchor{};         ///< of each thing; -1: of none, or not certain
  std::vector<bool> is_ambiguous{};  ///< of each thing: another assignment is nearly as good
};

/// Which thing is which instance: the assignment with the least sum of distances (global nearest
/// neighbour), in which a thing that is farther than `reach` from all instances of its kinds stays
/// alone. A pair without which the best sum is hardly worse is not certain.
/// @param reach   [m]
/// @param margin  [m] by which the best sum must be better.
Anchoring AnchorThings(const std::vector<SeenThing>& things, const std::vector<Anchor>& anchors,
                       double reach, double margin);

}  // namespace hires::sensing
