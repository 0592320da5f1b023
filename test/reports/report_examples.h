#pragma once

#include "hires/imagination/report.h"

namespace hires::test_support {

/// A report with invented numbers that are exact in binary: slow is recommended, fast fell once.
inline imagination::Report TwoAlternatives() {
  imagination::Report report;
  report.outcome = imagination::ImaginationOutcome::kRanked;
  report.complete = true;
  report.recommended = 0;
  report.why = "slow: it says so";
  report.caveats = {"the floor may be uneven"};
  report.seed = 42;
  report.wall_seconds = 2.0;
  report.simulated_seconds = 150.0;
  imagination::Prediction slow;
  slow.action = {"move_base_param", {"east", "slow"}};
  slow.evidence.confidence_pooled = 1.0;
  slow.evidence.confidence_mean = 0.96875;
  slow.evidence.success = {1.0, 0.5, 1.0, 4};
  slow.evidence.cost = {20.0, 16.0, 32.5};
  slow.evidence.counts = {1600, 0, 0};
  slow.evidence.duration = {20.0, 0.5, 20.0, 20.5};
  slow.evidence.durations = {19.5, 20.0, 20.0, 20.5};
  slow.evidence.max_tilt = {0.001, 0.0021};
  slow.evidence.max_tilts = {0.0005, 0.001, 0.002, 0.0021};
  slow.evidence.worst_rollout = 3;
  slow.evidence.median_rollout = 1;
  slow.evidence.num_rollouts = 4;
  imagination::Prediction fast;
  fast.action = {"move_base_param", {"east", "fast"}};
  fast.evidence.confidence_pooled = 0.5;
  fast.evidence.confidence_mean = 0.625;
  fast.evidence.success = {0.25, 0.125, 0.75, 4};
  fast.evidence.fall_share = 0.25;
  fast.evidence.counts = {1000, 100, 12};
  fast.evidence.falls = 1;
  fast.evidence.duration = {14.25, 1.5, 14.0, 16.0};
  fast.evidence.durations = {12.5, 16.0};
  fast.evidence.max_tilt = {0.25, 1.5};
  fast.evidence.max_tilts = {0.125, 0.25, 1.5};
  fast.evidence.first_causes = {{"braking", 1}};
  fast.evidence.worst_rollout = 2;
  fast.evidence.num_rollouts = 4;
  fast.evidence.failures = {{base::FailureCode::kNoPath, 2}, {base::FailureCode::kObjectFell, 1}};
  report.ranking = {slow, fast};
  return report;
}

}  // namespace hires::test_support
