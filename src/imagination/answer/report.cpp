#include "hires/imagination/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "hires/base/check.h"
#include "hires/base/text.h"

namespace hires::imagination {
namespace {

std::string WhyNothing(const Scheduler& scheduler, ImaginationOutcome outcome) {
  const auto& problems = scheduler.worker_problems();
  const std::string suffix = problems.empty() ? "" : " (" + base::Join(problems, "; ") + ")";
  switch (outcome) {
    case ImaginationOutcome::kNoWorker:
      return "no worker is there to imagine it" + suffix;
    case ImaginationOutcome::kNothingFinished:
      return "the deadline came before every alternative was played once" + suffix;
    case ImaginationOutcome::kCancelled:
      return "cancelled";
    default:
      return suffix;
  }
}

/// From indices of alternatives to places of the order.
void CallByPlace(const std::vector<int>& order, CostReasons* reasons) {
  const auto place = [&](int alternative) {
    return static_cast<int>(std::find(order.begin(), order.end(), alternative) - order.begin());
  };
  if (reasons->next) reasons->next->other = place(reasons->next->other);
  if (reasons->turning) reasons->turning->other = place(reasons->turning->other);
}

std::vector<std::string> NamesOf(const std::vector<base::ActionCall>& actions) {
  std::vector<std::string> names;
  for (const base::ActionCall& action : actions) names.push_back(base::ToString(action));
  return names;
}

/// Void rollouts are counted apart; as far as they go, an alternative is taken to have failed.
void AddVoid(Report* report) {
  int num_void = 0, num_rollouts = 0;
  std::set<std::string> names;
  for (const Prediction& prediction : report->ranking) {
    num_rollouts += prediction.evidence.num_rollouts;
    for (const auto& [failure, count] : prediction.evidence.failures) {
      if (failure.code != base::FailureCode::kPhysicsBroke) continue;
      num_void += count;
      names.insert(failure.subjects.begin(), failure.subjects.end());
    }
  }
  if (num_void == 0) return;
  report->caveats.push_back(
      fmt::format("{} of {} rollouts are void (physics_broke): {} gained energy that nothing gave "
                  "it. They count as not "
                  "succeeded, and say nothing of the robot; look at its shapes with `hires doctor`",
                  num_void, num_rollouts,
                  base::Join(std::vector<std::string>(names.begin(), names.end()), ", ")));
}

}  // namespace

std::vector<Prediction> PredictionsOf(const Scheduler& scheduler, const Ranking& ranking,
                                      const std::vector<base::ActionCall>& actions,
                                      bool with_final_states) {
  std::vector<Prediction> predictions;
  if (ranking.num_rollouts == 0) return predictions;
  for (const int alternative : ranking.order) {
    Prediction prediction{actions[alternative], alternative, ranking.evidence[alternative], {}, {}};
    const int median = prediction.evidence.median_rollout;
    if (with_final_states && median >= 0) {
      const RolloutResult& result = scheduler.Prefix(alternative)[median];
      prediction.final_world = result.final_world;
      prediction.final_robot = result.final_robot;
    }
    predictions.push_back(std::move(prediction));
  }
  return predictions;
}

Report MakeReport(const Scheduler& scheduler, const std::vector<base::ActionCall>& actions,
                  std::uint64_t seed, double wall_seconds,
                  const std::set<std::pair<int, int>>& kept, bool is_one_truth) {
  HIRES_CHECK(scheduler.finished(), "there is no result yet");
  const SchedulerResult& result = *scheduler.result();
  const Ranking& ranking = result.ranking;
  Report report;
  report.outcome = result.outcome;
  report.found = result.found;
  report.complete = result.complete;
  report.seed = seed;
  report.wall_seconds = wall_seconds;
  report.ranking = PredictionsOf(scheduler, ranking, actions, true);
  for (std::size_t alternative = 0; alternative < actions.size(); ++alternative) {
    const auto& prefix = scheduler.Prefix(static_cast<int>(alternative));
    const int count = ranking.num_rollouts > 0 ? ranking.evidence[alternative].num_rollouts : 0;
    for (int i = 0; i < count; ++i) report.simulated_seconds += prefix[i].simulated;
  }
  for (const auto& [alternative, index] : kept) {
    if (ranking.num_rollouts == 0 || index >= ranking.evidence[alternative].num_rollouts) continue;
    ++report.kept.rollouts;
    report.kept.simulated_seconds += scheduler.Prefix(alternative)[index].simulated;
  }
  if (scheduler.num_mismatches() > 0) {
    report.caveats.push_back(fmt::format(
        "{} rollouts came twice and differed: workers that play one rollout differently",
        scheduler.num_mismatches()));
  }
  AddVoid(&report);
  for (std::size_t place = 0; place < ranking.order.size(); ++place) {
    if (ranking.recommended == ranking.order[place]) report.recommended = static_cast<int>(place);
  }
  if (ranking.num_rollouts == 0) {
    report.why = WhyNothing(scheduler, result.outcome);
    return report;
  }
  const Criteria& criteria = scheduler.params().criteria;
  report.by_cost = CostReasonsOf(ranking.evidence, criteria);
  if (report.by_cost) report.by_cost->is_one_truth = is_one_truth;
  report.why = WhyRecommended(ranking.evidence, criteria, NamesOf(actions),
                              report.by_cost ? &*report.by_cost : nullptr);
  if (!report.complete) report.why += "; stopped by " + result.stopped_by;
  if (report.by_cost) CallByPlace(ranking.order, &*report.by_cost);
  return report;
}

}  // namespace hires::imagination
