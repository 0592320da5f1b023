#pragma once

#include <memory>
#include <string>

#include "hires/imagination/imagination_setup.h"
#include "hires/simulation/robot_simulator.h"
#include "lab/src/ladder/measure.h"

namespace hires::lab::ladder {

/// The restaurant as rollouts have it, loaded once and shared by all rungs.
class Places {
 public:
  /// @throws base::ConfigError naming file and key.
  Places(std::string package_folder, std::uint64_t seed);

  const imagination::ImaginationSetup& drawn() const { return drawn_; }
  const world::World& world() const { return drawn_.scene->world; }
  std::uint64_t seed() const { return seed_; }
  std::string File(const std::string& name) const { return folder_ + "/config/" + name; }
  std::string Scenario(const std::string& name) const {
    return File("scenarios/" + name + ".yaml");
  }

  /// The same with another `localisation`, and with or without obstacle layer.
  imagination::ImaginationSetup Told(const std::string& localisation, bool has_layer) const;

 private:
  std::string folder_;
  std::uint64_t seed_;
  imagination::SetupConfig config_;
  imagination::ImaginationSetup drawn_;
};

/// One way to step a robot simulator, [s] simulated for each round.
struct Stepping {
  std::shared_ptr<const simulation::Scene> scene;
  imagination::StartState start;
  simulation::LevelOfDetail level{simulation::LevelOfDetail::kPlanar};
  double round{0.2};            ///< [s]
  geometry::Twist2 velocity{};  ///< sent ten times a second
};

/// Settles half a second, which counts nowhere; each round begins there again.
Player StepRobot(const Stepping& stepping, const physics::PhysicsParams& physics,
                 std::uint64_t seed);

/// Round i plays rollout i of the action.  @throws base::ConfigError for what cannot be played.
Player PlayRollouts(const imagination::RolloutSetup& setup, const base::ActionCall& action);

/// The drive with the pepper mill of Tables 6.1 and 6.5, and where it begins.
imagination::StartState DriveStart(const imagination::ImaginationSetup& setup);
imagination::RolloutSetup DriveSetup(const imagination::ImaginationSetup& setup,
                                     std::uint64_t seed);
base::ActionCall Drive(const std::string& motion_set);
Way DriveWay(const imagination::ImaginationSetup& setup, std::uint64_t seed, std::string what);

/// The robot of the dissertation's "idle world": mugs and the pepper mill on counter and tables.
imagination::StartState LaidTable(const imagination::ImaginationSetup& setup);

}  // namespace hires::lab::ladder
