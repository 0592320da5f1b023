#include "reports/episode/episode_compare.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "hires/base/error.h"

namespace hires::reports {
namespace {

using imagination::RolloutResult;

constexpr double kEven = 0.5;  // of an interval of success

/// Chance of a duration as short, and of one as long, by what was imagined; with its percentile.
struct Rank {
  double short_chance{1.0}, long_chance{1.0}, percentile{50.0};
};

Rank RankAmong(const std::vector<double>& sorted, double duration) {
  const auto below = std::lower_bound(sorted.begin(), sorted.end(), duration) - sorted.begin();
  const auto up_to = std::upper_bound(sorted.begin(), sorted.end(), duration) - sorted.begin();
  const double n = static_cast<double>(sorted.size());
  const double num_below = static_cast<double>(below), num_up_to = static_cast<double>(up_to);
  return {(num_up_to + 1.0) / (n + 1.0), (n - num_below + 1.0) / (n + 1.0),
          100.0 * (num_below + num_up_to) / (2.0 * n)};
}

std::optional<Rank> RankOf(const ImaginedAction& imagined, double duration) {
  if (imagined.evidence.durations.empty()) return std::nullopt;
  return RankAmong(imagined.evidence.durations, duration);
}

StepVerdict VerdictOn(bool has_succeeded, const imagination::SuccessInterval& success) {
  if (success.lower <= kEven && success.upper >= kEven) return StepVerdict::kUndecided;
  const bool is_expected = success.lower > kEven;
  if (is_expected == has_succeeded) return StepVerdict::kAsImagined;
  return has_succeeded ? StepVerdict::kSucceededAgainst : StepVerdict::kFailedAgainst;
}

/// Void rollouts count as failures, though they say nothing of the robot: without them. What they
/// died of stays among the failures.
void LeaveOutVoid(imagination::Evidence* evidence) {
  int num_void = 0;
  for (const auto& [failure, count] : evidence->failures) {
    if (failure.code == base::FailureCode::kPhysicsBroke) num_void += count;
  }
  const int n = evidence->num_rollouts;
  if (num_void == 0 || num_void > n) return;
  const int num_success = static_cast<int>(std::lround(evidence->success.share * n));
  const int num_failed = static_cast<int>(std::lround(evidence->action_failed_share * n));
  const int num_left = n - num_void;
  evidence->success = imagination::EstimateSuccess(std::min(num_success, num_left), num_left,
                                                   evidence->success.kind);
  evidence->action_failed_share =
      num_left == 0 ? 0.0 : std::max(0.0, static_cast<double>(num_failed - num_void) / num_left);
  evidence->num_rollouts = num_left;
}

/// Why there is nothing to compare with; empty: there is.
std::string WhyNothing(const imagination::Evidence& evidence) {
  if (evidence.num_rollouts > 0) return "";
  return evidence.failures.empty() ? "no rollout was played" : "every rollout is void";
}

}  // namespace

std::string ToString(StepVerdict verdict) {
  switch (verdict) {
    case StepVerdict::kAsImagined:
      return "as imagined";
    case StepVerdict::kFaster:
      return "faster";
    case StepVerdict::kSlower:
      return "slower";
    case StepVerdict::kTooFewDurations:
      return "too few durations";
    case StepVerdict::kFailedAgainst:
      return "failed against the prediction";
    case StepVerdict::kSucceededAgainst:
      return "succeeded against the prediction";
    case StepVerdict::kUndecided:
      return "undecided";
    case StepVerdict::kNotCompared:
      break;
  }
  return "not compared";
}

ComparedStep CompareStep(const EpisodeStep& step, const ImaginedAction& imagined, double surprise) {
  ComparedStep compared{step, imagined, StepVerdict::kNotCompared, {}, step.why_not};
  LeaveOutVoid(&compared.imagined.evidence);
  if (compared.why.empty()) compared.why = imagined.refusal;
  if (compared.why.empty()) compared.why = WhyNothing(compared.imagined.evidence);
  if (!compared.why.empty()) return compared;
  const bool has_succeeded = step.fate == ActionFate::kSucceeded;
  compared.verdict = VerdictOn(has_succeeded, compared.imagined.evidence.success);
  if (!has_succeeded) return compared;
  const std::optional<Rank> rank = RankOf(imagined, step.duration);
  if (!rank) return compared;
  compared.percentile = rank->percentile;
  if (compared.verdict != StepVerdict::kAsImagined) return compared;
  const double least_chance = 1.0 / (static_cast<double>(imagined.evidence.durations.size()) + 1.0);
  if (least_chance >= surprise / 2.0) compared.verdict = StepVerdict::kTooFewDurations;
  if (rank->short_chance < surprise / 2.0) compared.verdict = StepVerdict::kFaster;
  if (rank->long_chance < surprise / 2.0) compared.verdict = StepVerdict::kSlower;
  return compared;
}

std::optional<ImaginedAction> ImagineStep(const imagination::ImaginationSetup& setup,
                                          const EpisodeStep& step, const ReplayParams& params,
                                          std::uint64_t place, const base::Crew& crew) {
  const auto rollouts = imagination::MakeRolloutSetup(setup, step.start, params.seed + place);
  try {
    imagination::CheckSetup(rollouts, step.action);
  } catch (const base::ConfigError& error) {
    ImaginedAction refused;
    refused.refusal = error.what();
    return refused;
  }
  std::vector<std::optional<RolloutResult>> played(static_cast<std::size_t>(params.rollouts));
  const bool is_whole = base::DoInParallel(
      params.rollouts, params.rollouts, crew, [&](int index, const base::Advance& advance) {
        played[static_cast<std::size_t>(index)] =
            imagination::PlayRollout(rollouts, step.action, index, {crew.cancelled, {}});
        advance(1.0);
      });
  if (!is_whole) return std::nullopt;
  std::vector<RolloutResult> results;
  for (auto& result : played) {
    if (!result) return std::nullopt;
    results.push_back(*std::move(result));
  }
  return ImaginedAction{imagination::SumUp(results), {}};
}

}  // namespace hires::reports
