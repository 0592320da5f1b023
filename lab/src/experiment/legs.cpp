#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "hires/base/text.h"
#include "lab/src/experiment/kinds.h"
#include "lab/src/statistics.h"

namespace hires::lab {
namespace {

enum LegStreams : std::uint64_t { kOrderStream, kChainStream };

std::string MotionSetOf(const ExperimentConfig& config) {
  return std::get<LegsConfig>(config.kind).motion_set;
}

int LegsOfChain(const LegsConfig& legs, int chain) {
  return legs.legs / legs.chains + (chain < legs.legs % legs.chains ? 1 : 0);
}

bool IsReached(const Leg& leg) { return leg.result.action_finished; }

/// What legs have in common: all of them, or those to one goal.
class LegTally {
 public:
  LegTally(double xy_tolerance, double yaw_tolerance)
      : xy_tolerance_(xy_tolerance), yaw_tolerance_(yaw_tolerance) {}

  void Add(const Leg& leg) {
    ++legs;
    contacts += !leg.touched.empty();
    clearance = std::min(clearance, leg.clearance);
    if (!IsReached(leg)) {
      ++failures[leg.result.failure];
      return;
    }
    ++reached;
    durations.push_back(leg.result.duration);
    max_distance = std::max(max_distance, leg.distance);
    max_yaw_error = std::max(max_yaw_error, leg.yaw_error);
    beyond += leg.distance > xy_tolerance_ || leg.yaw_error > yaw_tolerance_;
  }

  std::vector<std::string> Row(const std::string& goal) const {
    std::string reasons;
    for (const auto& [failure, count] : failures) {
      reasons += fmt::format("{} {} ", base::ToString(failure), count);
    }
    return {goal,
            fmt::format("{}", legs),
            fmt::format("{}", reached),
            fmt::format("{}", contacts),
            fmt::format("{:.3f} m", max_distance),
            fmt::format("{:.3f} rad", max_yaw_error),
            fmt::format("{}", beyond),
            fmt::format("{:.3f} m", clearance),
            fmt::format("{:.1f} ± {:.1f} s", base::Mean(durations), Deviation(durations)),
            reasons};
  }

  int legs{0}, reached{0}, contacts{0}, beyond{0};
  double max_distance{0.0}, max_yaw_error{0.0}, clearance{kFarClearance};
  std::vector<double> durations;
  std::map<base::Failure, int> failures;

 private:
  double xy_tolerance_, yaw_tolerance_;
};

nlohmann::ordered_json RowOf(int chain, int number, const Leg& leg) {
  return {{"chain", chain},
          {"leg", number},
          {"from", leg.from},
          {"to", leg.to},
          {"start_x", leg.X_MStart.x},
          {"start_y", leg.X_MStart.y},
          {"start_yaw", leg.X_MStart.yaw},
          {"reached", IsReached(leg)},
          {"failure", base::ToString(leg.result.failure.code)},
          {"subjects", base::Join(leg.result.failure.subjects, " ")},
          {"touched", leg.touched},
          {"distance", leg.distance},
          {"yaw_error", leg.yaw_error},
          {"clearance", leg.clearance},
          {"duration", leg.result.duration},
          {"restarted", leg.was_restarted}};
}

std::vector<std::string> ProblemRow(int chain, int number, const Leg& leg) {
  return {fmt::format("{}", chain),
          fmt::format("{}", number),
          leg.from,
          leg.to,
          base::ToString(leg.result.failure),
          leg.touched,
          fmt::format("{:.1f} s", leg.result.duration),
          fmt::format("({:.3f}, {:.3f}, {:.3f})", leg.X_MStart.x, leg.X_MStart.y, leg.X_MStart.yaw),
          fmt::format("({:.3f}, {:.3f}, {:.3f})", leg.result.final_robot.X_MB.x,
                      leg.result.final_robot.X_MB.y, leg.result.final_robot.X_MB.yaw)};
}

std::vector<Measure> MeasuresOf(const LegTally& all, const std::map<std::string, LegTally>& goals) {
  int min_visits = all.legs;
  for (const auto& entry : goals) min_visits = std::min(min_visits, entry.second.legs);
  const double n = all.legs;
  return {{"legs", n},
          {"reached", static_cast<double>(all.reached)},
          {"reached_share", all.reached / n},
          {"contacts", static_cast<double>(all.contacts)},
          {"beyond_tolerance", static_cast<double>(all.beyond)},
          {"max_distance", all.max_distance},
          {"max_yaw_error", all.max_yaw_error},
          {"min_clearance", all.clearance},
          {"mean_duration", base::Mean(all.durations)},
          {"min_visits", static_cast<double>(min_visits)}};
}

}  // namespace

std::vector<std::string> ShuffledGoals(const std::vector<Goal>& goals, int num_legs,
                                       base::Rng rng) {
  std::vector<std::string> names, order;
  for (const Goal& goal : goals) names.push_back(goal.name);
  std::string last = names.front();
  while (static_cast<int>(order.size()) < num_legs) {
    for (int i = static_cast<int>(names.size()) - 1; i > 0; --i) {
      std::swap(names[i], names[rng.Index(i + 1)]);
    }
    if (names.front() == last) {
      std::swap(names.front(), names[1 + rng.Index(static_cast<int>(names.size()) - 1)]);
    }
    order.insert(order.end(), names.begin(), names.end());
    last = order.back();
  }
  order.resize(num_legs);
  return order;
}

std::optional<Chains> PlayLegs(const LegsConfig& legs, const ExperimentConfig& config,
                               const std::shared_ptr<const Stage>& stage, const base::Crew& crew) {
  Chains chains(legs.chains);
  const auto play = [&](int number, const base::Advance& advance) {
    const base::Rng rng = base::Rng(config.seed).Fork(number);
    Chain chain(stage, config.goals.front().name,
                {legs.motion_set, rng.Fork(kChainStream).seed(), false, false});
    for (const std::string& goal :
         ShuffledGoals(config.goals, LegsOfChain(legs, number), rng.Fork(kOrderStream))) {
      auto leg = chain.Drive(goal, crew.cancelled);
      if (!leg) return;
      chains[number].push_back(*std::move(leg));
      advance(1.0);
    }
  };
  if (!base::DoInParallel(legs.chains, legs.legs, crew, play)) return std::nullopt;
  return chains;
}

Findings SumUpLegs(const ExperimentConfig& config, const Stage& stage, const Chains& chains) {
  Findings findings;
  const LegTally empty(stage.xy_tolerance, stage.yaw_tolerance);
  LegTally all = empty;
  PlaceTrail places;
  LostTally lost;
  std::map<std::string, LegTally> by_goal;
  for (const Goal& goal : config.goals) by_goal.emplace(goal.name, empty);
  TextTable problems{
      "Legs that failed or touched something",
      {{"chain", "leg", "from", "to", "failure", "touched", "after", "start", "end"}}};
  for (std::size_t c = 0; c < chains.size(); ++c) {
    for (std::size_t i = 0; i < chains[c].size(); ++i) {
      const Leg& leg = chains[c][i];
      const int chain = static_cast<int>(c), number = static_cast<int>(i);
      all.Add(leg);
      places.insert(places.end(), leg.places.begin(), leg.places.end());
      lost.Add(leg.places);
      by_goal.at(leg.to).Add(leg);
      findings.simulated_seconds += leg.result.simulated;
      findings.rows.push_back(RowOf(chain, number, leg));
      if (!IsReached(leg) || !leg.touched.empty()) {
        problems.rows.push_back(ProblemRow(chain, number, leg));
      }
    }
  }
  TextTable table{"Legs by goal, motion set " + MotionSetOf(config),
                  {{"to", "legs", "reached", "contacts", "distance max", "yaw max", "beyond",
                    "clearance min", "duration", "failures"}}};
  for (const Goal& goal : config.goals) {
    table.rows.push_back(by_goal.at(goal.name).Row(goal.name));
  }
  table.rows.push_back(all.Row("all"));
  findings.measures = MeasuresOf(all, by_goal);
  findings.tables = {std::move(table), std::move(problems)};
  if (config.self_localisation != "none") {
    for (const auto& measures : {PlaceMeasures(places), lost.Measures()})
      findings.measures.insert(findings.measures.end(), measures.begin(), measures.end());
    findings.tables.push_back(PlaceTable(places));
    findings.tables.push_back(lost.Table());
  }
  return findings;
}

}  // namespace hires::lab
