#include <algorithm>

#include "hires/base/rng.h"
#include "lab/src/decision/decision_report.h"

namespace hires::lab {
namespace {

constexpr int kBins = 10;

/// One imagined step and what happened.
struct PlayedStep {
  const DecisionTask& task;
  const std::string& motion_set;
  const ImaginedDrive& imagined;
  const TruthPlay& play;

  double share() const {
    return imagined.num_rollouts == 0
               ? 0.0
               : static_cast<double>(imagined.num_success) / imagined.num_rollouts;
  }
};

std::vector<PlayedStep> StepsOf(const std::vector<DecisionRecord>& records) {
  std::vector<PlayedStep> steps;
  for (const DecisionRecord& record : records) {
    for (const auto& [set, imagined] : record.imagined.drives) {
      if (imagined.num_rollouts == 0) continue;
      steps.push_back({record.task, set, imagined, record.plays.at(set)});
    }
  }
  return steps;
}

std::vector<Forecast> ForecastsOf(const std::vector<PlayedStep>& steps) {
  std::vector<Forecast> forecasts;
  for (const PlayedStep& step : steps) forecasts.push_back({step.share(), step.play.success()});
  return forecasts;
}

/// Shares as probabilities: 64 of 64 is no certainty.
std::vector<Forecast> SmoothForecastsOf(const std::vector<PlayedStep>& steps) {
  std::vector<Forecast> forecasts;
  for (const PlayedStep& step : steps) {
    const double p = (step.imagined.num_success + 0.5) / (step.imagined.num_rollouts + 1.0);
    forecasts.push_back({p, step.play.success()});
  }
  return forecasts;
}

void TestShares(const std::vector<PlayedStep>& steps, CalibrationReport* report) {
  std::vector<Replayed> replayed;
  for (const PlayedStep& step : steps) {
    replayed.push_back(
        {step.imagined.num_success, step.imagined.num_rollouts, step.play.success()});
  }
  report->exchange = ExchangeTest(replayed);
  report->spiegelhalter = SpiegelhalterTest(SmoothForecastsOf(steps));
}

void TestDurations(const std::vector<PlayedStep>& steps, base::Rng rng, CalibrationReport* report) {
  std::vector<double> pits;
  int covered = 0;
  report->pit.assign(kBins, 0);
  for (const PlayedStep& step : steps) {
    if (!step.play.success() || step.imagined.durations.empty()) continue;
    const double pit = RandomisedPit(step.imagined.durations, step.play.duration, &rng);
    pits.push_back(pit);
    covered += pit >= 0.05 && pit < 0.95 ? 1 : 0;
    ++report->pit[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(pit * kBins)))];
  }
  report->num_durations = static_cast<int>(pits.size());
  report->duration_coverage = ShareInterval(covered, report->num_durations);
  report->pit_uniform = UniformTest(pits);
}

CalibrationReport::Group GroupOf(const std::string& name, const std::vector<PlayedStep>& steps) {
  CalibrationReport::Group group;
  group.name = name;
  group.num_steps = static_cast<int>(steps.size());
  for (const PlayedStep& step : steps) {
    group.num_success += step.play.success() ? 1 : 0;
    group.predicted += step.share() / static_cast<double>(steps.size());
  }
  group.success = ShareInterval(group.num_success, group.num_steps);
  group.brier = Brier(ForecastsOf(steps), kBins);
  return group;
}

template <typename NameOf>
void AddGroups(const std::vector<PlayedStep>& steps, const NameOf& name_of,
               CalibrationReport* report) {
  std::map<std::string, std::vector<PlayedStep>> by_name;
  for (const PlayedStep& step : steps) by_name[name_of(step)].push_back(step);
  for (const auto& [name, group] : by_name) report->groups.push_back(GroupOf(name, group));
}

/// An action with what was foretold and what is true, over all tasks that have it.
struct Action {
  int num_rollouts{0}, num_success{0};
  double real{0.0};
};

double SuccessShare(const std::vector<TruthPlay>& plays) {
  const auto successes = std::count_if(plays.begin(), plays.end(),
                                       [](const TruthPlay& play) { return play.success(); });
  return static_cast<double>(successes) / static_cast<double>(plays.size());
}

void CompareWithOracle(const std::vector<DecisionRecord>& records, CalibrationReport* report) {
  std::map<std::string, Action> actions;
  int covered = 0, num_intervals = 0;
  for (const DecisionRecord& record : records) {
    for (const auto& [set, plays] : record.oracle) {
      const auto imagined = record.imagined.drives.find(set);
      if (imagined == record.imagined.drives.end() || imagined->second.num_rollouts == 0) continue;
      Action& action = actions[CellOf(record.task) + "/" + set];
      action.real = SuccessShare(plays);
      action.num_rollouts += imagined->second.num_rollouts;
      action.num_success += imagined->second.num_success;
      ++num_intervals;
      covered += imagined->second.lower <= action.real && action.real <= imagined->second.upper;
    }
  }
  std::vector<double> foretold, real;
  for (const auto& [name, action] : actions) {
    foretold.push_back(static_cast<double>(action.num_success) / action.num_rollouts);
    real.push_back(action.real);
  }
  report->num_actions = static_cast<int>(actions.size());
  report->correlation = PearsonCorrelation(foretold, real);
  report->rank_violation = MeanMaximumRankViolation(foretold, real);
  report->success_coverage = ShareInterval(covered, num_intervals);
}

}  // namespace

CalibrationReport Calibrate(const std::vector<DecisionRecord>& records, std::uint64_t seed) {
  CalibrationReport report;
  const std::vector<PlayedStep> steps = StepsOf(records);
  const std::vector<Forecast> forecasts = ForecastsOf(steps);
  report.num_steps = static_cast<int>(steps.size());
  report.brier = Brier(forecasts, kBins);
  report.diagram = ReliabilityDiagram(forecasts, kBins);
  TestShares(steps, &report);
  TestDurations(steps, base::Rng(seed), &report);
  AddGroups(
      steps, [](const PlayedStep& step) { return step.motion_set; }, &report);
  AddGroups(
      steps, [](const PlayedStep& step) { return step.task.load + " " + step.motion_set; },
      &report);
  CompareWithOracle(records, &report);
  return report;
}

}  // namespace hires::lab
