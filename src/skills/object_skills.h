#pragma once

#include <optional>
#include <string>

#include "hires/skills/activity.h"
#include "hires/skills/manipulation_context.h"
#include "skills/free_spot.h"
#include "skills/hand_stages.h"
#include "skills/reach.h"

namespace hires::skills {

/// Takes an object that stands within reach: looks at it, grasps it, lifts it, and brings it
/// upright to the side. Fails with
///   object_not_seen    it is not seen although the head looked where it was or may be
///   unreachable, no_path: a touches b, start_blocked: ...   no way to any of its grasps
///   hand_full: name    the hand holds something already
///   object_held: link, object_toppled    another hand has it; it lies
///   grasp_failed       the fingers closed on nothing; the hand is drawn back
///   object_slipped     it was lost on the way to the side
///   unknown_model: name    something is seen whose shape is unknown
///   out_of_view, timed_out
class PickUpObject : public StagedSkill {
 public:
  enum class From { kFurniture, kTray };
  /// @param object  instance; @param arm  @throws base::ConfigError for an unknown arm.
  PickUpObject(std::shared_ptr<const ManipulationContext> context, const base::ActionCall& action,
               const std::string& object, const std::string& arm, From from);

 protected:
  std::vector<Stage> AfterFailure(const std::string& stage,
                                  const robot::Observation& observation) override;

 private:
  void AppendLooking(From from);
  void AppendReaching();
  void AppendTaking();
  Beginning Plan(const robot::Observation& observation);
  Beginning ReturnToSide(const robot::Observation& observation) const;

  std::shared_ptr<const ManipulationContext> context_;
  std::string object_, arm_;  // lower case
  std::uint64_t seed_;
  world::ObjectState sighted_;  // mean of some sightings
  GraspPlan plan_;
};

/// Puts what the arm holds down on a free place and lets go. Fails with
///   object_slipped          the hand is empty, at the start or on the way; it does not stand where
///                           it was put
///   area_occupied: names    no free place, or only objects are in the way
///   unreachable, no_path: a touches b, start_blocked: ...   no way to any free place
///   object_toppled          it lies
///   object_not_seen         it is not seen any more afterwards
///   unknown_model: name    something is seen whose shape is unknown
///   out_of_view, timed_out
class PlaceObject : public StagedSkill {
 public:
  /// On an area of the world.
  /// @param spot  of the area (ParseSpot), which alone is tried.
  /// @throws base::ConfigError for an unknown arm, area or spot.
  PlaceObject(std::shared_ptr<const ManipulationContext> context, const base::ActionCall& action,
              const std::string& object, const std::string& arm, const std::string& area,
              const std::string& spot = kAnySpot);
  /// On the robot's tray.  @throws base::ConfigError also for a robot without tray.
  PlaceObject(std::shared_ptr<const ManipulationContext> context, const base::ActionCall& action,
              const std::string& object, const std::string& arm);

 protected:
  std::vector<Stage> AfterFailure(const std::string& stage,
                                  const robot::Observation& observation) override;

 private:
  void AppendStages();
  void AppendChecking();
  /// Where it is put: an area's frame, or the middle of the tray.
  geometry::Pose3 X_MGoal(const robot::Observation& observation) const;
  /// Where the object may be put, around X_MGoal.
  FreeSpots SpotsFor(const world::ObjectModel& model, const geometry::Pose3& X_MGoal,
                     const std::vector<world::ObjectState>& others) const;
  Beginning Plan(const robot::Observation& observation);
  Beginning ReturnAndLook(const robot::Observation& observation) const;
  base::Failure WhyNotStanding(const robot::Observation& observation) const;

  std::shared_ptr<const ManipulationContext> context_;
  std::string object_, arm_;             // lower case
  std::optional<PlacingArea> area_;      // nothing: on the tray
  std::optional<Eigen::Vector2d> spot_;  // the only one of the area that is wanted
  std::uint64_t seed_;
  PlacePlan plan_;
  double looked_since_{0.0};  // [s]
  LeanWatch lean_;            // since then, of what was put down
};

/// Why the arm does not hold `object` any more (object_slipped); nothing while it does. Fingers
/// that meet hold nothing; what is seen standing elsewhere is not held either.
base::Failure WhyNotHeld(const ManipulationContext& context, const std::string& arm,
                         const std::string& object, const robot::Observation& observation);

}  // namespace hires::skills
