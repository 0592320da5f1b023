#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::mapping {

/// Poses and what was measured between them.
class PoseGraph {
 public:
  struct Edge {
    int from{0}, to{0};
    geometry::Pose2 X_FT;         ///< measured
    Eigen::Matrix3d information;  ///< of x, y in `from` [m] and yaw [rad]
    bool may_be_wrong{false};     ///< then it counts the less the more it disagrees with the rest
  };

  /// @return its number, from 0 on; the first one stays where it is.
  int AddPose(const geometry::Pose2& X_M);
  /// @pre both poses are there.
  void AddEdge(const Edge& edge);

  /// Adds an edge that may be wrong, and moves the poses to where all are met best.
  /// @param is_large  it is met first, and kept to if more edges are believed then: however soft
  ///     the rest is, it would else be overruled for its distance alone.
  /// @return false for a large one that is not kept to.
  bool CloseLoop(Edge edge, bool is_large);

  /// Moves all poses but the first to where the edges are met best, by Gauss-Newton.
  /// @return the largest shift of a pose [m].
  double Optimise(int most_iterations = 10);

  const geometry::Pose2& pose(int i) const { return poses_[i]; }
  int size() const { return static_cast<int>(poses_.size()); }

 private:
  double Step();
  int NumBelieved() const;  ///< of those that may be wrong

  std::vector<geometry::Pose2> poses_;
  std::vector<Edge> edges_;
};

}  // namespace hires::mapping
