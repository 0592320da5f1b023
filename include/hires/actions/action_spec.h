#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/failure.h"

namespace hires::actions {

/// What an argument of an action names.
enum class ParameterKind {
  kArea,          ///< a frame of the world
  kMotionSet,     ///< limits of driving in the robot's profile
  kTorsoPosture,  ///< of the robot's profile
  kArmPosture,    ///< likewise
  kArm,           ///< an arm by its instance: leftarm1
  kObject,        ///< an object by its instance
  kAreaOrObject,  ///< one of the two
  kSpot,          ///< where on an area something is put, by a name that every area knows
  kBasePlace      ///< where beside an area of the base the robot stands, likewise
};
const char* ToString(ParameterKind kind);  ///< "area", "motion set"

struct Parameter {
  std::string name;  ///< as in planning domains, without `?`: "motion_set"
  ParameterKind kind{ParameterKind::kArea};
};

/// How much of a robot must move in a simulation that an action is played in.
enum class Detail {
  kBase,      ///< base and tray
  kUpperBody  ///< also torso, head, arms and grippers
};

/// How an action moves the base.
enum class Driving {
  kNone,            ///< the base stands still
  kRoundObstacles,  ///< to its area by any free way: the robot's own move_base may do it instead
  kStraight,        ///< without looking at obstacles, slowly: a robot's move_base would not
  kOwnWay           ///< in a way of its own, as fast as the motion set allows
};

/// What an action is meant to do with one object.
enum class Purpose {
  kNone,       ///< nothing is taken or put down: what is carried stays where it is
  kTake,       ///< the object ends in the hand
  kPutOnArea,  ///< the object ends upright on an area of the world
  kPutOnTray   ///< the object ends upright on the robot's tray
};

/// The parameters that a purpose is about, by name; "" where it has none.
struct PurposeSpec {
  Purpose purpose{Purpose::kNone};
  std::string object;
  std::string arm;   ///< that takes it or puts it down
  std::string area;  ///< kPutOnArea: where
};

/// Names of what an action can need for itself, beside arms by their instances.
constexpr char kBaseGroup[] = "base";
constexpr char kTorsoGroup[] = "torso";
constexpr char kHeadGroup[] = "head";

/// What an action is, apart from how it is done: the one place that tells. All names are in lower
/// case. How it is done is told by its maker (skills::ActionSet).
struct ActionSpec {
  std::string name;  ///< "place_object"
  std::vector<Parameter> parameters;
  Detail detail{Detail::kBase};
  /// What it needs for itself while it runs: groups as above, arms by instance, or "?arm" for the
  /// arm that the parameter `arm` names. Who grasps needs the base, too: it must stand still.
  std::set<std::string> groups;
  Driving driving{Driving::kNone};
  PurposeSpec purpose;
  /// What holds when it has succeeded: Holding(?arm, ?object), with `?` before names of parameters.
  std::vector<base::Atom> effects;
  /// How it may fail by itself; beside that, everything that moves may collide or take too long.
  std::vector<base::FailureCode> failures;
  bool is_operator{true};  ///< planning domains have it; else it is only asked for directly
};

/// @throws base::ConfigError naming the action and what of its description makes no sense.
void CheckSpec(const ActionSpec& spec);

/// All of it in one text: equal texts, equal descriptions.
std::string Canonical(const ActionSpec& spec);

/// "place_object(object, arm, area)".
std::string Signature(const ActionSpec& spec);

// What an action call asks for ---------------------------------------------------------------

/// @throws base::ConfigError if their number is not what is wanted.
void CheckArguments(const ActionSpec& spec, const base::ActionCall& call);

/// What the call needs for itself, arms by instance, in lower case.
/// @pre CheckArguments(spec, call) accepts it.
std::set<std::string> GroupsOf(const ActionSpec& spec, const base::ActionCall& call);

/// The argument of a parameter, in lower case; "" where the action has no such parameter, or the
/// call is too short.
std::string ArgumentOf(const ActionSpec& spec, const base::ActionCall& call,
                       const std::string& parameter);
/// The argument of the first parameter of a kind, in lower case; none where the action has no such
/// parameter, or the call is too short.
std::optional<std::string> ArgumentOf(const ActionSpec& spec, const base::ActionCall& call,
                                      ParameterKind kind);

/// What the Blackboard calls an action that runs, and one that is planned: move_base is a
/// MoveBaseActivity and a MoveBaseTask.
std::string ActivityConcept(const std::string& action_name);
std::string TaskConcept(const std::string& action_name);

}  // namespace hires::actions
