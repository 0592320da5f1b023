#include "skills/look_skills.h"

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/skills/head_aim.h"
#include "skills/free_spot.h"
#include "skills/joint_motion.h"

namespace hires::skills {
namespace {

using robot::Observation;
using Context = std::shared_ptr<const ManipulationContext>;

const char kPlacingArea[] = "placingarea";

}  // namespace

Stage LookStage(Context context, const std::string& name, PointToLookAt point) {
  return {name,
          [context, point](const Observation& seen) {
            const auto p_M = point(seen);
            return p_M ? LookAtPoint(context, seen, *p_M) : NothingToDo();
          },
          {}};
}

std::vector<Eigen::Vector3d> NearbyPlaces(const ManipulationContext& context,
                                          const geometry::Pose2& X_MB) {
  const LookParams& look = context.params.look;
  std::vector<Eigen::Vector3d> points;
  for (const auto& [name, X_MF] : context.world->frames) {
    if (name.rfind(kPlacingArea, 0) != 0) continue;
    const double distance = (X_MF.translation.head<2>() - X_MB.position()).norm();
    if (distance > look.search_distance) continue;
    const PlacingArea area = AreaIn(*context.world, name, context.params.place);
    const auto on_area = PointsOn(X_MF, area.extent_A, look.part_spacing);
    points.insert(points.end(), on_area.begin(), on_area.end());
  }
  return points;
}

LookAt::LookAt(Context context, const std::string& target) : StagedSkill(context->params.period) {
  const auto X_MF = context->world->FindFrame(target);
  const std::string object = base::ToLower(target);
  Append({"look",
          [context, X_MF, object](const Observation& seen) {
            if (X_MF) return LookAtPoint(context, seen, X_MF->translation);
            const robot::SeenObject* known = FindSeen(seen, object);
            return known == nullptr ? CannotBegin(base::FailureCode::kObjectNotSeen)
                                    : LookAtPoint(context, seen, known->X_MO.translation);
          },
          {}});
}

ObserveObjectsOnArea::ObserveObjectsOnArea(Context context, const std::string& area)
    : StagedSkill(context->params.period) {
  const PlacingArea looked_at = AreaIn(*context->world, area, context->params.place);
  Append({"sweep",
          [context, looked_at](const Observation&) {
            return Begin(std::make_unique<SweepPoints>(
                context,
                PointsOn(looked_at.X_MA, looked_at.extent_A, context->params.look.part_spacing)));
          },
          {}});
}

}  // namespace hires::skills
