#pragma once

#include <set>
#include <string>
#include <vector>

#include "hires/actions/catalogue.h"
#include "hires/base/action.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/start_state.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// Where an imagined action begins, as `hires imagine` is told: the robot, what it carries and
/// holds, how its arms and torso are, and what stands about.
struct ImagineStart {
  std::string from;                          ///< area where the robot stands
  std::vector<std::string> on_tray;          ///< objects
  std::vector<base::Atom> atoms;             ///< what else holds: Holding, postures, On
  std::vector<imagination::PutObject> put;   ///< objects at places given in numbers
  std::vector<base::Atom> AllAtoms() const;  ///< `atoms`, RobotAt, and On of the tray's load
  std::set<std::string> Objects() const;     ///< that any of them names
};

/// What was typed of it.
struct StartOptions {
  std::string from;
  std::vector<std::string> on_tray, in_hand, postures, put;
};
void AddStartOptions(CLI::App* app, StartOptions* options);

/// An arm that holds something without a posture of its own being given has it where the action
/// before leaves it: at its side for actions of the arms, before the body for driving.
/// @throws base::ConfigError naming the option and what it wants.
ImagineStart ReadStart(const StartOptions& options, const std::string& action,
                       const actions::Catalogue& catalogue);

/// "kitchen:3.2,1.0,1.57": name, x and y [m], yaw [rad] of one turn at most; or a file of goals
/// (imagination::ReadAreaFile), told by its ending .yaml or .yml, or by being there.
/// @throws base::ConfigError saying what is wanted.
std::vector<imagination::NamedArea> ReadAreas(const std::vector<std::string>& texts);

/// Which of these are files.
std::vector<std::string> AreaFilesOf(const std::vector<std::string>& texts);

/// Adds --area to a verb.
void AddAreaOption(CLI::App* app, std::vector<std::string>* areas);

/// A robot that remembers an object somewhere may well be asked to take it and not find it; whoever
/// types a start by hand has forgotten it.
/// @throws base::ConfigError for an action with an object that is nowhere, or that it puts down and
/// that is in no hand.
void RequireObjects(const actions::Catalogue& catalogue,
                    const std::vector<base::ActionCall>& actions, const world::WorldState& world);

/// Plans speak of postures to any robot, and one without arms and torso passes over them; whoever
/// types one means its joints.
/// @throws base::ConfigError for a posture of a robot that has none.
void RequirePostures(const ImagineStart& start, const robot::Robot& robot);

}  // namespace hires::cli
