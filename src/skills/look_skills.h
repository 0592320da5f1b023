#pragma once

#include <string>

#include "hires/skills/activity.h"
#include "hires/skills/manipulation_context.h"

namespace hires::skills {

/// The camera to an area's frame or to where an object was seen last, resting there for a moment.
/// Fails with out_of_view, timed_out, or object_not_seen for an object that is not
/// remembered.
class LookAt : public StagedSkill {
 public:
  /// @param target  an area of the world, else an object.
  LookAt(std::shared_ptr<const ManipulationContext> context, const std::string& target);
};

/// The head sweeps an area until every part of it has been in view of the resting camera.
/// Succeeds whatever is seen: that is in Observation::objects. Fails as LookAt.
class ObserveObjectsOnArea : public StagedSkill {
 public:
  /// @throws base::ConfigError for an unknown area.
  ObserveObjectsOnArea(std::shared_ptr<const ManipulationContext> context, const std::string& area);
};

/// A stage that looks at a point that is known when it begins; nothing known: nothing to do.
using PointToLookAt = std::function<std::optional<Eigen::Vector3d>(const robot::Observation&)>;
Stage LookStage(std::shared_ptr<const ManipulationContext> context, const std::string& name,
                PointToLookAt point);

/// Points of all placing areas (frames named placingArea...) near the robot: where something may
/// stand that has not been seen yet.
std::vector<Eigen::Vector3d> NearbyPlaces(const ManipulationContext& context,
                                          const geometry::Pose2& X_MB);

}  // namespace hires::skills
