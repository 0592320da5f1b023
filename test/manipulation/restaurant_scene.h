#pragma once

#include <memory>
#include <string>

#include "hires/manipulation/arm_path.h"
#include "hires/robot/gripper.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/object_catalogue.h"
#include "hires/world/world.h"

namespace hires::manipulation::test_support {

inline const std::string kSource = HIRES_SOURCE_DIR;

inline std::shared_ptr<const robot::Robot> Pr2() {
  static const auto robot =
      std::make_shared<const robot::Robot>(robot::LoadRobot(kSource + "/config/robots/pr2.yaml"));
  return robot;
}

/// The restaurant with all kinds of objects of the catalogue.
inline std::shared_ptr<const world::World> Restaurant() {
  static const auto world = [] {
    world::World loaded = world::LoadWorld(kSource + "/worlds/restaurant.world");
    for (const auto& [name, model] : world::LoadCatalogueModels(kSource + "/worlds/objects.yaml")) {
      loaded.models[model->name] = model;
    }
    return std::make_shared<const world::World>(std::move(loaded));
  }();
  return world;
}

inline std::shared_ptr<const world::ObjectModel> Model(const std::string& folder) {
  static const auto models = world::LoadCatalogueModels(kSource + "/worlds/objects.yaml");
  for (const auto& [name, model] : models) {
    if (model->name == folder) return model;
  }
  throw std::runtime_error("no model " + folder);
}

/// The scene of the restaurant, built once.
inline CollisionScene RestaurantScene() {
  static const CollisionScene scene(Restaurant(), Pr2(), CollisionParams{});
  return scene.Clone();
}

inline void SetArm(const std::string& arm, const std::vector<double>& values,
                   robot::JointPositions* posture) {
  const auto& joints = Pr2()->profile.upper_body->arms.at(arm).joints;
  for (std::size_t i = 0; i < joints.size(); ++i) (*posture)[joints[i]] = values[i];
}

/// Both arms in the first variant of a named posture, torso at a height, grippers at a gap.
inline robot::JointPositions Posture(const std::string& name, double torso, double gap = 0.09) {
  robot::JointPositions posture = Pr2()->profile.joints;
  posture["torso_lift_joint"] = torso;
  for (const auto& [arm, profile] : Pr2()->profile.upper_body->arms) {
    SetArm(arm, profile.postures.at(name).front(), &posture);
    robot::SetGap(Pr2()->profile.upper_body->gripper, profile, gap, &posture);
  }
  return posture;
}

inline geometry::Pose2 Area(const std::string& name) {
  return geometry::Flatten(Restaurant()->FindFrame(name).value());
}

inline world::ObjectState Standing(const std::string& name, const std::string& model, double x,
                                   double y, double z) {
  world::ObjectState state;
  state.name = name;
  state.model = model;
  state.X_MO.translation = {x, y, z};
  return state;
}

}  // namespace hires::manipulation::test_support
