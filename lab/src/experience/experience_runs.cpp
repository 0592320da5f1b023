#include "lab/src/experience/experience_runs.h"

#include <map>
#include <set>

#include "hires/base/text.h"

namespace hires::lab {
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

std::string MotionSetOf(const std::string& action) {
  const std::size_t begin = action.find_last_of(",(");
  if (begin == std::string::npos) return action;
  const std::size_t first = action.find_first_not_of(' ', begin + 1);
  return first == std::string::npos ? "" : action.substr(first, action.find(')', first) - first);
}

std::vector<std::string> MotionSetsOf(const std::vector<ExperienceRun>& runs) {
  std::vector<std::string> texts;
  for (const ExperienceRun& run : runs) {
    std::set<std::string> sets;
    for (const std::string& action : run.actions) sets.insert(MotionSetOf(action));
    texts.push_back(base::Join({sets.begin(), sets.end()}, ", "));
  }
  return texts;
}

std::vector<std::size_t> OnsetsOf(const Stretch& stretch) {
  std::vector<std::size_t> onsets;
  for (std::size_t i = 1; i < stretch.size(); ++i) {
    if (IsDown(stretch[i]) && !IsDown(stretch[i - 1])) onsets.push_back(i);
  }
  return onsets;
}

}  // namespace hires::lab
