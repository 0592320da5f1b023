#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace hires::sensing {

struct SeenKind {
  std::string kind{};
  double doubt{0.0};  ///< [m] by which an instance of it counts as farther away than it is
};

/// A thing that a recogniser sees and of which it knows the kind alone.
struct SeenThing {
  std::vector<SeenKind> kinds{};  ///< that it may be
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

/// How badly a thing fits an instance [m]: the distance to where it is expected, and the doubt of
/// its kind. None if the thing is of other kinds, or if the sum is more than `reach` [m].
std::optional<double> CostOf(const SeenThing& thing, const Anchor& anchor, double reach);

/// Which thing is which instance: the assignment with the least sum of distances and doubts (global
/// nearest neighbour), in which a thing that has no CostOf any instance stays alone. A pair without
/// which the best sum is hardly worse is not certain.
/// @param reach   [m]
/// @param margin  [m] by which the best sum must be better.
Anchoring AnchorThings(const std::vector<SeenThing>& things, const std::vector<Anchor>& anchors,
                       double reach, double margin);

}  // namespace hires::sensing
