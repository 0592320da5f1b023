#include "cli/verbs/imagine/query_scene.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/imagination/local_imagination.h"
#include "hires/skills/skill_factory.h"
#include "imagination/object_support.h"

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

void RequireNames(const ImagineQuery& query, QueryScene* scene) {
  const imagination::ImaginationSetup& setup = scene->setup();
  std::vector<std::string> problems;
  const auto check = [&](const std::function<void()>& use) {
    try {
      use();
    } catch (const base::ConfigError& error) {
      if (std::count(problems.begin(), problems.end(), error.what()) == 0)
        problems.push_back(error.what());
    }
  };
  check([&] { imagination::MakeStartState(setup, query.start.from, {}); });
  check([&] { RequirePostures(query.start, setup.scene->robot); });
  for (const std::string& object : query.start.Objects()) {
    if (setup.scene->world.initial.Find(object) != nullptr) continue;
    check([&] {
      imagination::RefuseFixed(setup, object);
      setup.ModelOf(object);
    });
  }
  for (const base::ActionCall& action : base::Combinations(query.action))
    check([&] { skills::MakeSkill(*setup.skills, action); });
  if (!problems.empty()) throw base::ConfigError(base::AllThatIsWrong("the question", problems));
}

namespace {

/// Of what is put by numbers in the map.
void RequireSupport(const std::vector<imagination::PutObject>& put,
                    const imagination::RolloutSetup& rollouts) {
  std::vector<std::string> objects;
  for (const imagination::PutObject& one : put)
    if (one.area.empty()) objects.push_back(one.object);
  const std::vector<std::string> why = imagination::WhyUnsupported(objects, rollouts);
  if (!why.empty()) throw base::ConfigError("--put: " + base::Join(why, "; "));
}

}  // namespace

imagination::Report ImagineInThisProcess(const ImagineQuery& query, QueryScene* scene,
                                         const imagination::OnInterim& on_interim,
                                         const std::function<bool()>& cancelled) {
  const std::vector<base::ActionCall> actions = base::Combinations(query.action);
  const imagination::RolloutSetup& rollouts = scene->rollouts();
  RequireObjects(rollouts.skills->actions->catalogue(), actions, rollouts.world_state);
  RequireSupport(query.start.put, rollouts);
  imagination::Report report = imagination::ImagineLocally(rollouts, actions, query.scheduler,
                                                           query.threads, on_interim, cancelled);
  imagination::AddCaveats(rollouts, actions, query.validated, &report);
  return report;
}

}  // namespace hires::cli
