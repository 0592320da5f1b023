#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/robot/robot_profile.h"
#include "hires/skills/move_base.h"
#include "hires/skills/skill.h"
#include "hires/world/world.h"

namespace hires::skills {

/// Everything skills are made from: constant, shared by all rollouts of a scene.
struct SkillSet {
  std::shared_ptr<const DrivingContext> driving;
  MoveBaseBlindParams blind;
  std::map<std::string, geometry::Pose2> areas;         ///< lower-case name -> X_MArea
  std::map<std::string, robot::MotionSet> motion_sets;  ///< lower-case name
  std::string default_motion_set;
};

SkillSet MakeSkillSet(const world::World& world, const robot::Robot& robot,
                      const MoveBaseParams& driving, const MoveBaseBlindParams& blind);

/// The skill for an action:
///   move_base(area), move_base_param(area, motion set), move_base_blind(area).
/// @throws base::ConfigError naming the action, area or motion set that is unknown, or the
/// arguments that are wanted.
std::unique_ptr<Skill> MakeSkill(const SkillSet& skills, const base::ActionCall& action);

}  // namespace hires::skills
