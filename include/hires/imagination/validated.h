#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/param_reader.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout.h"

namespace hires::imagination {

/// Up to where a quantity was validated, and where that is shown (a document and its section).
struct ValidatedLimit {
  double at_most{0.0};
  std::string where;
};

/// What imagination was held against something that it did not make: config/validated.yaml.
struct Validated {
  std::map<std::string, std::string> objects;  ///< model (lower case) -> where
  ValidatedLimit floor_roughness;              ///< [m] standard deviation of the height
  ValidatedLimit linear_speed;                 ///< [m/s] of a motion set
  ValidatedLimit angular_speed;                ///< [rad/s]
  std::map<std::string, std::string> levels;   ///< "tray", "planar" -> where
};

/// @throws base::ConfigError naming file and key.
Validated ReadValidated(base::ParamReader in);

/// In what a request lies outside of what was validated, one sentence each; empty: in nothing that
/// is known. Looked at are the objects that the robot carries at the start or that an action
/// handles, the floor that may be drawn, the speeds of the motion sets, and the levels of detail.
/// @pre the setup was checked (CheckSetupForAll).
std::vector<std::string> CaveatsOf(const RolloutSetup& setup,
                                   const std::vector<base::ActionCall>& actions,
                                   const Validated& validated);

/// The same, after what the report already says, the notes of the objects that are there
/// (world::ObjectModel::notes), what is assumed of a robot that drives (robot::Robot::assumed),
/// hazards that rollouts do not play (HazardsOf), and what is taken as certain (CertainText).
void AddCaveats(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions,
                const Validated& validated, Report* report);

}  // namespace hires::imagination
