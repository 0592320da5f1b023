#include "lab/src/experiment/hypothesis_local.h"

#include <fmt/format.h>

#include "hires/base/failure.h"
#include "lab/src/dissertation.h"

namespace hires::lab {
namespace {

loop::LoopOrder LoopOrderOf(const HypothesisOrder& order,
                            const std::string& package_folder, const std::string& truth) {
  loop::LoopOrder play;
  play.scenario = package_folder + "/config/scenarios/" + order.scenario + ".yaml";
  play.imagination = order.imagines ? "" : "off";
  play.defaults = kDissertationDefaults;
  play.seed = order.seed;
  play.time_limit = order.goal.time_limit;
  play.truth = truth;
  return play;
}

std::vector<WantedPlace> PlacesIn(const loop::LoopSetup& setup,
                                              const HypothesisGoal& goal) {
  const imagination::ImaginationSetup& world = setup.world();
  const double area_edge = world.skills->manipulation->params.place.area_edge;
  return PlacesOf(goal, world.scene->world, area_edge);
}

}  // namespace

std::optional<HypothesisRun> PlayHypothesisLocally(
    const loop::LoopSetup& setup, const std::string& package_folder, const std::string& truth,
    const HypothesisOrder& order, const std::function<bool()>& cancelled) {
  const loop::LoopRun played =
      loop::PlayTask(setup, LoopOrderOf(order, package_folder, truth), {}, cancelled);
  if (cancelled && cancelled()) return std::nullopt;
  HypothesisRun run;
  CountReport(played.report, &run);
  Judge(order.goal, PlacesIn(setup, order.goal), played.truth, &run);
  run.is_complete = !played.is_timed_out;
  if (played.is_timed_out) {
    run.outcome = base::ToString(base::FailureCode::kTimedOut);
    run.reason = fmt::format("{:g} s simulated are over", order.goal.time_limit);
  }
  return run;
}

}  // namespace hires::lab
