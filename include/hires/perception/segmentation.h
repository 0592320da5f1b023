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
};

/// Tells things on a table from it and from each other, without knowing them: what is above the
/// plane is divided along concave edges (FindConvexParts) and joined where one thing is seen in two
/// parts (JoinParts).
/// @param stand  as FindTable takes it.
Segmentation SegmentTabletop(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                             const SegmentationParams& params, const base::Rng& rng);

/// The same on a table that is known.
Segmentation SegmentOn(const Table& table, const PointCloud& cloud,
                       const SegmentationParams& params, const base::Rng& rng);

}  // namespace hires::perception
