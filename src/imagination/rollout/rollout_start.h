#pragma once

#include <vector>

#include "hires/base/rng.h"
#include "hires/imagination/rollout.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::imagination {

/// How much of the robot must move for an action.  @throws base::ConfigError for an unknown one.
simulation::LevelOfDetail LevelFor(const skills::SkillSet& skills, const base::ActionCall& action);

/// Draws the truth of one rollout, with a start that touches nothing (simulation::WithFreeStart).
simulation::Variation DrawTruth(const RolloutSetup& setup, const base::Rng& rng);

/// What the robot knows of loose objects when it begins: where the start state has them, but those
/// that stand on the robot it takes to be where it takes itself to be.
std::vector<robot::SeenObject> KnownAtStart(const RolloutSetup& setup,
                                            const simulation::Variation& variation,
                                            const simulation::RobotSimulator& simulator);

/// What a simulator alone would let pass: hands that hold more than makes sense.
/// @throws base::ConfigError for two objects in one hand, or one that is out of the hand's reach.
void CheckHands(const RolloutSetup& setup);

}  // namespace hires::imagination
