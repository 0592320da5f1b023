// Plays skills one after the other as a rollout does, in this process and without topics, and
// prints for each the robot's true path: one line "seconds x y yaw joint=position ..." for every
// 0.05 s, then where each loose object is, "object name x y z", and at last "end reason".
//
//   skill_trace SCENE AREA|SCENARIO.yaml ACTION [ARGUMENT ...] [, ACTION ...]

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "nodes/sim_worker/sim_robot_params.h"
#include "sim_robot/sim_robot_world.h"

namespace {

using hires::simulation::RobotSimulator;

constexpr double kSettling = 0.55;  // [s] with the tick at which the simulated robot is held
constexpr double kSample = 0.05;    // [s]
constexpr double kLimit = 300.0;    // [s]

void Print(double time, const RobotSimulator& simulator) {
  const hires::robot::RobotState state = simulator.GetRobotState();
  std::string line = fmt::format("{:.3f} {:.17g} {:.17g} {:.17g}", time, state.X_MB.x, state.X_MB.y,
                                 state.X_MB.yaw);
  for (const auto& [name, position] : state.joints) {
    line += fmt::format(" {}={:.17g}", name, position);
  }
  std::cout << line << "\n";
}

void PrintObjects(const RobotSimulator& simulator) {
  for (const hires::world::ObjectState& object : simulator.GetWorldState().objects) {
    const auto& p_MO = object.X_MO.translation;
    std::cout << fmt::format("object {} {:.17g} {:.17g} {:.17g}\n", object.name, p_MO.x(), p_MO.y(),
                             p_MO.z());
  }
}

void StepFor(double duration, RobotSimulator* simulator) {
  const long steps = std::lround(duration / simulator->time_step());
  for (long i = 0; i < steps; ++i) simulator->Step();
}

hires::skills::Status Play(hires::skills::Skill* skill, RobotSimulator* simulator) {
  const double start = simulator->time();
  hires::skills::Status status;
  double next = start;
  while (simulator->time() - start < kLimit) {
    Print(simulator->time() - start, *simulator);
    if (simulator->time() >= next - 1e-6) {
      hires::robot::Command command;
      status = skill->Update(simulator->Observe(start), &command);
      simulator->Send(command);
      next += skill->period();
    }
    if (status.progress != hires::skills::Progress::kRunning) return status;
    StepFor(kSample, simulator);
  }
  return hires::skills::Failed(hires::base::FailureCode::kTimedOut);
}

void Remember(const hires::world::WorldState& world, RobotSimulator* simulator) {
  std::vector<hires::robot::SeenObject> told;
  for (const hires::world::ObjectState& object : world.objects) {
    told.push_back({hires::base::ToLower(object.name), object.model, object.X_MO, 0.0, ""});
  }
  simulator->Remember(told);
}

/// The words between commas.
std::vector<hires::base::ActionCall> ActionsFrom(const std::vector<std::string>& words) {
  std::vector<hires::base::ActionCall> actions(1);
  for (const std::string& word : words) {
    if (word == ",") {
      actions.emplace_back();
    } else if (actions.back().name.empty()) {
      actions.back().name = word;
    } else {
      actions.back().arguments.push_back(word);
    }
  }
  return actions;
}

void PlayAll(const hires::imagination::ImaginationSetup& setup,
             const std::vector<hires::base::ActionCall>& actions, RobotSimulator* simulator) {
  StepFor(kSettling, simulator);
  for (const hires::base::ActionCall& action : actions) {
    const auto skill = hires::skills::MakeSkill(*setup.skills, action);
    const hires::skills::Status status = Play(skill.get(), simulator);
    PrintObjects(*simulator);
    const bool is_done = status.progress == hires::skills::Progress::kSucceeded;
    std::cout << "end " << (is_done ? "succeeded" : ToString(status.failure)) << std::endl;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr
        << "usage: skill_trace SCENE AREA|SCENARIO.yaml ACTION [ARGUMENT ...] [, ACTION ...]\n";
    return EXIT_FAILURE;
  }
  try {
    hires_ros::SimRobotParams params;
    params.setup = hires::imagination::ReadSetupConfig(argv[1]);
    params.setup.uncertainty = "none";
    const std::string where = argv[2];
    const bool is_scenario = where.find(".yaml") != std::string::npos;
    (is_scenario ? params.scenario : params.area) = where;
    const auto setup = hires::imagination::LoadImaginationSetup(params.setup);
    const auto start = hires::sim_robot::StartOf(setup, params.scenario, params.area);
    RobotSimulator simulator(setup.scene, {}, start.world, start.robot, hires::base::Rng(1),
                             setup.physics, hires::sim_robot::LevelFor(*setup.scene));
    if (simulator.level() == hires::simulation::LevelOfDetail::kPlanar) {
      Remember(start.world, &simulator);
    }
    PlayAll(setup, ActionsFrom({argv + 3, argv + argc}), &simulator);
  } catch (const hires::base::ConfigError& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
