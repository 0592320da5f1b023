#include "imagination/rollout/floor_objects.h"

namespace hires::imagination {
namespace {

bool Crosses(const world::ObjectModel& model, const geometry::Pose3& X_MO, double height) {
  for (const geometry::Collision& part : model.collisions)
    if (geometry::OutlineInBand(part.shape, X_MO * part.X_BS, height, height)) return true;
  return false;
}

}  // namespace

bool IsInLaserPlane(const simulation::Scene& scene, const world::ObjectState& object) {
  if (!object.attached_to.empty()) return false;
  const auto model = scene.world.FindModel(object.model);
  return scene.laser_height && model && Crosses(*model, object.X_MO, *scene.laser_height);
}

FloorObjects::FloorObjects(const simulation::Scene& scene,
                           const std::vector<world::ObjectState>& objects) {
  if (!scene.laser_height) return;
  height_ = *scene.laser_height;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!IsInLaserPlane(scene, objects[i])) continue;
    objects_.push_back({static_cast<int>(i), scene.world.RequireModel(objects[i].model)});
  }
}

std::vector<geometry::Polygon> FloorObjects::SeenBy(const simulation::RobotSimulator& simulator,
                                                    const geometry::Pose2& X_MB) const {
  std::vector<geometry::Polygon> seen;
  const geometry::Pose2 X_MTruth = X_MB * simulator.base().X_MB.Inverse();
  for (const Object& object : objects_) {
    const geometry::Pose3 X_MO = simulator.PoseOf(object.index);
    const Eigen::Vector2d way = X_MO.translation.head<2>() - simulator.base().X_MB.position();
    if (way.norm() > kRange) continue;
    for (const geometry::Collision& part : object.model->collisions) {
      const auto outline = geometry::OutlineInBand(part.shape, X_MO * part.X_BS, height_, height_);
      if (outline) seen.push_back(geometry::Transformed(X_MTruth, *outline));
    }
  }
  return seen;
}

}  // namespace hires::imagination
