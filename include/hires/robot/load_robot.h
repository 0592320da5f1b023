#pragma once

#include <string>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// From a bare URDF (a path that ends in ".urdf", in either case), from a xacro file (".xacro", or
/// a URDF with macros in it), which is expanded where the program xacro is on PATH and may have
/// arguments behind it ("bot.xacro prefix:=a_"), or from a profile.
/// @throws base::ConfigError as LoadRobotFromUrdf and LoadRobot.
Robot LoadAnyRobot(const std::string& path);

/// The file itself, without what xacro gets beside it: "bot.xacro" of "bot.xacro prefix:=a_".
std::string FileOfRobot(const std::string& path);

/// Whether that is a profile, by its ending; else a URDF or a xacro file.
bool IsProfile(const std::string& path);

/// The text of the URDF behind a robot's profile, or of the URDF that was loaded in place of one.
/// @param path  that the robot was loaded from.
/// @throws base::ConfigError if it cannot be read.
std::string ReadUrdfOf(const std::string& path, const RobotProfile& profile);

/// Whether nobody says how fast and how suddenly that robot's base can move, so that what a PR2 can
/// is taken: a URDF, or a profile with neither motion_sets nor base_controller.limits.
/// @param path  that the robot was loaded from.  @throws base::ConfigError if it cannot be read.
bool IsMotionAssumed(const std::string& path);

/// A robot as a profile, each line with a comment that says where it comes from, to be corrected.
/// As it stands it gives the robot that it was made of, bit by bit (RobotProfile::hash), but where
/// no shape says how large that is: then its line `footprint` must be filled in first, which is
/// logged.
/// @param path  a URDF or xacro file, as LoadAnyRobot has it.
/// @param folder  where the profile will lie; its `urdf` is as seen from there.
/// @throws base::ConfigError as LoadRobotModel.
std::string WriteProfile(const std::string& path, const std::string& folder);

}  // namespace hires::robot
