#pragma once

#include <optional>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/segmentation_params.h"
#include "hires/perception/table.h"

namespace hires::perception {

constexpr int kLabelNone = 0;  ///< nothing measured, or of no thing
constexpr int kLabelTable = 1;
constexpr int kLabelFirstThing = 2;  ///< things are 2, 3, ...

struct Segmentation {
  std::optional<Table> table{};  ///< nothing: nothing is labelled
  std::vector<int> labels{};     ///< of each point of the cloud
  int num_things{0};
  /// Of each thing: whether the seen table ends before it. Things hide what follows: the table may
  /// go on there, and nothing that is seen speaks against it.
  std::vector<bool> may_be_beside{};
  int num_left_out{0};  ///< points clearly above the table, not far beside it, that are of no thing
  int num_over{
      0};  ///< where there is no thing: points above what is seen of the table, however high
};

/// Tells things on a table from it and from each other, without knowing them: what is above the
/// plane is divided along concave edges (FindConvexPatches), what is seen to stand elsewhere is
/// dropped (WithoutBeside), and parts are joined where one thing is seen in two (JoinParts). Points
/// beyond 10 m count as not measured.
/// @param stand  as FindTable takes it.
Segmentation SegmentTabletop(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                             const SegmentationParams& params, const base::Rng& rng);

/// The same on a table that is known.
Segmentation SegmentOn(const Table& table, const PointCloud& cloud,
                       const SegmentationParams& params, const base::Rng& rng);

}  // namespace hires::perception
