#include "hires/skills/skill_factory.h"

#include <fmt/format.h>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/world/floor.h"
#include "skills/driving/at_seen_place.h"
#include "skills/look_skills.h"
#include "skills/object_skills.h"
#include "skills/observe_at.h"
#include "skills/posture_skills.h"

namespace hires::skills {
namespace {

using base::ActionCall;

/// The value of a lower-case name, or an error that lists names like it.
template <typename T>
const T& Lookup(const std::map<std::string, T>& known, const char* kind, const std::string& name) {
  const auto found = known.find(base::ToLower(name));
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : known) names.push_back(entry.first);
  throw base::ConfigError(base::UnknownName(kind, name, names));
}

/// No robot could drive to a place of which the map says nothing.
/// @throws base::ConfigError naming the area and how far the map reaches.
void RequireOnMap(const navigation::Costmap& map, const std::string& area,
                  const geometry::Pose2& X_MA) {
  int column = 0, row = 0;
  map.CellOf(X_MA.position(), &column, &row);
  if (map.Inside(column, row)) return;
  const Eigen::Vector2d lower = map.origin();
  const Eigen::Vector2d upper =
      lower + map.resolution() * Eigen::Vector2d(map.width(), map.height());
  throw base::ConfigError(fmt::format(
      "area '{}' lies at {:g}, {:g} m, off the map, which reaches from {:g} to {:g} m in x and "
      "from "
      "{:g} to {:g} m in y; wanted a goal on the map: correct the area or take another map",
      area, X_MA.x, X_MA.y, lower.x(), upper.x(), lower.y(), upper.y()));
}

/// Where a base shall drive. @throws base::ConfigError for an unknown area, or one of another
/// storey.
const geometry::Pose2& GoalAt(const SkillSet& skills, const std::string& area) {
  const geometry::Pose2& X_MA = Lookup(skills.areas, "area", area);
  const auto elsewhere = skills.elsewhere.find(base::ToLower(area));
  if (elsewhere != skills.elsewhere.end()) throw base::ConfigError(elsewhere->second);
  return X_MA;
}

std::unique_ptr<Skill> MakeMoveBase(const SkillSet& skills, const ActionCall& action) {
  const geometry::Pose2& X_MGoal = GoalAt(skills, action.arguments[0]);
  RequireOnMap(*skills.driving->costmap, action.arguments[0], X_MGoal);
  return std::make_unique<MoveBase>(
      skills.driving, X_MGoal,
      Lookup(skills.motion_sets, "motion set", MotionSetNameOf(skills, action)));
}

/// What drives straight to a pose, without looking at obstacles.
DriveTo BlindDrive(const SkillSet& skills, const ActionCall& action) {
  const robot::MotionSet& motion_set =
      Lookup(skills.motion_sets, "motion set", MotionSetNameOf(skills, action));
  return [params = skills.blind, motion_set,
          driving = skills.driving](const geometry::Pose2& X_MGoal) {
    return std::make_unique<MoveBaseBlind>(params, X_MGoal, motion_set,
                                           driving->robot->profile.base_controller,
                                           BodyThatLooks(*driving));
  };
}

std::unique_ptr<Skill> MakeMoveBaseBlind(const SkillSet& skills, const ActionCall& action) {
  return BlindDrive(skills, action)(GoalAt(skills, action.arguments[0]));
}

std::unique_ptr<Skill> MakeMoveTorso(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveTorso>(skills.manipulation, action, action.arguments[0]);
}

std::unique_ptr<Skill> MakeTuckArms(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<TuckArms>(skills.manipulation, action, action.arguments[0],
                                    action.arguments[1]);
}

std::unique_ptr<Skill> MakeMoveArmToSide(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveArmToSide>(skills.manipulation, action, action.arguments[0]);
}

std::unique_ptr<Skill> MakeMoveArmsToCarry(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<MoveArmsToCarryPosture>(skills.manipulation, action);
}

std::unique_ptr<Skill> MakeLookAt(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<LookAt>(skills.manipulation, action.arguments[0]);
}

std::unique_ptr<Skill> MakeObserve(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<ObserveObjectsOnArea>(skills.manipulation, action.arguments[0]);
}

std::unique_ptr<Skill> MakeObserveAt(const SkillSet& skills, const ActionCall& action) {
  const ObserveObjectsAt::Pose pose{Lookup(skills.areas, "area", action.arguments[1]),
                                    action.arguments[2], action.arguments[3]};
  return std::make_unique<ObserveObjectsAt>(skills.manipulation, BlindDrive(skills, action),
                                            action.arguments[0], pose);
}

/// The thermal camera measures by itself what the head is turned to.
std::unique_ptr<Skill> MakeMeasureTemperature(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<ObserveObjectsOnArea>(skills.manipulation, action.arguments[1]);
}

std::unique_ptr<Skill> MakePickUp(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PickUpObject>(skills.manipulation, action, action.arguments[0],
                                        action.arguments[1], PickUpObject::From::kFurniture);
}

std::unique_ptr<Skill> MakePlace(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PlaceObject>(skills.manipulation, action, action.arguments[0],
                                       action.arguments[1], action.arguments[2]);
}

std::unique_ptr<Skill> MakePlaceAt(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PlaceObject>(skills.manipulation, action, action.arguments[0],
                                       action.arguments[1], action.arguments[2],
                                       action.arguments[3]);
}

std::unique_ptr<Skill> MakePlaceOnTray(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PlaceObject>(skills.manipulation, action, action.arguments[1],
                                       action.arguments[0]);
}

std::unique_ptr<Skill> MakePickUpFromTray(const SkillSet& skills, const ActionCall& action) {
  return std::make_unique<PickUpObject>(skills.manipulation, action, action.arguments[1],
                                        action.arguments[0], PickUpObject::From::kTray);
}

/// How each of actions::OwnActions() is done.
const std::map<std::string, Way>& Ways() {
  constexpr GoesBy kSeen = GoesBy::kSeenPlace;
  static const std::map<std::string, Way> ways{
      {"move_base", {MakeMoveBase}},
      {"move_base_param", {MakeMoveBase}},
      {"move_base_blind", {MakeMoveBaseBlind, kSeen}},
      {"move_torso", {MakeMoveTorso}},
      {"tuck_arms", {MakeTuckArms, kSeen}},
      {"move_arm_to_side", {MakeMoveArmToSide, kSeen}},
      {"move_arms_to_carryposture", {MakeMoveArmsToCarry, kSeen}},
      {"look_at", {MakeLookAt}},
      {"observe_objects_on_area", {MakeObserve}},
      {"observe_objects_at", {MakeObserveAt, kSeen}},
      {"measure_temperature", {MakeMeasureTemperature}},
      {"pick_up_object", {MakePickUp, kSeen}},
      {"place_object", {MakePlace, kSeen}},
      {"place_object_at", {MakePlaceAt, kSeen}},
      {"place_on_tray", {MakePlaceOnTray, kSeen}},
      {"pick_up_from_tray", {MakePickUpFromTray, kSeen}},
  };
  return ways;
}

std::shared_ptr<const ActionSet> MakeOwnActionSet() {
  auto own = std::make_shared<ActionSet>();
  for (const auto& [name, spec] : actions::OwnActions().specs()) {
    const auto way = Ways().find(name);
    HIRES_CHECK(way != Ways().end(), "action '" + name + "' has no maker in skill_factory.cpp");
    own->Add({spec, way->second.make, way->second.goes_by});
  }
  HIRES_CHECK(Ways().size() == actions::OwnActions().specs().size(),
              "skill_factory.cpp has a maker for an action that own_actions.cpp does not describe");
  return own;
}

std::unique_ptr<Skill> Make(const SkillSet& skills, const ActionCall& action) {
  const actions::ActionSpec& spec = SpecOf(skills, action);
  actions::CheckArguments(spec, action);
  if (spec.detail == actions::Detail::kUpperBody && skills.manipulation == nullptr) {
    throw base::ConfigError(
        fmt::format("robot '{}' has no upper body that could do it; describe one in its profile, "
                    "key upper_body",
                    skills.robot_name));
  }
  const Way& way = skills.actions->WayOf(action.name);
  auto skill = way.make(skills, action);
  const bool is_by_seen = way.goes_by == GoesBy::kSeenPlace;
  if (!is_by_seen || !skills.driving || !skills.driving->seen_place) return skill;
  return std::make_unique<AtSeenPlace>(std::move(skill), skills.driving->seen_place,
                                       skills.driving->base);
}

}  // namespace

std::shared_ptr<const ActionSet> OwnActionSet() {
  static const std::shared_ptr<const ActionSet> own = MakeOwnActionSet();
  return own;
}

SkillSet MakeSkillSet(const world::World& world, const robot::Robot& robot,
                      const MoveBaseParams& driving, const MoveBaseBlindParams& blind,
                      const ManipulationParams& manipulation,
                      const world::StandingCriterion& standing,
                      std::shared_ptr<const ActionSet> actions) {
  SkillSet skills;
  skills.actions = std::move(actions);
  skills.driving =
      std::make_shared<const DrivingContext>(MakeDrivingContext(world, robot, driving));
  skills.blind = blind;
  for (const auto& [name, X_MF] : world.frames) {
    skills.areas[name] = geometry::Flatten(X_MF);
    const std::string why = world::WhyElsewhere(world, name, driving.min_obstacle_height);
    if (!why.empty()) skills.elsewhere[name] = why;
  }
  skills.motion_sets = robot.profile.motion_sets;
  skills.default_motion_set = robot.profile.default_motion_set;
  skills.robot_name = robot.model.name;
  if (robot.profile.upper_body) {
    skills.manipulation = MakeManipulationContext(std::make_shared<const world::World>(world),
                                                  std::make_shared<const robot::Robot>(robot),
                                                  manipulation, standing);
  }
  return skills;
}

std::unique_ptr<Skill> MakeSkill(const SkillSet& skills, const ActionCall& action) {
  try {
    return Make(skills, action);
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format("action '{}': {}", base::ToString(action), error.what()));
  }
}

const actions::ActionSpec& SpecOf(const SkillSet& skills, const ActionCall& action) {
  return skills.actions->catalogue().Get(action.name);
}

std::string MotionSetNameOf(const SkillSet& skills, const ActionCall& action) {
  return actions::ArgumentOf(SpecOf(skills, action), action, actions::ParameterKind::kMotionSet)
      .value_or(base::ToLower(skills.default_motion_set));
}

}  // namespace hires::skills
