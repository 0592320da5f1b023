#pragma once

#include <set>
#include <string>

#include "hires/base/action.h"

namespace hires_ros {

/// What an action needs for itself while it runs: "base", "torso", "head", arms by instance in
/// lower case. Who grasps or places needs base and torso too: they must stand still. An action that
/// the table does not know needs everything.
/// @pre skills::MakeSkill accepts the action: its arguments are there.
std::set<std::string> GroupsOf(const hires::base::ActionCall& action);

}  // namespace hires_ros
