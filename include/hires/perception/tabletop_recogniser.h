#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/perception/recogniser.h"
#include "hires/perception/self_filter.h"

namespace hires::perception {

/// What a recogniser saw at a moment.
struct TabletopView {
  Sighting sighting{};    ///< in the cloud's frame
  int num_own_points{0};  ///< of the robot itself, which were cut out
  std::vector<int>
      thing_of{};       ///< of each point, index of the detection it is part of; -1: of none
  int num_left_out{0};  ///< points, see Segmentation
};

/// What was seen in a frame B, in another frame A.
Sighting SeenFrom(const geometry::Pose3& X_AB, Sighting seen_B);

/// A recogniser on a robot: it cuts the robot itself out of the cloud and knows how the camera
/// stands, so that no floor is taken for a table.
class TabletopRecogniser {
 public:
  TabletopRecogniser(std::shared_ptr<const Recogniser> recogniser, const SelfFilterParams& params);

  /// @param X_FC      the cloud's frame in any frame F whose z axis points upwards from the floor.
  /// @param robot_F   shapes of the robot, each called as its link (AddShapesOf).
  /// @param tray_link  whose widest shape is the plate of its tray: a small table of its own;
  ///                   empty, or not among the shapes: it has none.
  /// @return nothing where neither table nor tray is seen.
  std::optional<TabletopView> Look(PointCloud cloud, const geometry::Pose3& X_FC,
                                   const std::vector<geometry::Collision>& robot_F,
                                   const std::string& tray_link, const base::Rng& rng);

 private:
  Recognition OnTray(const geometry::Collision& tray_F, const geometry::Pose3& X_FC,
                     const std::vector<geometry::Collision>& others_C, PointCloud cloud,
                     const base::Rng& rng);

  std::shared_ptr<const Recogniser> recogniser_;
  SelfFilter self_;
};

}  // namespace hires::perception
