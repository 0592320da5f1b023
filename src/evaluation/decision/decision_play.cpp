#include <deque>
#include <utility>

#include "hires/base/process.h"
#include "hires/base/rng.h"
#include "hires/evaluation/decision.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout.h"

namespace hires::evaluation {
namespace {

using imagination::Report;
using imagination::RolloutResult;
using imagination::RolloutSetup;
using imagination::SchedulerParams;

/// Rollouts of a task, each played once however many arms and prices ask for it.
class RolloutBook {
 public:
  RolloutBook(RolloutSetup setup, std::vector<base::ActionCall> actions)
      : setup_(std::move(setup)), actions_(std::move(actions)) {}

  const std::vector<base::ActionCall>& actions() const { return actions_; }
  std::uint64_t seed() const { return setup_.seed; }
  double time_limit() const { return setup_.params.time_limit; }

  const RolloutResult& At(int alternative, int index) {
    const auto [entry, is_new] = played_.try_emplace({alternative, index});
    if (is_new) {
      const double begin = base::SteadyNow();
      const auto& action = actions_.at(static_cast<std::size_t>(alternative));
      entry->second.result = *imagination::PlayRollout(setup_, action, index);
      entry->second.wall_seconds = base::SteadyNow() - begin;
    }
    return entry->second.result;
  }

  /// [s] that the first rollouts of each alternative took.
  double WallSeconds(int num_rollouts) const {
    double sum = 0.0;
    for (const auto& [key, played] : played_) {
      if (key.second < num_rollouts) sum += played.wall_seconds;
    }
    return sum;
  }

 private:
  struct Played {
    RolloutResult result;
    double wall_seconds{0.0};
  };
  const RolloutSetup setup_;
  const std::vector<base::ActionCall> actions_;
  std::map<std::pair<int, int>, Played> played_;  // by alternative and index
};

/// The scheduler of every imagination, with one worker: its answer does not depend on their number.
/// @return nothing when cancelled.
std::optional<Report> Imagine(SchedulerParams params, const DecisionParts& parts,
                              RolloutBook* book) {
  params.deadline = 0.0;
  params.criteria.prices.time_limit = book->time_limit();
  imagination::Scheduler scheduler(params, static_cast<int>(book->actions().size()), 0.0);
  std::deque<imagination::Command> due;
  const auto handle = [&](const imagination::Event& event) {
    for (const imagination::Command& command : scheduler.Handle(event, 0.0)) due.push_back(command);
  };
  handle(imagination::WorkerJoined{0});
  while (!scheduler.finished()) {
    const auto assign = std::get<imagination::Assign>(due.front());
    due.pop_front();
    for (int i = assign.first_index; i < assign.first_index + assign.count; ++i) {
      if (scheduler.finished()) break;
      if (parts.cancelled && parts.cancelled()) return std::nullopt;
      handle(imagination::RolloutFinished{0, assign.assignment, assign.alternative, i,
                                          book->At(assign.alternative, i)});
    }
    handle(imagination::AssignmentFinished{0, assign.assignment});
  }
  return imagination::MakeReport(scheduler, book->actions(), book->seed(), 0.0);
}

/// What the execution monitor makes of an answer: what is recommended; nothing, where all fail; the
/// default, where it is open or the ranking is the dissertation's.
std::string ChosenSet(const Report& report, const SchedulerParams& params,
                      const std::string& default_motion_set) {
  if (report.recommended >= 0) {
    const auto& best = report.ranking.at(static_cast<std::size_t>(report.recommended));
    return best.action.arguments.back();
  }
  const bool is_out = report.outcome == imagination::ImaginationOutcome::kAllFailed &&
                      params.criteria.rule != imagination::RankingRule::kThesis;
  return is_out ? "" : default_motion_set;
}

SchedulerParams ByCost(const DecisionTask& task, const DecisionParts& parts, double scale) {
  SchedulerParams params = parts.scheduler;
  params.criteria.rule = imagination::RankingRule::kCost;
  params.criteria.prices = PricesOf(task, parts.scheduler.criteria.prices, scale);
  return params;
}

/// One rollout of each, by Eq. 6.1.
SchedulerParams AsInTheDissertation(const DecisionParts& parts) {
  SchedulerParams params = parts.scheduler;
  params.criteria.rule = imagination::RankingRule::kThesis;
  params.rollouts = params.first_look = 1;
  params.early_stop = false;
  return params;
}

/// Sums up what was imagined with prices as they are.
void Note(const Report& report, RolloutBook* book, DecisionRecord* record) {
  for (const imagination::Prediction& prediction : report.ranking) {
    const imagination::Evidence& evidence = prediction.evidence;
    ImaginedDrive& drive = record->imagined[prediction.action.arguments.back()];
    drive.num_rollouts = evidence.num_rollouts;
    drive.lower = evidence.success.lower;
    drive.upper = evidence.success.upper;
    drive.cost = evidence.cost ? evidence.cost->mean : 0.0;
    for (int i = 0; i < evidence.num_rollouts; ++i) {
      const RolloutResult& result = book->At(prediction.alternative, i);
      if (imagination::FailureOf(result)) continue;
      ++drive.num_success;
      drive.durations.push_back(result.duration);
    }
  }
}

/// @return false when cancelled.
bool ImagineByCost(const DecisionParts& parts, RolloutBook* book, DecisionRecord* record) {
  Decided& decided = record->decided[kImaginationArm];
  for (const double scale : PriceScales()) {
    const SchedulerParams params = ByCost(record->task, parts, scale);
    const auto report = Imagine(params, parts, book);
    if (!report) return false;
    decided.motion_sets.push_back(ChosenSet(*report, params, parts.default_motion_set));
    if (decided.motion_sets.size() > 1) continue;
    decided.simulated_seconds = report->simulated_seconds;
    decided.wall_seconds = book->WallSeconds(report->ranking.front().evidence.num_rollouts);
    Note(*report, book, record);
  }
  return true;
}

/// @return false when cancelled.
bool ImagineOnce(const DecisionParts& parts, RolloutBook* book, DecisionRecord* record) {
  const SchedulerParams params = AsInTheDissertation(parts);
  const auto report = Imagine(params, parts, book);
  if (!report) return false;
  Decided& decided = record->decided[kDissertationArm];
  const std::string choice = ChosenSet(*report, params, parts.default_motion_set);
  decided.motion_sets.assign(PriceScales().size(), choice);
  decided.simulated_seconds = report->simulated_seconds;
  decided.wall_seconds = book->WallSeconds(1);
  return true;
}

/// @return false when cancelled.
bool PlayOracle(const DecisionParts& parts, DecisionRecord* record) {
  const base::Rng rng(record->task.oracle_seed);
  for (const std::string& motion_set : DecisionAlternatives()) {
    std::vector<TruthPlay>& plays = record->oracle[motion_set];
    for (int i = 0; i < parts.oracle_plays; ++i) {
      const std::uint64_t seed = rng.Fork(static_cast<std::uint64_t>(i)).seed() & 0x7fffffff;
      const auto play = parts.play(record->task, motion_set, seed);
      if (!play) return false;
      plays.push_back(*play);
    }
  }
  return true;
}

}  // namespace

std::optional<DecisionRecord> PlayDecision(const DecisionTask& task, const DecisionParts& parts,
                                           const DecisionRecord* known) {
  DecisionRecord record;
  record.task = task;
  std::vector<base::ActionCall> actions;
  for (const std::string& set : DecisionAlternatives()) actions.push_back(ActionOf(task, set));
  const RolloutSetup setup =
      imagination::MakeRolloutSetup(parts.setup, StartOf(parts.setup, task), task.imagination_seed);
  imagination::CheckSetupForAll(setup, actions);
  RolloutBook book(setup, actions);
  if (parts.imagines && !ImagineByCost(parts, &book, &record)) return std::nullopt;
  if (parts.is_dissertation && !ImagineOnce(parts, &book, &record)) return std::nullopt;
  for (const std::string& motion_set : DecisionAlternatives()) {
    const auto play = parts.play(task, motion_set, task.truth_seed);
    if (!play) return std::nullopt;
    record.plays[motion_set] = *play;
  }
  if (parts.oracle_plays == 0) return record;
  if (known != nullptr) {
    record.oracle = known->oracle;
  } else if (!PlayOracle(parts, &record)) {
    return std::nullopt;
  }
  return record;
}

}  // namespace hires::evaluation
