#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/ontology.h"
#include "knowledge/support/store_world.h"

namespace hires::test_support {

/// The ontology of the repository.
inline std::shared_ptr<const knowledge::Ontology> RestaurantOntology() {
  const std::string folder = HIRES_SOURCE_DIR "/config/ontology/";
  static const auto ontology = std::make_shared<const knowledge::Ontology>(
      knowledge::Ontology::FromFiles({folder + "upper.ttl", folder + "race.ttl"}));
  return ontology;
}

inline knowledge::Fluent PoseOfHeight(const std::string& instance, double z) {
  return MakeFluent(
      "Pose", instance,
      {{"hasX", "xsd:float", 1.5}, {"hasY", "xsd:float", 2.0}, {"hasZ", "xsd:float", z}});
}

inline knowledge::Fluent BoxAt(const std::string& instance, const std::string& pose) {
  return MakeFluent("BoundingBox", instance, {{"hasPose", "Pose", pose}});
}

inline knowledge::Fluent WithBox(const std::string& concept_name, const std::string& instance,
                                 const std::string& box) {
  return MakeFluent(concept_name, instance, {{"hasBoundingBox", "BoundingBox", box}});
}

/// Two areas on the floor, one on a table, one without a box; a table and what is on it; a robot
/// that does something.
inline std::vector<knowledge::Fluent> SmallRestaurant() {
  return {
      WithBox("FloorArea", "floorArea1", "boxFloorArea1"),
      BoxAt("boxFloorArea1", "poseFloor1"),
      PoseOfHeight("poseFloor1", 0.0),
      WithBox("ManipulationArea", "manipulationArea1", "boxManipulationArea1"),
      BoxAt("boxManipulationArea1", "poseFloor2"),
      PoseOfHeight("poseFloor2", -0.0),
      WithBox("PlacingArea", "placingArea1", "boxPlacingArea1"),
      BoxAt("boxPlacingArea1", "poseTop"),
      PoseOfHeight("poseTop", 0.75),
      MakeFluent("SittingArea", "sittingArea1"),
      WithBox("Table", "table1", "boxTable1"),
      BoxAt("boxTable1", "poseFloor1"),
      WithBox("Mug", "mug1", "boxMug1"),
      WithBox("Book", "book1", "boxBook1"),
      MakeFluent("Mug", "mug2"),
      MakeFluent("On", "onMug1",
                 {{"hasPhysicalEntity", "PassiveObject", std::string("mug1")},
                  {"hasArea", "PlacingArea", std::string("placingArea1")}}),
      MakeFluent("RobotAt", "robotAt1", {{"hasArea", "Area", std::string("floorArea1")}}),
      MakeFluent("ArmTuckedPosture", "postureLeftArm1",
                 {{"hasArm", "Arm", std::string("leftArm1")}}),
      MakeFluent("TorsoUpPosture", "postureTorso1"),
      MakeFluent("Arm", "leftArm1",
                 {{"hasArmPosture", "ArmPosture", std::string("postureLeftArm1")}}),
      MakeFluent("MoveBaseActivity", "moveBase1",
                 {{"hasResult", "xsd:string", std::string("succeeded")}}),
      MakeFluent("MoveTorsoActivity", "moveTorso1"),
  };
}

}  // namespace hires::test_support
