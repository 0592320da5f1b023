#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hires/geometry/polygon.h"
#include "hires/skills/scan_watch.h"
#include "hires/skills/seen_place.h"
#include "hires/skills/skill.h"

namespace hires::skills {

/// A skill that goes by the place where its robot sees itself beside furniture, and not by the one
/// that it is told, which is off by centimetres. An extended Kalman filter: begun with the told
/// place, moved on by odometry, corrected by what each scan shows of the outlines of the world; the
/// told place again where the odometry knows no better, was reset, or is contradicted by more than
/// 4 sd. Things that were seen go with the robot: they stay where they are against it.
class AtSeenPlace : public Skill {
 public:
  /// @param footprint  of the robot, in its base: what is seen within is the robot.
  AtSeenPlace(std::unique_ptr<Skill> skill, std::shared_ptr<const SeenPlace> seen,
              geometry::Polygon footprint);

  Status Update(const robot::Observation& observation, robot::Command* command) override;
  double period() const override { return skill_->period(); }
  std::string phase() const override { return skill_->phase(); }
  std::optional<DriveView> drive_view() const override { return skill_->drive_view(); }

  /// @pre it was updated.
  const localisation::PlaceBelief& belief() const { return *belief_; }

 private:
  void Look(const robot::Observation& observation);
  void Correct(const robot::PlacedScan& scan);

  std::unique_ptr<Skill> skill_;
  std::shared_ptr<const SeenPlace> seen_;
  geometry::Polygon footprint_;
  ScanWatch watch_;
  std::optional<localisation::PlaceBelief> belief_;  // none: it has not looked yet
  geometry::Pose2 X_OB_;                             // of that
};

}  // namespace hires::skills
