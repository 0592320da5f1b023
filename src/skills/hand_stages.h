#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hires/skills/activity.h"
#include "hires/skills/manipulation_context.h"
#include "skills/arm_planner.h"

namespace hires::skills {

using SharedContext = std::shared_ptr<const ManipulationContext>;

/// Two things at the same time; over when both are, failed when one has.
class Both : public Activity {
 public:
  Both(std::unique_ptr<Activity> a, std::unique_ptr<Activity> b)
      : a_(std::move(a)), b_(std::move(b)) {}
  Status Update(const robot::Observation& observation, robot::Command* command) override;

 private:
  std::unique_ptr<Activity> a_, b_;  // null when over
};

/// An arm along a path that was thought through before, beginning where it is.
std::unique_ptr<Activity> Along(const SharedContext& context, const std::string& arm,
                                const JointPath& path, const robot::Observation& observation,
                                double speed);

/// An arm to its posture beside the body: the holding variant if `holds`. Several searches, since
/// one may fail by chance.
Beginning ToSide(const SharedContext& context, const std::string& arm, bool holds,
                 const robot::Observation& observation, std::uint64_t seed);

/// What leaves the hand in order when something went wrong: stops the arm and brings it beside the
/// body.
std::vector<Stage> StopAndTidy(const SharedContext& context, const std::string& arm,
                               std::uint64_t seed);

/// Follows an object by sightings until it is known whether it stands or lies, as the criterion
/// says: what leans too far lies once it has done so for the hold time. Where it stands does not
/// matter.
class LeanWatch {
 public:
  explicit LeanWatch(const world::StandingCriterion& criterion);
  void See(const robot::SeenObject& object);
  /// Nothing seen yet, or it leans too far and has not done so for long.
  bool is_open() const { return !is_held_ && !detector_.stands() && !detector_.is_down(); }
  bool lies() const { return detector_.is_down(); }

 private:
  world::FallDetector detector_;
  bool is_held_{false};  // as recognised: it cannot fall
};

/// The object's pose as the mean of several sightings, taken while the head rests. While it leans
/// too far, but not yet for the criterion's hold time, it is looked at and not counted. Fails with
/// object_not_seen when there is no sighting in time.
class Sight : public Activity {
 public:
  /// @param sighted  filled when it is over; outlives the activity.
  Sight(SharedContext context, std::string object, world::ObjectState* sighted);
  Status Update(const robot::Observation& observation, robot::Command* command) override;

 private:
  void Take(const robot::SeenObject& seen);
  Status Conclude();

  SharedContext context_;
  std::string object_;
  LeanWatch lean_;
  world::ObjectState* sighted_;
  double begin_{-1.0};  // [s]
  double latest_{0.0};  // [s] of the sightings taken
  std::vector<geometry::Pose3> X_MO_;
};

}  // namespace hires::skills
