#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "hires/base/text.h"
#include "hires/imagination/evidence.h"
#include "lab/src/experiment/kinds.h"
#include "lab/src/statistics.h"

namespace hires::lab {
namespace {

using imagination::RolloutResult;

double ShakingShare(const RolloutResult& result) {
  const int total = result.counts.total();
  return total == 0 ? 0.0 : static_cast<double>(result.counts.shaking) / total;
}

std::vector<double> ShakingShares(const Rollouts& rollouts) {
  std::vector<double> shares;
  for (const RolloutResult& result : rollouts) shares.push_back(ShakingShare(result));
  return shares;
}

int NumFallen(const Rollouts& rollouts) {
  int fallen = 0;
  for (const RolloutResult& result : rollouts) fallen += result.falls > 0;
  return fallen;
}

int NumFailed(const Rollouts& rollouts) {
  int failed = 0;
  for (const RolloutResult& result : rollouts) failed += imagination::ActionFailed(result);
  return failed;
}

Interval ShakingDifference(const std::vector<Rollouts>& rollouts) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < rollouts[0].size(); ++i) {
    differences.push_back(ShakingShare(rollouts[0][i]) - ShakingShare(rollouts[1][i]));
  }
  return MeanInterval(differences);
}

PairedCounts FallCounts(const std::vector<Rollouts>& rollouts) {
  PairedCounts counts;
  counts.num_pairs = static_cast<int>(rollouts[0].size());
  for (std::size_t i = 0; i < rollouts[0].size(); ++i) {
    const bool first = rollouts[0][i].falls > 0, second = rollouts[1][i].falls > 0;
    counts.only_first += first && !second;
    counts.only_second += second && !first;
  }
  return counts;
}

std::vector<std::string> SetRow(const std::string& motion_set, const Rollouts& rollouts) {
  imagination::OutcomeCounts counts;
  for (const RolloutResult& result : rollouts) counts += result.counts;
  const imagination::Evidence evidence = imagination::SumUp(rollouts);
  const std::vector<double> shares = ShakingShares(rollouts);
  const int n = static_cast<int>(rollouts.size());
  const auto falls = imagination::EstimateSuccess(NumFallen(rollouts), n,
                                                  imagination::IntervalKind::kClopperPearson);
  return {motion_set,
          fmt::format("{}", n),
          fmt::format("{:.4f}", base::Mean(shares)),
          fmt::format("{:.4f}", counts.shaking / std::max(1.0, double(counts.total()))),
          fmt::format("{:.4f}", falls.share),
          fmt::format("{:.4f} .. {:.4f}", falls.lower, falls.upper),
          fmt::format("{}", NumFailed(rollouts)),
          fmt::format("{:.3f}", evidence.confidence_mean),
          fmt::format("{:.1f} ± {:.1f} s", evidence.duration.mean, evidence.duration.sd)};
}

std::vector<std::string> DifferenceRow(const std::string& what, const Interval& difference,
                                       const std::string& method) {
  return {what,
          fmt::format("{:.4f}", difference.estimate),
          fmt::format("{:.4f}", difference.lower),
          fmt::format("{:.4f}", difference.upper),
          difference.ExcludesZero() ? "yes" : "no",
          method};
}

TextTable DifferenceTable(const PairedConfig& paired, const Interval& shaking,
                          const PairedCounts& falls) {
  TextTable table{"Paired differences, " + paired.motion_sets[0] + " - " + paired.motion_sets[1],
                  {{"", "difference", "lower", "upper", "excludes 0", "interval at 95 %"}}};
  table.rows.push_back(
      DifferenceRow("share of shaking samples", shaking, "Student's t of paired differences"));
  table.rows.push_back(
      DifferenceRow("share of rollouts with falls", PairedShareDifference(falls),
                    fmt::format("exact, given the discordant pairs {} : {} (McNemar p {:.2g})",
                                falls.only_first, falls.only_second, McNemarPValue(falls))));
  return table;
}

void AddInterval(const std::string& name, const Interval& interval, std::vector<Measure>* to) {
  to->push_back({name, interval.estimate});
  to->push_back({name + "_lower", interval.lower});
  to->push_back({name + "_upper", interval.upper});
}

nlohmann::ordered_json RowOf(const std::string& motion_set, int index,
                             const RolloutResult& result) {
  return {{"motion_set", motion_set},
          {"rollout", index},
          {"failure", base::ToString(result.failure.code)},
          {"subjects", base::Join(result.failure.subjects, " ")},
          {"action_finished", result.action_finished},
          {"duration", result.duration},
          {"notopple", result.counts.notopple},
          {"shaking", result.counts.shaking},
          {"topple", result.counts.topple},
          {"falls", result.falls},
          {"max_tilt", result.max_tilt},
          {"first_cause", result.first_cause}};
}

}  // namespace

std::optional<std::vector<Rollouts>> PlayPaired(const PairedConfig& paired,
                                                const ExperimentConfig& config, const Stage& stage,
                                                const base::Crew& crew) {
  const imagination::RolloutSetup setup = SetupAt(stage, paired.from, config.seed);
  std::vector<Rollouts> rollouts(2, Rollouts(paired.pairs));
  const auto play = [&](int task, const base::Advance& advance) {
    const int set = task % 2, index = task / 2;
    auto result = imagination::PlayRollout(setup, DriveTo(paired.to, paired.motion_sets[set]),
                                           index, {crew.cancelled, {}});
    if (result) rollouts[set][index] = *std::move(result);
    advance(1.0);
  };
  if (!base::DoInParallel(2 * paired.pairs, 2.0 * paired.pairs, crew, play)) return std::nullopt;
  return rollouts;
}

Findings SumUpPaired(const PairedConfig& paired, const std::vector<Rollouts>& rollouts) {
  Findings findings;
  const Interval shaking = ShakingDifference(rollouts);
  const PairedCounts falls = FallCounts(rollouts);
  TextTable sets{fmt::format("{} -> {}", paired.from, paired.to),
                 {{"motion set", "rollouts", "shaking, mean share", "pooled", "with falls",
                   "interval at 95 %", "failed", "confidence", "duration"}}};
  findings.measures.push_back({"pairs", static_cast<double>(falls.num_pairs)});
  AddInterval("shaking_difference", shaking, &findings.measures);
  AddInterval("fall_difference", PairedShareDifference(falls), &findings.measures);
  findings.measures.push_back({"fall_p_value", McNemarPValue(falls)});
  for (std::size_t s = 0; s < 2; ++s) {
    const std::string& name = paired.motion_sets[s];
    const double n = rollouts[s].size();
    sets.rows.push_back(SetRow(name, rollouts[s]));
    findings.measures.push_back({"shaking_share_" + name, base::Mean(ShakingShares(rollouts[s]))});
    findings.measures.push_back({"fall_share_" + name, NumFallen(rollouts[s]) / n});
    findings.measures.push_back({"failed_" + name, static_cast<double>(NumFailed(rollouts[s]))});
    for (std::size_t i = 0; i < rollouts[s].size(); ++i) {
      findings.rows.push_back(RowOf(name, static_cast<int>(i), rollouts[s][i]));
      findings.simulated_seconds += rollouts[s][i].simulated;
    }
  }
  findings.tables = {std::move(sets), DifferenceTable(paired, shaking, falls)};
  return findings;
}

}  // namespace hires::lab
