#include "skills/look_skills.h"

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/skills/head_aim.h"
#include "skills/joint_motion.h"

namespace hires::skills {
namespace {

using robot::Observation;
using Context = std::shared_ptr<const ManipulationContext>;

const char kPlacingArea[] = "placingarea";

}  // namespace

geometry::Pose3 AreaFrame(const world::World& world, const std::string& area) {
  if (const auto X_MF = world.FindFrame(area)) return *X_MF;
  throw base::ConfigError(base::UnknownName("area", area, world.FrameNames()));
}

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
    const auto square =
        PointsOfSquare(X_MF, context.params.place.area_half_width, look.part_spacing);
    points.insert(points.end(), square.begin(), square.end());
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
  const geometry::Pose3 X_MF = AreaFrame(*context->world, area);
  Append({"sweep",
          [context, X_MF](const Observation&) {
            return Begin(std::make_unique<SweepPoints>(
                context, PointsOfSquare(X_MF, context->params.place.area_half_width,
                                        context->params.look.part_spacing)));
          },
          {}});
}

}  // namespace hires::skills
