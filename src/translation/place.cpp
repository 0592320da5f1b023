#include "translation/place.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hires::translation {
namespace {

bool CarriesObjects(const Area& area) {
  return area.kind == AreaKind::kPlacing || area.kind == AreaKind::kTray;
}

}  // namespace

geometry::Pose3 PoseOf(const Area& area, const Body& body) {
  return area.link.empty() ? area.X_FA : body.X_ML(area.link) * area.X_FA;
}

bool IsOver(const Area& area, const Body& body, const geometry::Pose3& X_MO,
            const ClassifyParams& params, double beyond) {
  if (!CarriesObjects(area)) return false;
  const Eigen::Vector3d p_A = PoseOf(area, body).Inverse() * X_MO.translation;
  const double height = area.kind == AreaKind::kTray ? params.tray_height : params.placing_height;
  return std::abs(p_A.x()) <= area.size.x() / 2 + beyond &&
         std::abs(p_A.y()) <= area.size.y() / 2 + beyond && std::abs(p_A.z()) <= height;
}

const Area* AreaUnder(const TranslatorContext& context, const Body& body,
                      const world::ObjectState& object, const std::string& before) {
  if (!object.attached_to.empty() || !world::IsUpright(context.standing, object.X_MO)) {
    return nullptr;
  }
  const Area* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Area& area : context.areas.all) {
    const double slack = area.name == before ? context.classify.placing_hysteresis : 0.0;
    if (!IsOver(area, body, object.X_MO, context.classify, slack)) continue;
    const Eigen::Vector3d p_A = PoseOf(area, body).Inverse() * object.X_MO.translation;
    // Where squares overlap: the middle that is nearest, and the old one a little longer.
    const double distance = p_A.head<2>().norm() - slack;
    if (distance >= least) continue;
    nearest = &area;
    least = distance;
  }
  return nearest;
}

geometry::Aabb BoundsOf(const world::ObjectModel& model) {
  geometry::Aabb bounds;
  for (const geometry::Collision& collision : model.collisions) {
    bounds.Include(geometry::BoundsOf(collision.shape, collision.X_BS));
  }
  return bounds;
}

}  // namespace hires::translation
