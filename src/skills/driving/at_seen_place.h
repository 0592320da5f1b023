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
/// told place again along every axis along which the odometry knows no better, and altogether where
/// that was reset, or where the told place, or every scan, is more than 4 sd off for a second.
/// Things that were seen go with the robot: they stay where they are against it.
class AtSeenPlace : public Skill {
 public:
  /// @param body  of the robot, in its base: what is seen within is the robot.
  AtSeenPlace(std::unique_ptr<Skill> skill, std::shared_ptr<const SeenPlace> seen,
              geometry::Polygon body);

  Status Update(const robot::Observation& observation, robot::Command* command) override;
  double period() const override { return skill_->period(); }
  std::string phase() const override { return skill_->phase(); }
  std::optional<DriveView> drive_view() const override { return skill_->drive_view(); }

  /// @pre it was updated.
  const localisation::PlaceBelief& belief() const { return *belief_; }

 private:
  /// Something contradicts.
  struct Doubt {
    bool Note(bool is_so, double time);  // whether it has been so long enough
    std::optional<double> since;         // [s]
  };
  void Look(const robot::Observation& observation);
  void Predict(const robot::Observation& observation);
  void Believe(const localisation::PlaceBelief& told);
  void Correct(const robot::PlacedScan& scan, const localisation::PlaceBelief& told);

  std::unique_ptr<Skill> skill_;
  std::shared_ptr<const SeenPlace> seen_;
  geometry::Polygon body_;
  ScanWatch watch_;
  std::optional<localisation::PlaceBelief> belief_;  // none: it has not looked yet
  geometry::Pose2 X_OB_;                             // of that
  double time_{0.0};                                 // [s] likewise
  Doubt told_contradicts_, scans_contradict_;
};

}  // namespace hires::skills
