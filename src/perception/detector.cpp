#include "hires/perception/detector.h"

namespace hires::perception {
namespace {

/// What the recogniser makes of the true pose.
geometry::Pose3 Blurred(const geometry::Pose3& X_CO, const DetectorParams& params, base::Rng* rng) {
  geometry::Pose3 blurred = X_CO;
  for (int axis = 0; axis < 3; ++axis) {
    blurred.translation[axis] += rng->Normal(0.0, params.position_noise);
  }
  const double turn = rng->Normal(0.0, params.yaw_noise);
  blurred.rotation = X_CO.rotation * geometry::RotationFromRpy(0.0, 0.0, turn);
  return blurred;
}

}  // namespace

std::vector<Detection> Detect(const LineOfSight& sight, const CameraView& true_view,
                              const std::vector<world::ObjectState>& objects,
                              const DetectorParams& params, base::Rng* rng) {
  std::vector<Detection> detections;
  const geometry::Pose3 X_CM = true_view.X_MC.Inverse();
  for (const world::ObjectState& object : objects) {
    const geometry::Pose3 X_CO = Blurred(X_CM * object.X_MO, params, rng);
    const double share = sight.VisibleShare(true_view, object.name);
    if (share <= 0.0 || share < params.min_visible_share) continue;
    Detection detection;
    detection.instance = object.name;
    detection.label = object.model;
    detection.X_CO = X_CO;
    detection.visible_share = share;
    detections.push_back(std::move(detection));
  }
  return detections;
}

}  // namespace hires::perception
