#include "hires/control/robot_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "hires/base/param_reader.h"
#include "hires/base/text.h"

namespace hires::control {
namespace {

using base::ParamReader;

enum class Emptiness { kForbidden, kAllowed };

const std::vector<std::string>& Arms() {
  static const std::vector<std::string> arms{"leftarm1", "rightarm1"};
  return arms;
}

const std::vector<std::string>& Groups() {
  static const std::vector<std::string> groups{"leftarm1", "rightarm1", "torso", "head"};
  return groups;
}

const std::vector<std::string>& Limits() {
  static const std::vector<std::string> limits{
      "max_linear_velocity",     "max_translational_velocity", "max_angular_velocity",
      "max_linear_acceleration", "max_lateral_acceleration",   "max_angular_acceleration"};
  return limits;
}

/// Those of a motion set: a planner that cannot be told of all four would drive beyond the set.
const std::vector<std::string>& NeededLimits() {
  static const std::vector<std::string> limits{"max_linear_velocity", "max_angular_velocity",
                                               "max_linear_acceleration",
                                               "max_angular_acceleration"};
  return limits;
}

bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

bool IsOneWord(const std::string& word) {
  return !word.empty() && IsLetter(word[0]) && std::all_of(word.begin(), word.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  });
}

/// The words between slashes; after the first they may begin with a digit.
bool IsRelativeName(const std::string& name) {
  const auto words = base::Split(name, '/');
  return IsLetter(words.front().empty() ? ' ' : words.front()[0]) &&
         std::all_of(words.begin(), words.end(), [](const std::string& word) {
           return IsOneWord("a" + word) && !word.empty();
         });
}

std::string ReadName(const std::string& key, Emptiness emptiness, ParamReader* in) {
  std::string name = in->GetString(key);
  if (name.empty() && emptiness == Emptiness::kAllowed) return name;
  if (!IsRelativeName(name)) {
    in->Fail(key,
             "wanted a relative ROS name such as base_controller/command: letters, digits, _ "
             "and /, a letter first; a launch file can put it elsewhere");
  }
  return name;
}

std::string ReadFrame(const std::string& key, ParamReader* in) {
  std::string name = in->GetString(key);
  if (!IsRelativeName(name)) {
    in->Fail(key,
             "wanted a frame of tf such as base_footprint: letters, digits, _ and /, a letter "
             "first");
  }
  return name;
}

void ReadFrames(ParamReader in, RobotNames* names) {
  names->map_frame = ReadFrame("map", &in);
  names->odometry_frame = ReadFrame("odometry", &in);
  names->base_frame = ReadFrame("base", &in);
  if (names->odometry_frame == names->map_frame) in.Fail("odometry", "which is the map's already");
  if (names->base_frame == names->map_frame || names->base_frame == names->odometry_frame) {
    in.Fail("base", "which is the map's or the odometry's already");
  }
}

/// @param known  what is spoken of, for whom a topic may be told.
std::map<std::string, std::string> ReadTopics(const std::vector<std::string>& known,
                                              const std::string& kind, ParamReader in) {
  std::map<std::string, std::string> topics;
  std::set<std::string> taken;
  for (const std::string& key : in.Keys()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      in.Fail(key, "but " + base::UnknownName(kind, key, known));
    }
    topics[key] = ReadName(key, Emptiness::kForbidden, &in);
    if (!taken.insert(topics[key]).second) in.Fail(key, "which is another one's already");
  }
  return topics;
}

std::vector<std::string> ReadParameterNames(const std::string& limit, ParamReader* in) {
  std::vector<std::string> names = in->GetStrings(limit);
  if (names.empty()) in->Fail(limit, "wanted the names that local planners give it, newest first");
  for (const std::string& name : names) {
    if (!IsOneWord(name)) {
      in->Fail(limit,
               fmt::format("and '{}' is no parameter's name: letters, digits and _, a letter "
                           "first",
                           name));
    }
    if (std::count(names.begin(), names.end(), name) > 1) {
      in->Fail(limit, fmt::format("and '{}' stands twice; keep one", name));
    }
  }
  return names;
}

std::map<std::string, std::vector<std::string>> ReadParameters(bool are_needed, ParamReader in) {
  std::map<std::string, std::vector<std::string>> parameters;
  for (const std::string& key : in.Keys()) {
    if (std::find(Limits().begin(), Limits().end(), key) == Limits().end()) {
      in.Fail(key, "but " + base::UnknownName("limit", key, Limits()));
    }
    parameters[key] = ReadParameterNames(key, &in);
  }
  for (const std::string& limit : NeededLimits()) {
    if (are_needed && parameters.count(limit) == 0) {
      in.Fail(limit, "wanted the parameter that sets this limit of a motion set; add it");
    }
  }
  return parameters;
}

RobotNames::MoveBase ReadMoveBase(ParamReader in) {
  RobotNames::MoveBase move_base;
  move_base.action = ReadName("action", Emptiness::kAllowed, &in);
  move_base.planner = ReadName("planner", Emptiness::kAllowed, &in);
  if (move_base.action.empty() != move_base.planner.empty()) {
    in.Fail(move_base.action.empty() ? "action" : "planner",
            "wanted both action and planner, or both empty for a robot without move_base");
  }
  move_base.parameters = ReadParameters(!move_base.action.empty(), in.Sub("parameters"));
  return move_base;
}

void ReadTopicsAndServers(ParamReader* in, RobotNames* names) {
  const auto must = [&](const char* key) { return ReadName(key, Emptiness::kForbidden, in); };
  const auto may = [&](const char* key) { return ReadName(key, Emptiness::kAllowed, in); };
  names->base_command = must("base_command");
  names->odometry = must("odometry");
  names->joint_states = must("joint_states");
  names->localisation = must("localisation");
  names->base_scan = must("base_scan");
  names->map = must("map");
  names->static_map = may("static_map");
  names->motors_halted = may("motors_halted");
  names->robot_description = must("robot_description");
}

/// All may be left out, and the block with them.
SensorNames ReadSensors(ParamReader in) {
  SensorNames names;
  std::set<std::string> taken;
  for (const auto& [key, name] : {std::pair("depth_cloud", &names.depth_cloud),
                                  {"depth_image", &names.depth_image},
                                  {"depth_info", &names.depth_info},
                                  {"colour_image", &names.colour_image},
                                  {"colour_info", &names.colour_info},
                                  {"thermal_image", &names.thermal_image},
                                  {"thermal_colours", &names.thermal_colours},
                                  {"thermal_info", &names.thermal_info},
                                  {"tilt_scan", &names.tilt_scan},
                                  {"tilt_cloud", &names.tilt_cloud},
                                  {"tray_scan", &names.tray_scan},
                                  {"inertia", &names.inertia}}) {
    if (!in.Has(key)) continue;
    *name = ReadName(key, Emptiness::kAllowed, &in);
    if (!name->empty() && !taken.insert(*name).second) {
      in.Fail(key, "which is another one's already");
    }
  }
  return names;
}

/// By their goals, which are topics, actions are led.
void LeadByGoals(std::map<std::string, std::string>* actions) {
  for (auto& [group, name] : *actions) name += "/goal";
}

void ReadInterfaces(ParamReader* in, RobotNames* names) {
  if (in->Has("trajectory_interface") &&
      in->Get("trajectory_interface",
              base::OneOf({"joint_trajectory", "follow_joint_trajectory"})) ==
          "follow_joint_trajectory") {
    names->trajectory_interface = TrajectoryInterface::kFollowJointTrajectory;
    LeadByGoals(&names->trajectories);
  }
  if (in->Has("gripper_interface") &&
      in->Get("gripper_interface", base::OneOf({"pr2_gripper_command", "gripper_command"})) ==
          "gripper_command") {
    names->gripper_interface = GripperInterface::kGripperCommand;
    LeadByGoals(&names->grippers);
  }
}

RobotNames ReadAll(ParamReader in) {
  RobotNames names;
  ReadFrames(in.Sub("frames"), &names);
  ReadTopicsAndServers(&in, &names);
  names.trajectories = ReadTopics(Groups(), "group of joints", in.Sub("trajectories"));
  names.grippers = ReadTopics(Arms(), "arm", in.Sub("grippers"));
  ReadInterfaces(&in, &names);
  names.move_base = ReadMoveBase(in.Sub("move_base"));
  if (in.Has("sensors")) names.sensors = ReadSensors(in.Sub("sensors"));
  in.RejectUnknownKeys();
  return names;
}

}  // namespace

RobotNames ReadRobotNames(const std::string& path) { return ReadAll(ParamReader::FromFile(path)); }

RobotNames ParseRobotNames(const std::string& yaml, const std::string& where) {
  return ReadAll(ParamReader::FromString(yaml, where));
}

}  // namespace hires::control
