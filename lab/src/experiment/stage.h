#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "lab/src/experiment/experiment.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/rollout.h"
#include "hires/imagination/uncertainty.h"

namespace hires::lab {

/// Where an experiment plays: everything loaded, its goals being areas to drive to.
struct Stage {
  imagination::ImaginationSetup setup;
  std::vector<std::string> objects;  ///< on the tray
  double xy_tolerance{0.0};          ///< [m] of a reached goal, as the robot believes
  double yaw_tolerance{0.0};         ///< [rad]
  std::uint64_t params_hash{0};
};

/// @throws base::ConfigError naming file, element and remedy.
Stage MakeStage(const ExperimentConfig& config);

/// What rollouts share that start at a goal.
imagination::RolloutSetup SetupAt(const Stage& stage, const std::string& goal, std::uint64_t seed);

/// "move_base_param(goal, motion_set)".
base::ActionCall DriveTo(const std::string& goal, const std::string& motion_set);

/// The same without some quantities: they keep their nominal values.
imagination::Uncertainty Without(imagination::Uncertainty uncertainty,
                                 const std::set<std::string>& names);

/// One truth out of many: every quantity is fixed at a value that is drawn.
imagination::Uncertainty OneTruth(imagination::Uncertainty uncertainty, const base::Rng& rng);

}  // namespace hires::lab
