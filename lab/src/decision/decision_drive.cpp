#include "lab/src/decision/decision_drive.h"

#include "hires/base/process.h"
#include "hires/base/resource_use.h"
#include "lab/src/decision/action_loop.h"

namespace hires::lab {

std::optional<TruthPlay> PlayDrive(const loop::LoopSetup& setup, const sim_robot::Truth& truth,
                                   const DecisionTask& task, const std::string& motion_set,
                                   std::uint64_t seed, const std::function<bool()>& cancelled) {
  const double begin = base::SteadyNow(), used = base::ThreadCpuSeconds();
  const imagination::ImaginationSetup& world = setup.world();
  const ActionOrder order{StartOf(world, task), ActionOf(task, motion_set), truth, seed,
                          world.rollout.time_limit};
  const auto run = PlayAction(setup, order, cancelled);
  if (!run) return std::nullopt;
  TruthPlay play = JudgeDrive(run->failure, run->duration, run->truth, task.load);
  play.virtual_seconds = run->virtual_seconds;
  play.wall_seconds = base::SteadyNow() - begin;
  play.processor_seconds = base::ThreadCpuSeconds() - used;
  return play;
}

}  // namespace hires::lab
