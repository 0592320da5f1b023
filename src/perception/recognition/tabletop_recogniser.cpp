#include "hires/perception/tabletop_recogniser.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace hires::perception {
namespace {

constexpr long kTrayPoints = 200;  // of tray and things on it, for it to be seen

/// A tray's plate is larger than its rims.
std::optional<geometry::Collision> PlateOf(const std::string& tray_link,
                                           const std::vector<geometry::Collision>& robot_F) {
  std::optional<geometry::Collision> plate;
  double widest = 0.0;  // [m2]
  for (const geometry::Collision& shape : robot_F) {
    if (shape.name != tray_link) continue;
    const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, shape.X_BS);
    const double area = (bounds.upper - bounds.lower).head<2>().prod();
    if (!plate || area > widest) {
      plate = shape;
      widest = area;
    }
  }
  return plate;
}

/// @param num_before  detections that others of the labels do not count.
void NoteThings(const std::vector<int>& labels, int num_before, std::vector<int>* thing_of) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] >= kLabelFirstThing) (*thing_of)[i] = num_before + labels[i] - kLabelFirstThing;
  }
}

}  // namespace

Sighting SeenFrom(const geometry::Pose3& X_AB, Sighting seen_B) {
  for (Detection& detection : seen_B.detections) detection.X_CO = X_AB * detection.X_CO;
  for (Eigen::Vector3d& corner : seen_B.table) corner = X_AB * corner;
  return seen_B;
}

TabletopRecogniser::TabletopRecogniser(std::shared_ptr<const Recogniser> recogniser,
                                       const SelfFilterParams& params)
    : recogniser_(std::move(recogniser)), self_(params) {}

/// The robot's own tray cannot be found by its points alone: they are the robot's. Its plate says
/// about where it is, the cloud whether and where it is seen.
Recognition TabletopRecogniser::OnTray(const geometry::Collision& tray_F,
                                       const geometry::Pose3& X_FC,
                                       const std::vector<geometry::Collision>& others_C,
                                       PointCloud cloud, const base::Rng& rng) {
  self_.Cut(others_C, &cloud);
  const geometry::Pose3 X_CF = X_FC.Inverse();
  const geometry::Aabb plate = geometry::BoundsOf(tray_F.shape, tray_F.X_BS);
  Table table;
  table.normal = X_CF.rotation * Eigen::Vector3d::UnitZ();
  table.offset = X_FC.translation.z() - plate.upper.z();
  table.along_x = table.normal.unitOrthogonal();
  table.along_y = table.normal.cross(table.along_x);
  const Eigen::Vector3d &low = plate.lower, &high = plate.upper;
  for (const auto& [x, y] : {std::pair(low.x(), low.y()), std::pair(high.x(), low.y()),
                             std::pair(high.x(), high.y()), std::pair(low.x(), high.y())}) {
    table.outline.push_back(table.FromAbove(X_CF * Eigen::Vector3d(x, y, high.z())));
  }
  Recognition found = recogniser_->RecogniseOn(table, cloud, rng);
  const std::vector<int>& labels = found.segmentation.labels;
  const auto num_nothing = std::count(labels.begin(), labels.end(), kLabelNone);
  if (static_cast<long>(labels.size()) - num_nothing < kTrayPoints) return {};
  return found;
}

std::optional<TabletopView> TabletopRecogniser::Look(
    PointCloud cloud, const geometry::Pose3& X_FC, const std::vector<geometry::Collision>& robot_F,
    const std::string& tray_link, const base::Rng& rng) {
  const geometry::Pose3 X_CF = X_FC.Inverse();
  std::vector<geometry::Collision> robot_C = robot_F, others_C;
  for (geometry::Collision& shape : robot_C) shape.X_BS = X_CF * shape.X_BS;
  TabletopView view;
  view.thing_of.assign(cloud.points.size(), -1);
  std::optional<Table> seen;
  const auto take = [&](Recognition found) {
    if (!found.segmentation.table) return;
    auto& all = view.sighting.detections;
    NoteThings(found.segmentation.labels, static_cast<int>(all.size()), &view.thing_of);
    std::move(found.detections.begin(), found.detections.end(), std::back_inserter(all));
    view.num_left_out += found.segmentation.num_left_out;
    seen = found.segmentation.table;
  };
  if (const auto tray_F = PlateOf(tray_link, robot_F)) {
    for (const geometry::Collision& shape : robot_C)
      if (shape.name != tray_F->name) others_C.push_back(shape);
    take(OnTray(*tray_F, X_FC, others_C, cloud, rng));
    for (std::size_t i = 0; i < cloud.points.size(); ++i)  // what stands there is on no table
      if (view.thing_of[i] >= 0)
        cloud.points[i].setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  view.num_own_points = self_.Cut(robot_C, &cloud);
  const CameraStand stand{X_CF.rotation * Eigen::Vector3d::UnitZ(), X_FC.translation.z()};
  take(recogniser_->Recognise(cloud, stand, rng));
  if (!seen) return std::nullopt;
  for (const Eigen::Vector2d& corner : seen->outline)
    view.sighting.table.push_back(seen->Lift(corner));
  return view;
}

}  // namespace hires::perception
