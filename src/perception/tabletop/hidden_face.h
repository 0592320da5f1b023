#pragma once

#include <map>
#include <utility>
#include <vector>

#include "hires/perception/table.h"
#include "perception/tabletop/part_shape.h"
#include "perception/tabletop/seen_depth.h"
#include "perception/tabletop/surfels.h"

namespace hires::perception {

/// Where surfaces may go on unseen between parts that are seen.
class HiddenFaces {
 public:
  /// @param part  of each surfel; -1: of none.
  HiddenFaces(const PointCloud& cloud, const Table& table, const SurfelCloud& all,
              const SeenDepth& seen, std::vector<int> part);

  /// How much of a face between two parts on it, in its plane within the convex hull of both, is
  /// hidden from the camera by something else that is in front and does not itself fill the place,
  /// as a box does between its top and its foot. Places where nothing was measured, or one of the
  /// two parts, say nothing.
  /// @return 0 .. 1; -1: too little of the parts is on the face, or nothing is between them.
  double ShareHidden(const Face& face, const std::vector<int>& a, const std::vector<int>& b,
                     double tolerance) const;

  void Merge(int into, int from);  ///< parts that were found to be one

 private:
  enum class Place { kHidden, kOpen, kUnknown };
  Place Look(const Eigen::Vector3d& p_C, int a, int b) const;
  double LowestOf(int part) const;
  bool IsFilled(const Eigen::Vector3d& p_C, int a, int b) const;

  const PointCloud& cloud_;
  const Table& table_;
  const SurfelCloud& all_;
  const SeenDepth& seen_;
  std::vector<int> part_;
  std::map<std::pair<int, int>, std::vector<int>> columns_;  // surfels above cells of the table
  std::map<int, double> lowest_;                             // [m] lower end of each part
};

}  // namespace hires::perception
