#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::sim_robot {

/// One loose object where it really stands.
struct ScenarioObject {
  std::string name;                     ///< instance, lower case, e.g. mug1
  std::string model;                    ///< kind; empty: the one that the object catalogue names
  geometry::Pose3 X_MO;                 ///< of the model's origin, the middle of its underside
  bool is_told{true};                   ///< false: the knowledge files say nothing of it
  std::optional<double> temperature{};  ///< [K]; none: as warm as the room
};

/// A demonstration: what is to be done, what the robot knows at first, and what is true at first.
/// `config/scenarios/<name>.yaml`; the robot's simulator begins with it.
struct Scenario {
  std::string name;                         ///< of the file, without folder and ending
  std::string task;                         ///< as `hires achieve` takes it
  std::vector<std::string> knowledge;       ///< paths, for an empty Blackboard
  geometry::Pose2 X_MB;                     ///< the robot's base
  std::string torso;                        ///< posture, lower case; "": the robot has no torso
  std::map<std::string, std::string> arms;  ///< arm's instance -> posture, lower case
  std::vector<ScenarioObject> objects;      ///< those that it is told of first, then the hidden
};

/// The file of a scenario. @param scenario  name of a file in `folder`, without .yaml; or a path.
/// @throws base::ConfigError for a name that is not there, with those that are like it.
std::string ScenarioPath(const std::string& scenario, const std::string& folder);

/// Relative paths count from the folder of the file. Postures, arms and models are names: whoever
/// knows robot and catalogue checks them.
/// @throws base::ConfigError naming file and key.
Scenario ReadScenario(const std::string& path);

/// [K] by object, of those that have a temperature of their own; empty for an empty path.
/// @throws base::ConfigError as ReadScenario.
std::map<std::string, double> TemperaturesOf(const std::string& scenario);

}  // namespace hires::sim_robot
