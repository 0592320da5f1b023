#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/skills/activity.h"
#include "hires/skills/manipulation_context.h"
#include "skills/free_spot.h"

namespace hires::skills {

/// A skill that drives the base to a pose in the map.
using DriveTo = std::function<std::unique_ptr<Skill>(const geometry::Pose2& X_MB)>;

/// Looks at an area from a stated pose of base and torso, and stands afterwards as it stood before:
/// the base on its place, the torso at its height. What is remembered to stand on the area that
/// is looked at must be seen again; nothing remembered there: as ObserveObjectsOnArea. Fails with
///   object_not_seen: name  it is hidden from there, overlooked, or gone
///   out_of_view, timed_out, stuck
class ObserveObjectsAt : public StagedSkill {
 public:
  struct Pose {
    geometry::Pose2 X_MStand;  ///< the base's place at the area: it comes back there
    std::string torso;         ///< posture
    std::string place;         ///< of BasePlaces()
  };

  /// @throws base::ConfigError for an unknown area, posture or place.
  ObserveObjectsAt(std::shared_ptr<const ManipulationContext> context, DriveTo drive,
                   const std::string& area, const Pose& pose);

 protected:
  std::vector<Stage> AfterFailure(const std::string& stage,
                                  const robot::Observation& observation) override;

 private:
  Beginning NoteExpected(const robot::Observation& observation);
  Beginning Sweep(const robot::Observation& observation);
  bool HasSeen(const robot::Observation& observation, const std::string& object) const;
  /// For each expected object that the sweep did not see: a look at it, and some time.
  Beginning LookForMissing(const robot::Observation& observation);
  std::vector<Stage> ReturnStages() const;

  std::shared_ptr<const ManipulationContext> context_;
  DriveTo drive_;
  PlacingArea area_;
  geometry::Pose2 X_MStand_;
  double height_before_{0.0};          // [m] of the torso
  std::vector<std::string> expected_;  // objects
  double looks_since_{0.0};            // [s]
};

}  // namespace hires::skills
