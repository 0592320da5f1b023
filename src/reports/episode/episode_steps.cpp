#include "reports/episode/episode_steps.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "hires/base/error.h"
#include "reports/episode/episode_motions.h"

namespace hires::reports {
namespace {

using imagination::ImaginationSetup;

EpisodeStep StepOf(const RecordedAction& action) {
  EpisodeStep step;
  step.action = action.action;
  step.begin = action.begin;
  step.duration = action.duration;
  step.fate = action.fate;
  step.failure = action.failure;
  if (action.fate == ActionFate::kUnknown) step.why_not = "its result was not recorded";
  if (action.fate == ActionFate::kPreempted) step.why_not = "somebody ended it";
  return step;
}

/// Why what was recorded of the robot is not enough, or empty.
std::string GapIn(const Episode& episode, const EpisodeStep& step, const EpisodeConfig& config) {
  const EpisodeSample* begin = episode.At(step.begin);
  if (begin == nullptr || step.begin - begin->time > config.max_gap) {
    return "where the robot stood when it began is not known";
  }
  const double gap = episode.LongestGap(begin->time, step.begin + step.duration);
  if (gap <= config.max_gap) return "";
  return fmt::format("for {:.1f} s of it nothing is known of the robot", gap);
}

/// An action that this world or robot does not have, or cannot begin so, is told by whoever
/// imagines it; names alone are looked at here.
std::string WhyUnknown(const ImaginationSetup& setup, const base::ActionCall& action) {
  try {
    skills::MakeSkill(*setup.skills, action);
    return "";
  } catch (const base::ConfigError& error) {
    return error.what();
  }
}

}  // namespace

std::vector<EpisodeStep> StepsOf(const Episode& episode, const ImaginationSetup& setup,
                                 const EpisodeConfig& config) {
  std::vector<EpisodeStep> steps;
  for (const RecordedAction& action : episode.actions) {
    steps.push_back(StepOf(action));
    if (steps.back().why_not.empty()) steps.back().why_not = WhyUnknown(setup, action.action);
  }
  if (steps.empty()) steps = MotionsOf(episode, setup, config.motions);
  for (EpisodeStep& step : steps) {
    if (step.why_not.empty()) step.why_not = GapIn(episode, step, config);
    const EpisodeSample* begin = episode.At(step.begin);
    if (begin != nullptr) step.start = StartOf(episode, *begin);
  }
  return steps;
}

ImaginationSetup WithGoals(ImaginationSetup setup, const std::vector<EpisodeStep>& steps) {
  auto skills = std::make_shared<skills::SkillSet>(*setup.skills);
  for (const EpisodeStep& step : steps) {
    if (step.goal) skills->areas[step.action.arguments.front()] = *step.goal;
  }
  setup.skills = std::move(skills);
  return setup;
}

}  // namespace hires::reports
