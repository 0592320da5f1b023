#include "cli/verbs/imagine/query_scene.h"

#include "hires/imagination/local_imagination.h"

namespace hires::cli {

const imagination::ImaginationSetup& QueryScene::setup() {
  if (!setup_) setup_ = imagination::LoadImaginationSetup(query_.setup);
  return *setup_;
}

const imagination::RolloutSetup& QueryScene::rollouts() {
  if (rollouts_) return *rollouts_;
  const imagination::StartState start =
      imagination::MakeStartState(setup(), query_.start.AllAtoms(), query_.start.put);
  rollouts_ = imagination::MakeRolloutSetup(setup(), start, query_.seed);
  return *rollouts_;
}

imagination::Report ImagineInThisProcess(const ImagineQuery& query, QueryScene* scene,
                                         const imagination::OnInterim& on_interim,
                                         const std::function<bool()>& cancelled) {
  const imagination::RolloutSetup& rollouts = scene->rollouts();
  const std::vector<base::ActionCall> actions = base::Combinations(query.action);
  RequireObjects(rollouts.skills->actions->catalogue(), actions, rollouts.world_state);
  imagination::Report report = imagination::ImagineLocally(rollouts, actions, query.scheduler,
                                                           query.threads, on_interim, cancelled);
  imagination::AddCaveats(rollouts, actions, query.validated, &report);
  return report;
}

}  // namespace hires::cli
