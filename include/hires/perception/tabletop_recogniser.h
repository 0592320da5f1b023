#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hires/perception/recogniser.h"
#include "hires/perception/self_filter.h"

namespace hires::perception {

/// What a recogniser saw at a moment, in the cloud's frame.
struct TabletopView {
  std::vector<Detection> detections{};
  std::vector<Eigen::Vector3d> table{};  ///< corners of its outline, as far as it is seen
  int num_own_points{0};                 ///< of the robot itself, which were cut out
};

/// A recogniser on a robot: it cuts the robot itself out of the cloud and knows how the camera
/// stands, so that no floor is taken for a table.
class TabletopRecogniser {
 public:
  TabletopRecogniser(std::shared_ptr<const Recogniser> recogniser, const SelfFilterParams& params);

  /// @param X_FC      the cloud's frame in any frame F whose z axis points upwards from the floor.
  /// @param shapes_F  of robot and load.
  /// @return nothing where no table is seen, or no point was measured.
  std::optional<TabletopView> Look(PointCloud cloud, const geometry::Pose3& X_FC,
                                   const std::vector<geometry::Collision>& shapes_F,
                                   const base::Rng& rng);

 private:
  std::shared_ptr<const Recogniser> recogniser_;
  SelfFilter self_;
};

}  // namespace hires::perception
