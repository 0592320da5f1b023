#include "lab/src/decision/decision_report.h"

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/rng.h"

namespace hires::lab {
namespace {

using imagination::Prices;

double MeanCost(const std::vector<TruthPlay>& plays, const Prices& prices) {
  double sum = 0.0;
  for (const TruthPlay& play : plays) sum += CostOf(play, prices);
  return sum / static_cast<double>(plays.size());
}

/// The motion set whose plays cost least.
std::string OraclesChoice(const DecisionRecord& record, const Prices& prices) {
  std::string best;
  double least = 0.0;
  for (const std::string& set : DecisionAlternatives()) {
    const double cost = MeanCost(record.oracle.at(set), prices);
    if (!best.empty() && cost >= least) continue;
    best = set;
    least = cost;
  }
  return best;
}

/// What an arm chose in a task.
std::string ChoiceOf(const std::string& arm, const DecisionSetting& setting,
                     const DecisionRecord& record, std::size_t scale, const Prices& prices) {
  if (arm == kSlowArm) return "slow";
  if (arm == kFastArm) return "fast";
  if (arm == kDefaultArm) return setting.default_motion_set;
  if (arm == kOracleArm) return OraclesChoice(record, prices);
  return ChoiceOf(record.imagined.decided.at(arm).advice.at(scale), arm,
                  setting.default_motion_set);
}

bool IsUndecided(const std::string& arm, const DecisionRecord& record, std::size_t scale) {
  const auto decided = record.imagined.decided.find(arm);
  return decided != record.imagined.decided.end() &&
         decided->second.advice.at(scale).outcome == imagination::ImaginationOutcome::kUndecided;
}

ArmTask OutcomeOf(const std::string& choice, const DecisionRecord& record, const Prices& prices) {
  ArmTask task;
  task.motion_set = choice;
  task.cost = task.expected = prices.not_done;
  if (choice.empty()) return task;
  const TruthPlay& play = record.plays.at(choice);
  task.cost = task.expected = CostOf(play, prices);
  task.success = play.success();
  task.fell = play.fell();
  const auto plays = record.oracle.find(choice);
  if (plays != record.oracle.end()) task.expected = MeanCost(plays->second, prices);
  return task;
}

void AddEffort(const std::string& arm, const DecisionRecord& record, DecisionArm* to) {
  const auto decided = record.imagined.decided.find(arm);
  if (decided != record.imagined.decided.end()) {
    to->simulated_seconds += decided->second.simulated_seconds;
    to->wall_seconds += decided->second.wall_seconds;
    to->processor_seconds += decided->second.processor_seconds;
  }
  if (arm != kOracleArm) return;
  for (const auto& [set, plays] : record.oracle) {
    for (const TruthPlay& play : plays) {
      to->simulated_seconds += play.virtual_seconds;
      to->wall_seconds += play.wall_seconds;
      to->processor_seconds += play.processor_seconds;
    }
  }
}

template <typename Value>
std::vector<double> Values(const DecisionArm& arm, const Value& value) {
  std::vector<double> values;
  for (const ArmTask& task : arm.tasks) values.push_back(value(task));
  return values;
}

std::vector<double> Costs(const DecisionArm& arm) {
  return Values(arm, [](const ArmTask& task) { return task.cost; });
}

std::vector<double> Expected(const DecisionArm& arm) {
  return Values(arm, [](const ArmTask& task) { return task.expected; });
}

std::vector<double> Less(std::vector<double> first, const std::vector<double>& second) {
  for (std::size_t i = 0; i < first.size(); ++i) first[i] -= second[i];
  return first;
}

DecisionArm SumUp(const std::string& name, const DecisionSetting& setting,
                  const std::vector<DecisionRecord>& records, const Prices& prices,
                  std::size_t scale) {
  DecisionArm arm;
  int num_success = 0;
  for (const DecisionRecord& record : records) {
    const Prices own = PricesOf(record.task, prices, PriceScales()[scale]);
    const std::string choice = ChoiceOf(name, setting, record, scale, own);
    arm.tasks.push_back(OutcomeOf(choice, record, own));
    num_success += arm.tasks.back().success ? 1 : 0;
    arm.falls += arm.tasks.back().fell ? 1 : 0;
    arm.num_undecided += IsUndecided(name, record, scale) ? 1 : 0;
    AddEffort(name, record, &arm);
  }
  arm.cost = MeanInterval(Costs(arm));
  arm.success = ShareInterval(num_success, static_cast<int>(arm.tasks.size()));
  return arm;
}

void AddRegrets(std::map<std::string, DecisionArm>* arms) {
  const auto oracle = arms->find(kOracleArm);
  if (oracle == arms->end()) return;
  for (auto& [name, arm] : *arms) {
    arm.expected = MeanInterval(Expected(arm));
    arm.regret = MeanInterval(Less(Costs(arm), Costs(oracle->second)));
    arm.expected_regret = MeanInterval(Less(Expected(arm), Expected(oracle->second)));
  }
}

ArmComparison Compare(const DecisionArm& imagination, const std::string& name,
                      const DecisionArm& other, const base::Rng& rng) {
  ArmComparison comparison;
  comparison.arm = name;
  const std::vector<double> costs = Less(Costs(imagination), Costs(other));
  comparison.cost = MeanInterval(costs);
  comparison.t_free_p_value = SignFlipPValue(costs, rng.Fork(0));
  if (imagination.expected) {
    const std::vector<double> expected = Less(Expected(imagination), Expected(other));
    comparison.expected = MeanInterval(expected);
    comparison.expected_p_value = SignFlipPValue(expected, rng.Fork(1));
  }
  PairedCounts signs;
  signs.num_pairs = comparison.success.num_pairs = static_cast<int>(costs.size());
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const ArmTask &mine = imagination.tasks[i], &its = other.tasks[i];
    signs.only_first += costs[i] < 0.0 ? 1 : 0;
    signs.only_second += costs[i] > 0.0 ? 1 : 0;
    comparison.success.only_first += mine.success && !its.success ? 1 : 0;
    comparison.success.only_second += its.success && !mine.success ? 1 : 0;
    comparison.num_differ += mine.motion_set != its.motion_set ? 1 : 0;
  }
  comparison.sign_p_value = McNemarPValue(signs);
  return comparison;
}

std::string BestConstant(const std::map<std::string, DecisionArm>& arms) {
  const auto slow = arms.find(kSlowArm), fast = arms.find(kFastArm);
  if (slow == arms.end()) return fast == arms.end() ? "" : kFastArm;
  if (fast == arms.end()) return kSlowArm;
  return slow->second.cost.estimate <= fast->second.cost.estimate ? kSlowArm : kFastArm;
}

ScaledVerdict VerdictAt(std::size_t scale, const DecisionSetting& setting,
                        const std::vector<DecisionRecord>& records, const Prices& prices) {
  ScaledVerdict verdict;
  verdict.scale = PriceScales()[scale];
  for (const std::string& arm : setting.arms) {
    verdict.arms[arm] = SumUp(arm, setting, records, prices, scale);
  }
  AddRegrets(&verdict.arms);
  verdict.best_constant = BestConstant(verdict.arms);
  const auto imagination = verdict.arms.find(kImaginationArm);
  if (imagination == verdict.arms.end()) return verdict;
  for (const std::string& arm : setting.arms) {
    if (arm == kImaginationArm) continue;
    verdict.comparisons.push_back(
        Compare(imagination->second, arm, verdict.arms.at(arm), base::Rng(setting.seed)));
  }
  return verdict;
}

}  // namespace

DecisionReport SumUpDecisions(const DecisionSetting& setting, std::vector<DecisionRecord> records,
                              const Prices& prices) {
  HIRES_CHECK(!records.empty(), "nothing was played");
  std::sort(records.begin(), records.end(), [](const DecisionRecord& a, const DecisionRecord& b) {
    return a.task.number < b.task.number;
  });
  DecisionReport report;
  report.setting = setting;
  report.records = std::move(records);
  for (std::size_t scale = 0; scale < PriceScales().size(); ++scale) {
    report.verdicts.push_back(VerdictAt(scale, setting, report.records, prices));
  }
  if (HasArm(setting.arms, kImaginationArm))
    report.calibration = Calibrate(report.records, setting.seed);
  return report;
}

}  // namespace hires::lab
