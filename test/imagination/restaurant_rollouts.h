#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"

namespace hires::imagination::test_support {

/// The restaurant with the PR2 as the package comes with them, loaded once for a test program.
inline const ImaginationSetup& Restaurant() {
  static const ImaginationSetup setup =
      LoadImaginationSetup(ReadSetupConfig(std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml"));
  return setup;
}

/// The robot at an area, torso up, both arms beside its body.
inline std::vector<base::Atom> ReadyAt(const std::string& area) {
  return {{"RobotAt", {area}},
          {"HasTorsoPosture", {"TorsoUpPosture"}},
          {"HasArmPosture", {"leftArm1", "ArmToSidePosture"}},
          {"HasArmPosture", {"rightArm1", "ArmToSidePosture"}}};
}

/// South of table 1 with the mug in the right hand; `put` stands about.
inline StartState MugBeforeTable(const std::vector<PutObject>& put = {}) {
  std::vector<base::Atom> atoms = ReadyAt("manipulationAreaSouthTable1");
  atoms.push_back({"Holding", {"rightArm1", "mug1"}});
  return MakeStartState(Restaurant(), atoms, put);
}

/// What stands on the placing area in config/scenarios/serve_coffee.yaml.
inline std::vector<PutObject> Occupants() {
  const auto at = [](const std::string& name, double x, double y) {
    return PutObject{name, "", geometry::Lift({x, y, 0.0}, 0.73)};
  };
  return {at("bowl1", 7.539, 11.241), at("book1", 7.481, 11.384), at("book2", 7.613, 11.405)};
}

inline RolloutSetup Rollouts(const StartState& start, const std::string& uncertainty = "none") {
  RolloutSetup setup = MakeRolloutSetup(Restaurant(), start, 7);
  if (uncertainty != "config") {
    setup.uncertainty =
        std::make_shared<const Uncertainty>(UncertaintyFromText(uncertainty, "test"));
  }
  return setup;
}

}  // namespace hires::imagination::test_support
