#include <fmt/format.h>

#include <set>

#include "lab/src/experiment/kinds.h"
#include "hires/base/error.h"
#include "base/parallel.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

using Planner = DurationsConfig::Planner;
/// The same stage with the local planner that is meant.
Stage StageWith(const Stage& stage, Planner planner) {
  Stage changed = stage;
  if (planner == Planner::kScene) return changed;
  skills::DrivingContext driving = *stage.setup.skills->driving;
  driving.params.local.max_scaling_factor = 0.0;
  skills::SkillSet skills = *stage.setup.skills;
  skills.driving = std::make_shared<const skills::DrivingContext>(std::move(driving));
  changed.setup.skills = std::make_shared<const skills::SkillSet>(std::move(skills));
  return changed;
}

template <typename Postures>
const typename Postures::mapped_type& PostureOf(const Postures& postures, const std::string& name) {
  const auto found = postures.find(base::ToLower(name));
  if (found != postures.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [posture, value] : postures) known.push_back(posture);
  throw base::ConfigError("durations.actions: " + base::UnknownName("posture", name, known));
}

/// Torso, or both arms, as a row begins.
void TakePosture(const DurationsConfig::Row& row, const robot::UpperBodyProfile& body,
                 robot::RobotState* state) {
  if (row.action == "move_torso") {
    state->joints[body.torso_joint] = PostureOf(body.torso_postures, row.from);
    return;
  }
  for (const auto& [name, arm] : body.arms) {
    const std::vector<double>& posture = PostureOf(arm.postures, row.from).front();
    for (std::size_t j = 0; j < arm.joints.size(); ++j) state->joints[arm.joints[j]] = posture[j];
  }
}

imagination::RolloutSetup SetupOf(const DurationsConfig& durations, const DurationsConfig::Row& row,
                                  const Stage& stage, std::uint64_t seed) {
  imagination::RolloutSetup setup = SetupAt(stage, StartOf(durations, row), seed);
  if (row.IsDrive()) return setup;
  const auto& body = stage.setup.scene->robot.profile.upper_body;
  if (!body) throw base::ConfigError("durations: the robot has nothing above its base that moves");
  TakePosture(row, *body, &setup.robot_state);
  return setup;
}

/// One row with one planner.
struct Cell {
  std::size_t planner{0}, row{0};
  imagination::RolloutSetup setup;
};

std::vector<Cell> CellsOf(const DurationsConfig& durations, const Stage& stage,
                          std::uint64_t seed) {
  std::vector<Cell> cells;
  for (std::size_t p = 0; p < durations.planners.size(); ++p) {
    const Stage with_planner = StageWith(stage, durations.planners[p]);
    for (std::size_t r = 0; r < durations.rows.size(); ++r) {
      if (p > 0 && !durations.rows[r].IsDrive()) continue;
      cells.push_back({p, r, SetupOf(durations, durations.rows[r], with_planner, seed)});
      imagination::CheckSetup(cells.back().setup, ActionOf(durations.rows[r]));
    }
  }
  return cells;
}

}  // namespace

DurationPlays NothingPlayed(const DurationsConfig& durations) {
  return DurationPlays(durations.planners.size(), std::vector<Rollouts>(durations.rows.size()));
}

base::ActionCall ActionOf(const DurationsConfig::Row& row) {
  if (row.IsDrive()) return DriveTo(row.to, row.motion_set);
  if (row.action == "move_torso") return {row.action, {row.to}};
  return {row.action, {row.to, row.to}};
}

std::string StartOf(const DurationsConfig& durations, const DurationsConfig::Row& row) {
  return row.IsDrive() ? row.from : durations.postures_at;
}

std::optional<DurationPlays> PlayDurations(const DurationsConfig& durations,
                                           const ExperimentConfig& config, const Stage& stage,
                                           const base::Crew& crew) {
  const std::vector<Cell> cells = CellsOf(durations, stage, config.seed);
  const int num_cells = static_cast<int>(cells.size());
  DurationPlays plays = NothingPlayed(durations);
  for (const Cell& cell : cells) plays[cell.planner][cell.row].resize(durations.runs);
  const auto play = [&](int task, const base::Advance& advance) {
    const Cell& cell = cells[task % num_cells];
    const int run = task / num_cells;
    auto result = imagination::PlayRollout(cell.setup, ActionOf(durations.rows[cell.row]), run,
                                           {crew.cancelled, {}});
    if (result) plays[cell.planner][cell.row][run] = *std::move(result);
    advance(1.0);
  };
  const int num_tasks = num_cells * durations.runs;
  if (!base::DoInParallel(num_tasks, num_tasks, crew, play)) return std::nullopt;
  return plays;
}

}  // namespace hires::lab
