#pragma once

/// @file
/// All that a program includes that imagines by itself: load, begin somewhere, imagine, look.
///
///     using namespace hires;
///     const auto local = imagination::LoadLocalSetup("config/imagination_client.yaml", {});
///     const auto start = imagination::MakeStartState(local.setup, "dock", {"coffee_cup"});
///     const auto rollouts = imagination::MakeRolloutSetup(local.setup, start, 7);
///     const auto report = imagination::ImagineLocally(
///         rollouts, base::Combinations({"move_base_param", {{"atBench"}, {"slow", "fast"}}}),
///         local.config.scheduler, 2);
///
/// These headers are kept stable: what is renamed or removed here stands in CHANGELOG.rst, and the
/// minor version grows with it. The link target is hires::core (docs/own_code.md).

#include "hires/base/error.h"                     // ConfigError, what bad input throws
#include "hires/imagination/evidence.h"           // Evidence
#include "hires/imagination/imagination_setup.h"  // files in, ImaginationSetup out
#include "hires/imagination/local_imagination.h"  // ImagineLocally
#include "hires/imagination/local_setup.h"        // LoadLocalSetup
#include "hires/imagination/report.h"             // Report
#include "hires/imagination/rollout.h"            // PlayRollout
#include "hires/imagination/rollout_recording.h"  // RecordRollout
#include "hires/imagination/start_state.h"        // StartState
#include "hires/robot/load_robot.h"               // LoadAnyRobot
#include "hires/robot/robot_model.h"              // RobotModel
#include "hires/skills/skill.h"                   // Skill
#include "hires/world/world.h"                    // World
