#include "lab/src/decision/decision_play.h"

#include <utility>

#include "hires/base/process.h"
#include "hires/base/resource_use.h"
#include "hires/base/rng.h"
#include "hires/imagination/local_imagination.h"
#include "lab/src/seed.h"

namespace hires::lab {
namespace {

using imagination::Report;
using imagination::RolloutHooks;
using imagination::RolloutResult;
using imagination::RolloutSetup;
using imagination::SchedulerParams;

/// Rollouts of a task, each played once however many arms and prices ask for it. One thread at a
/// time.
class RolloutBook {
 public:
  RolloutBook(RolloutSetup setup, std::vector<base::ActionCall> actions)
      : setup_(std::move(setup)), actions_(std::move(actions)) {}

  const RolloutSetup& setup() const { return setup_; }
  const std::vector<base::ActionCall>& actions() const { return actions_; }

  /// @return nothing when cancelled.
  std::optional<RolloutResult> Play(int alternative, int index, const RolloutHooks& hooks) {
    const auto known = played_.find({alternative, index});
    if (known != played_.end()) return known->second.result;
    const double begin = base::SteadyNow(), used = base::ThreadCpuSeconds();
    auto result = imagination::PlayRollout(
        setup_, actions_.at(static_cast<std::size_t>(alternative)), index, hooks);
    if (!result) return std::nullopt;
    played_[{alternative, index}] = {*result, base::SteadyNow() - begin,
                                     base::ThreadCpuSeconds() - used};
    return result;
  }

  const RolloutResult& At(int alternative, int index) const {
    return played_.at({alternative, index}).result;
  }

  /// Adds what the rollouts behind an answer took.
  void AddEffort(const Report& report, Decided* to) const {
    std::map<int, int> counts;  // by alternative
    for (const imagination::Prediction& prediction : report.ranking) {
      counts[prediction.alternative] = prediction.evidence.num_rollouts;
    }
    for (const auto& [key, played] : played_) {
      if (key.second >= counts[key.first]) continue;
      to->simulated_seconds += played.result.simulated;
      to->wall_seconds += played.wall_seconds;
      to->processor_seconds += played.processor_seconds;
    }
  }

 private:
  struct Played {
    RolloutResult result;
    double wall_seconds{0.0};
    double processor_seconds{0.0};
  };
  const RolloutSetup setup_;
  const std::vector<base::ActionCall> actions_;
  std::map<std::pair<int, int>, Played> played_;  // by alternative and index
};

std::vector<base::ActionCall> ActionsOf(const DecisionTask& task) {
  std::vector<base::ActionCall> actions;
  for (const std::string& set : DecisionAlternatives()) actions.push_back(ActionOf(task, set));
  return actions;
}

RolloutSetup SetupFor(const DecisionTask& task, const DecisionParts& parts) {
  return imagination::MakeRolloutSetup(parts.setup, StartOf(parts.setup, task),
                                       task.imagination_seed);
}

SchedulerParams ByCost(const DecisionTask& task, const DecisionParts& parts, double scale) {
  SchedulerParams params = parts.scheduler;
  params.deadline = 0.0;
  params.criteria.rule = imagination::RankingRule::kCost;
  params.criteria.prices = PricesOf(task, parts.scheduler.criteria.prices, scale);
  return params;
}

/// One rollout of each, by Eq. 6.1.
SchedulerParams AsInTheDissertation(const DecisionTask& task, const DecisionParts& parts) {
  SchedulerParams params = ByCost(task, parts, 1.0);
  params.criteria.rule = imagination::RankingRule::kThesis;
  params.rollouts = params.first_look = 1;
  params.early_stop = false;
  return params;
}

/// @return nothing when cancelled.
std::optional<Report> Ask(const SchedulerParams& params, const DecisionParts& parts,
                          RolloutBook* book) {
  const imagination::PlayOne play = [book](int alternative, int index, const RolloutHooks& hooks) {
    return book->Play(alternative, index, hooks);
  };
  Report report = imagination::ImagineLocally(book->setup(), book->actions(), params, 1, play, {},
                                              parts.cancelled);
  if (report.outcome == imagination::ImaginationOutcome::kCancelled) return std::nullopt;
  return report;
}

Advice AdviceOf(const Report& report) {
  return {report.outcome, report.ranking.front().action.arguments.back()};
}

/// Sums up what was imagined with prices as they are.
std::map<std::string, ImaginedDrive> DrivesOf(const Report& report, const RolloutBook& book) {
  std::map<std::string, ImaginedDrive> drives;
  for (const imagination::Prediction& prediction : report.ranking) {
    const imagination::Evidence& evidence = prediction.evidence;
    ImaginedDrive& drive = drives[prediction.action.arguments.back()];
    drive.num_rollouts = evidence.num_rollouts;
    drive.lower = evidence.success.lower;
    drive.upper = evidence.success.upper;
    drive.cost = evidence.cost ? evidence.cost->mean : 0.0;
    for (int i = 0; i < evidence.num_rollouts; ++i) {
      const RolloutResult& result = book.At(prediction.alternative, i);
      if (imagination::FailureOf(result)) continue;
      ++drive.num_success;
      drive.durations.push_back(result.duration);
    }
  }
  return drives;
}

/// @return false when cancelled.
bool AskByCost(const DecisionTask& task, const DecisionParts& parts, RolloutBook* book,
               ImaginedTask* imagined) {
  Decided& decided = imagined->decided[kImaginationArm];
  for (const double scale : PriceScales()) {
    const auto report = Ask(ByCost(task, parts, scale), parts, book);
    if (!report) return false;
    decided.advice.push_back(AdviceOf(*report));
    if (decided.advice.size() > 1) continue;
    book->AddEffort(*report, &decided);
    imagined->drives = DrivesOf(*report, *book);
  }
  return true;
}

/// @return false when cancelled.
bool AskOnce(const DecisionTask& task, const DecisionParts& parts, RolloutBook* book,
             ImaginedTask* imagined) {
  const auto report = Ask(AsInTheDissertation(task, parts), parts, book);
  if (!report) return false;
  Decided& decided = imagined->decided[kDissertationArm];
  decided.advice.assign(PriceScales().size(), AdviceOf(*report));
  book->AddEffort(*report, &decided);
  return true;
}

}  // namespace

std::optional<ImaginedTask> Imagine(const DecisionTask& task, const DecisionParts& parts) {
  RolloutBook book(SetupFor(task, parts), ActionsOf(task));
  ImaginedTask imagined;
  if (!AskByCost(task, parts, &book, &imagined)) return std::nullopt;
  if (!AskOnce(task, parts, &book, &imagined)) return std::nullopt;
  return imagined;
}

std::optional<std::map<std::string, TruthPlay>> PlayAlternatives(const DecisionTask& task,
                                                                 const DecisionParts& parts) {
  std::map<std::string, TruthPlay> plays;
  for (const std::string& motion_set : DecisionAlternatives()) {
    const auto play = parts.play(task, motion_set, task.truth_seed);
    if (!play) return std::nullopt;
    plays[motion_set] = *play;
  }
  return plays;
}

std::optional<std::vector<TruthPlay>> PlayForOracle(const DecisionTask& task,
                                                    const std::string& motion_set,
                                                    const DecisionParts& parts) {
  const base::Rng rng(task.oracle_seed);
  std::vector<TruthPlay> plays;
  for (int i = 0; i < parts.oracle_plays; ++i) {
    const auto play = parts.play(task, motion_set, SeedOf(rng.Fork(static_cast<std::uint64_t>(i))));
    if (!play) return std::nullopt;
    plays.push_back(*play);
  }
  return plays;
}

}  // namespace hires::lab
