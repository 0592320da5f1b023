#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "hires/base/action.h"
#include "hires/imagination/start_state.h"
#include "hires/simulation/truth_record.h"
#include "loop/task_loop.h"
#include "sim_robot/truth.h"

namespace hires::lab {

/// One action that is to be done on the robot that stands in for a real one.
struct ActionOrder {
  imagination::StartState start;  ///< as the robot believes; how it really is the truth draws
  base::ActionCall action;
  sim_robot::Truth truth;    ///< what robot and world are really like
  std::uint64_t seed{1};     ///< of what of it is hidden, and of all noise
  double time_limit{300.0};  ///< [s] of virtual time
};

/// What became of it.
struct ActionRun {
  base::Failure failure;       ///< of the action itself; nothing: it reached its goal
  double duration{0.0};        ///< [s] of the action
  simulation::RunTruth truth;  ///< how things really stand, once what still shakes has come to rest
  double virtual_seconds{0.0};  ///< [s] from the robot's start to the end
};

/// Does one action with robot, world and middle layer of a task (PlayTask), without planner,
/// monitor and tracker: what the robot knows of objects is told once, at the start. The same order
/// gives the same bits.
/// @param cancelled  asked every tick; may be empty.
/// @return nothing when cancelled. An action that makes no sense ends at once, as kInvalidAction.
std::optional<ActionRun> PlayAction(const loop::LoopSetup& setup, const ActionOrder& order,
                                    const std::function<bool()>& cancelled = {});

}  // namespace hires::lab
