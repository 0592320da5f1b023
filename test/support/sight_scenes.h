#pragma once

#include <memory>
#include <string>
#include <utility>

#include "hires/perception/camera_view.h"
#include "hires/perception/surroundings.h"
#include "hires/world/world.h"
#include "support/scenes.h"

/// Small worlds to look around in.
namespace hires::test_support {

inline geometry::Pose3 At(double x, double y, double z) {
  geometry::Pose3 pose;
  pose.translation = {x, y, z};
  return pose;
}

inline world::ObjectState Thing(const std::string& name, const std::string& model,
                                const geometry::Pose3& X_MO) {
  world::ObjectState object;
  object.name = name;
  object.model = model;
  object.X_MO = X_MO;
  return object;
}

inline world::World OneBody(geometry::Shape shape, const geometry::Pose3& X_MS) {
  world::World world;
  world::StaticBody body;
  body.name = "body";
  body.X_MB = X_MS;
  body.collisions.push_back(Shape("body", std::move(shape), Eigen::Vector3d::Zero()));
  world.statics.push_back(body);
  return world;
}

inline perception::CameraView LookingFrom(const Eigen::Vector3d& p_M, double yaw = 0.0,
                                          double pitch_down = 0.0) {
  perception::CameraView view;
  view.X_MC.translation = p_M;
  view.X_MC.rotation = geometry::RotationFromRpy(0.0, pitch_down, yaw);
  return view;
}

/// A wall at x 3 m; the models mug (radius 0.04, height 0.1), jug (a cylinder of radius 0.06 with a
/// handle that begins within it) and screen (a plate 1 m wide across x, 0.6 m high).
inline world::World SightWorld() {
  world::World world;
  world.statics = {Block("wall", {0.1, 4.0, 2.5}, {3.0, 0.0, 1.25})};
  AddModel(&world, Mill("mug", 0.1, 0.04));
  world::ObjectModel jug = Mill("jug", 0.2, 0.06);
  jug.collisions.push_back(Shape("handle", geometry::Box{{0.08, 0.02, 0.1}}, {0.08, 0.0, 0.1}));
  AddModel(&world, jug);
  world::ObjectModel screen = Mill("screen");
  screen.collisions = {Shape("plate", geometry::Box{{0.01, 1.0, 0.6}}, {0.0, 0.0, 0.3})};
  AddModel(&world, screen);
  world.hash = world.ComputeHash();
  return world;
}

/// Nothing but its models.
inline std::shared_ptr<const perception::Surroundings> EmptyRoom() {
  world::World world = SightWorld();
  world.statics.clear();
  return std::make_shared<const perception::Surroundings>(world);
}

}  // namespace hires::test_support
