#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/robot/robot_profile.h"
#include "hires/skills/manipulation_context.h"
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
  std::string robot_name;
  std::shared_ptr<const ManipulationContext> manipulation;  ///< null: nothing above the base moves
};

SkillSet MakeSkillSet(const world::World& world, const robot::Robot& robot,
                      const MoveBaseParams& driving, const MoveBaseBlindParams& blind,
                      const ManipulationParams& manipulation = {});

/// The skill for an action, in the words of config/domains/restaurant.lisp:
///   move_base(area), move_base_param(area, motion set), move_base_blind(area),
///   move_torso(posture), tuck_arms(left goal, right goal), move_arm_to_side(arm),
///   move_arms_to_carryposture(), look_at(area or object), observe_objects_on_area(area),
///   pick_up_object(object, arm), place_object(object, arm, area),
///   place_on_tray(arm, object), pick_up_from_tray(arm, object).
/// @throws base::ConfigError naming the action and what is wrong with it: unknown, or a name among
/// its arguments is, or their number is not what is wanted, or the robot has no upper body for it.
std::unique_ptr<Skill> MakeSkill(const SkillSet& skills, const base::ActionCall& action);

/// How much of a robot must move in a simulation that an action is played in.
enum class NeededDetail {
  kBase,       ///< base and tray
  kUpperBody,  ///< also torso, head, arms and grippers
};
/// @throws base::ConfigError for an unknown action.
NeededDetail DetailFor(const base::ActionCall& action);

}  // namespace hires::skills
