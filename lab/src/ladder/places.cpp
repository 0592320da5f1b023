#include "lab/src/ladder/places.h"

#include <cmath>
#include <utility>

#include "hires/base/check.h"

namespace hires::lab::ladder {
namespace {

using imagination::ImaginationSetup;
using simulation::RobotSimulator;

constexpr char kCounter[] = "preManipulationAreaEastCounter1";
constexpr char kTable[] = "preManipulationAreaNorthTable1";
constexpr double kCommandPeriod = 0.1;  // [s]

/// Steps for `seconds`, the base being told its velocity now and then.
void StepFor(double seconds, const geometry::Twist2& velocity, RobotSimulator* simulator) {
  const long steps = std::lround(seconds / simulator->time_step());
  const long period = std::lround(kCommandPeriod / simulator->time_step());
  robot::Command command;
  command.base_velocity = velocity;
  for (long step = 0; step < steps; ++step) {
    if (step % period == 0) simulator->Send(command);
    simulator->Step();
  }
}

}  // namespace

Places::Places(std::string package_folder, std::uint64_t seed)
    : folder_(std::move(package_folder)),
      seed_(seed),
      config_(imagination::ReadSetupConfig(File("scene.yaml"))),
      drawn_(Told("drawn", false)) {}

ImaginationSetup Places::Told(const std::string& localisation, bool has_layer) const {
  imagination::SetupConfig config = config_;
  config.localisation = localisation;
  imagination::SetObstacleLayer(has_layer ? File("obstacle_layer.yaml") : "none", &config);
  return imagination::LoadImaginationSetup(config);
}

Player StepRobot(const Stepping& stepping, const physics::PhysicsParams& physics,
                 std::uint64_t seed) {
  constexpr double kSettling = 0.5;  // [s]
  const auto simulator = std::make_shared<RobotSimulator>(
      stepping.scene, simulation::Variation(), stepping.start.world, stepping.start.robot,
      base::Rng(seed), physics, stepping.level);
  StepFor(kSettling, {}, simulator.get());
  const std::shared_ptr<const RobotSimulator::Snapshot> settled = simulator->Save();
  Player player;
  player.play = [simulator, settled, stepping](int) {
    simulator->Restore(*settled);
    StepFor(stepping.round, stepping.velocity, simulator.get());
    return stepping.round;
  };
  player.state = [simulator] { return simulator->GetWorldState(); };
  return player;
}

Player PlayRollouts(const imagination::RolloutSetup& setup, const base::ActionCall& action) {
  imagination::CheckSetup(setup, action);
  const auto end = std::make_shared<world::WorldState>();
  Player player;
  player.play = [setup, action, end](int round) {
    const auto result = imagination::PlayRollout(setup, action, round);
    HIRES_CHECK(result.has_value(), "a rollout that nobody cancels ends");
    *end = result->final_world;
    return result->simulated;
  };
  player.state = [end] { return *end; };
  return player;
}

imagination::StartState DriveStart(const ImaginationSetup& setup) {
  return imagination::MakeStartState(setup, kCounter, {"peppermill1"});
}

imagination::RolloutSetup DriveSetup(const ImaginationSetup& setup, std::uint64_t seed) {
  return imagination::MakeRolloutSetup(setup, DriveStart(setup), seed);
}

base::ActionCall Drive(const std::string& motion_set) {
  return {"move_base_param", {kTable, motion_set}};
}

Way DriveWay(const ImaginationSetup& setup, std::uint64_t seed, std::string what) {
  const imagination::RolloutSetup rollouts = DriveSetup(setup, seed);
  return {std::move(what), {}, [rollouts] { return PlayRollouts(rollouts, Drive("fast")); }};
}

imagination::StartState LaidTable(const ImaginationSetup& setup) {
  constexpr double kCounterTop = 0.75, kTableTop = 0.73;  // [m], as the scenarios have it
  imagination::StartState start =
      imagination::MakeStartState(setup, kTable, std::vector<std::string>{});
  const auto put = [&](const char* name, const char* instance, double x, double y, double z) {
    start.world.objects.push_back(
        {name, setup.ModelOf(instance), geometry::Lift({x, y, 0.0}, z), {}, ""});
  };
  put("peppermill1", "peppermill1", 5.47, 10.16, kCounterTop);
  put("mug1", "mug1", 5.37, 10.36, kCounterTop);
  put("mug2", "mug2", 5.37, 9.94, kCounterTop);
  put("mug3", "mug1", 7.55, 11.24, kTableTop);
  put("mug4", "mug1", 7.55, 11.60, kTableTop);
  put("mug5", "mug1", 7.81, 11.24, kTableTop);
  return start;
}

}  // namespace hires::lab::ladder
