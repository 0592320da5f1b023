#include "hires/perception/tabletop_recogniser.h"

#include <utility>

namespace hires::perception {

TabletopRecogniser::TabletopRecogniser(std::shared_ptr<const Recogniser> recogniser,
                                       const SelfFilterParams& params)
    : recogniser_(std::move(recogniser)), self_(params) {}

std::optional<TabletopView> TabletopRecogniser::Look(
    PointCloud cloud, const geometry::Pose3& X_FC,
    const std::vector<geometry::Collision>& shapes_F, const base::Rng& rng) {
  const geometry::Pose3 X_CF = X_FC.Inverse();
  std::vector<geometry::Collision> shapes_C = shapes_F;
  for (geometry::Collision& shape : shapes_C) shape.X_BS = X_CF * shape.X_BS;
  TabletopView view;
  view.num_own_points = self_.Cut(shapes_C, &cloud);
  const CameraStand stand{X_CF.rotation * Eigen::Vector3d::UnitZ(), X_FC.translation.z()};
  Recognition seen = recogniser_->Recognise(cloud, stand, rng);
  if (!seen.segmentation.table) return std::nullopt;
  view.detections = std::move(seen.detections);
  const Table& table = *seen.segmentation.table;
  for (const Eigen::Vector2d& corner : table.outline) view.table.push_back(table.Lift(corner));
  return view;
}

}  // namespace hires::perception
