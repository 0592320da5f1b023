#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/robot/robot_profile.h"
#include "hires/skills/action_set.h"
#include "hires/skills/manipulation_context.h"
#include "hires/skills/move_base.h"
#include "hires/skills/skill.h"
#include "hires/world/world.h"

namespace hires::skills {

/// Everything skills are made from: constant, shared by all rollouts of a scene.
struct SkillSet {
  std::shared_ptr<const DrivingContext> driving;
  MoveBaseBlindParams blind;
  std::map<std::string, geometry::Pose2> areas;  ///< lower-case name -> X_MArea
  /// Lower-case names of areas to which no base drives, and why: they lie on another storey.
  std::map<std::string, std::string> elsewhere;
  std::map<std::string, robot::MotionSet> motion_sets;  ///< lower-case name
  std::string default_motion_set;
  std::string robot_name;
  std::shared_ptr<const ManipulationContext> manipulation;  ///< null: nothing above the base moves
  std::shared_ptr<const ActionSet> actions = OwnActionSet();
};

SkillSet MakeSkillSet(const world::World& world, const robot::Robot& robot,
                      const MoveBaseParams& driving, const MoveBaseBlindParams& blind,
                      const ManipulationParams& manipulation = {},
                      const world::StandingCriterion& standing = {},
                      std::shared_ptr<const ActionSet> actions = OwnActionSet());

/// The skill for an action of `skills.actions`.
/// @throws base::ConfigError naming the action and what is wrong with it: unknown, or a name among
/// its arguments is, or their number is not what is wanted, or the robot has no upper body for it.
std::unique_ptr<Skill> MakeSkill(const SkillSet& skills, const base::ActionCall& action);

/// What an action is.  @throws base::ConfigError for an unknown one.
const actions::ActionSpec& SpecOf(const SkillSet& skills, const base::ActionCall& action);

/// Limits of driving that are in force while an action runs: those that its arguments name, else
/// the robot's default; lower case.  @throws base::ConfigError for an unknown action.
std::string MotionSetNameOf(const SkillSet& skills, const base::ActionCall& action);

}  // namespace hires::skills
