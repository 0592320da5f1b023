#pragma once

#include <Eigen/Core>

#include "hires/robot/robot_profile.h"
#include "hires/skills/skill.h"

namespace own_action {

/// Turns the base on the spot until it faces a point, as fast as the motion set allows. It does not
/// look at obstacles: whether there is room, and whether the load stands it, imagination tells.
/// Fails with kStuck when the base does not come nearer for two seconds.
class TurnTowards : public hires::skills::Skill {
 public:
  /// @param p_M  [m] what to face, in the map.
  TurnTowards(const Eigen::Vector2d& p_M, const hires::robot::MotionSet& motion_set);

  hires::skills::Status Update(const hires::robot::Observation& observation,
                               hires::robot::Command* command) override;
  double period() const override { return 0.05; }  // [s]

 private:
  Eigen::Vector2d p_M_;
  hires::robot::MotionSet motion_set_;
  double least_{1e9};          // [rad] that were left at best
  double last_progress_{0.0};  // [s]
};

}  // namespace own_action
