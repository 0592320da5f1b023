#include "evaluation/experience/experience_runs.h"

#include <map>

namespace hires::evaluation {
namespace {

bool IsDown(const knowledge::ToppleEpisodePart& part) {
  return part.state == knowledge::ToppleState::kTopple;
}

}  // namespace

std::vector<ExperienceRun> RunsOf(const knowledge::ExperienceStore& store,
                                  const knowledge::ExperienceQuery& query) {
  std::vector<ExperienceRun> runs;
  std::map<std::string, std::size_t> index;
  store.ForEach(query, [&](const knowledge::ExperienceStore::Stored& stored) {
    const auto [found, is_new] = index.emplace(*stored.run, runs.size());
    if (is_new) runs.push_back({*stored.run, {}, {}});
    ExperienceRun& run = runs[found->second];
    const bool goes_on =
        !run.stretches.empty() && run.actions.back() == *stored.action &&
        stored.part.time - run.stretches.back().back().time < knowledge::kExperienceGap &&
        stored.part.time > run.stretches.back().back().time;
    if (!goes_on) {
      run.actions.push_back(*stored.action);
      run.stretches.emplace_back();
    }
    run.stretches.back().push_back(stored.part);
  });
  return runs;
}

std::vector<std::size_t> OnsetsOf(const Stretch& stretch) {
  std::vector<std::size_t> onsets;
  for (std::size_t i = 1; i < stretch.size(); ++i) {
    if (IsDown(stretch[i]) && !IsDown(stretch[i - 1])) onsets.push_back(i);
  }
  return onsets;
}

}  // namespace hires::evaluation
