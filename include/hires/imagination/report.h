#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/action.h"
#include "hires/imagination/cost_reasons.h"
#include "hires/imagination/scheduler.h"

namespace hires::imagination {

/// What imagination found about one parametrisation.
struct Prediction {
  base::ActionCall action;
  int alternative{-1};  ///< its place among the request's combinations
  Evidence evidence;
  world::WorldState
      final_world;  ///< of the rollout with the median duration; empty if none finished
  robot::RobotState final_robot;
};

/// The answer to one request.
struct Report {
  ImaginationOutcome outcome{ImaginationOutcome::kNothingFinished};
  ImaginationOutcome found{ImaginationOutcome::kCancelled};  ///< as SchedulerResult::found
  bool complete{false};             ///< settled or all played; false: cut short by deadline or loss
  std::vector<Prediction> ranking;  ///< best first
  int recommended{-1};              ///< index into `ranking`, or -1
  std::string why;                  ///< one sentence for people
  /// The same for machines, where cost recommends; its alternatives are places of `ranking`.
  std::optional<CostReasons> by_cost;
  std::vector<std::string> caveats;  ///< outside of what was validated; workers that disagreed
  std::uint64_t seed{0};
  double wall_seconds{0.0};
  double simulated_seconds{0.0};  ///< of the rollouts behind the ranking
  /// Rollouts behind the ranking that were those of an earlier request, and were not played again.
  struct {
    int rollouts{0};
    double simulated_seconds{0.0};
  } kept;

  double played_seconds() const { return simulated_seconds - kept.simulated_seconds; }
};

/// What is known while the work goes on.
struct Interim {
  Progress progress;
  std::vector<Prediction> ranking;  ///< best first, without final states
  int num_workers{0};
};
using OnInterim = std::function<void(const Interim&)>;

/// The predictions of a ranking in its order. Final states are filled in where `with_final_states`.
std::vector<Prediction> PredictionsOf(const Scheduler& scheduler, const Ranking& ranking,
                                      const std::vector<base::ActionCall>& actions,
                                      bool with_final_states);

/// @param kept  alternative and index of rollouts that were those of an earlier request.
/// @param is_one_truth  nothing was uncertain: see CostReasons.
/// @pre scheduler.finished(); `actions` are its alternatives.
Report MakeReport(const Scheduler& scheduler, const std::vector<base::ActionCall>& actions,
                  std::uint64_t seed, double wall_seconds,
                  const std::set<std::pair<int, int>>& kept = {}, bool is_one_truth = false);

}  // namespace hires::imagination
