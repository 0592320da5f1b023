#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/text.h"
#include "hires/geometry/inertia.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/scene.h"
#include "hires/world/world.h"

/// Small worlds that tests build in code, so that they hold whatever the files in config/ say.
namespace hires::test_support {

inline geometry::Collision Shape(std::string name, geometry::Shape shape,
                                 const Eigen::Vector3d& p_BS, double friction = 0.8) {
  geometry::Collision collision;
  collision.name = std::move(name);
  collision.shape = std::move(shape);
  collision.X_BS.translation = p_BS;
  collision.friction = friction;
  return collision;
}

/// A body that never moves: a box with its middle at `p_M`.
inline world::StaticBody Block(const std::string& name, const Eigen::Vector3d& size,
                               const Eigen::Vector3d& p_M) {
  world::StaticBody body;
  body.name = name;
  body.X_MB.translation = p_M;
  body.collisions.push_back(Shape(name, geometry::Box{size}, Eigen::Vector3d::Zero(), 1.0));
  return body;
}

/// An upright pepper mill, its origin in the middle of its foot. The defaults are the text's of the
/// dissertation (section 5.2): it tips at 2.65 m/s^2.
inline world::ObjectModel Mill(const std::string& name = "mill", double height = 0.274,
                               double radius = 0.037, double mass = 0.14, double friction = 0.8) {
  const geometry::Cylinder cylinder{radius, height};
  const Eigen::Vector3d centre(0.0, 0.0, height / 2);
  world::ObjectModel model;
  model.name = name;
  model.mass_properties = {mass, centre, geometry::SolidInertia(cylinder, mass)};
  model.collisions.push_back(Shape("body", cylinder, centre, friction));
  return model;
}

inline void AddModel(world::World* world, world::ObjectModel model) {
  const std::string name = model.name;
  world->models[name] = std::make_shared<const world::ObjectModel>(std::move(model));
}

inline void AddArea(world::World* world, const std::string& name, const geometry::Pose3& X_MF) {
  world->frames[base::ToLower(name)] = X_MF;
  world->frame_names[base::ToLower(name)] = name;
}

/// A room with walls round x 0..6, y 0..4 [m], the areas West (1, 2), East (4.5, 2), Corner
/// (4.5, 3) and the models mill and tower (twice as high).
inline world::World Room() {
  world::World room;
  room.name = "room";
  room.statics = {Block("west_wall", {0.1, 4.2, 1.0}, {-0.05, 2.0, 0.5}),
                  Block("east_wall", {0.1, 4.2, 1.0}, {6.05, 2.0, 0.5}),
                  Block("south_wall", {6.0, 0.1, 1.0}, {3.0, -0.05, 0.5}),
                  Block("north_wall", {6.0, 0.1, 1.0}, {3.0, 4.05, 0.5})};
  AddArea(&room, "West", geometry::Lift({1.0, 2.0, 0.0}));
  AddArea(&room, "East", geometry::Lift({4.5, 2.0, 0.0}));
  AddArea(&room, "Corner", geometry::Lift({4.5, 3.0, 0.0}));
  AddModel(&room, Mill());
  AddModel(&room, Mill("tower", 0.548));
  room.hash = room.ComputeHash();
  return room;
}

constexpr double kTrayTop = 0.35;  ///< [m] height of the tray's upper face
constexpr double kTrayX = 0.2;     ///< [m] its middle before the base's

/// A box on wheels, 0.60 x 0.50 m and up to 0.30 m high, with a tray plate in front and a torso up
/// to 1.20 m behind. Its base follows commands without lag, sway or a loop of its own.
inline robot::Robot TrayRobot() {
  robot::Link base, tray;
  base.name = "base";
  base.collisions = {Shape("base", geometry::Box{{0.6, 0.5, 0.26}}, {0.0, 0.0, 0.17}),
                     Shape("torso", geometry::Box{{0.2, 0.3, 0.9}}, {-0.15, 0.0, 0.75})};
  tray.name = "tray";
  tray.joint = robot::Joint();
  tray.joint->name = "tray_joint";
  tray.joint->parent = 0;
  tray.joint->X_PJ.translation = {kTrayX, 0.0, kTrayTop};
  tray.collisions = {Shape("plate", geometry::Box{{0.25, 0.5, 0.02}}, {0.0, 0.0, -0.01})};
  robot::Robot robot;
  robot.model.name = "tray_robot";
  robot.model.links = {base, tray};
  robot.profile.base_link = "base";
  robot.profile.tray_link = "tray";
  robot.profile.footprint = {{-0.3, -0.25}, {0.325, -0.25}, {0.325, 0.25}, {-0.3, 0.25}};
  robot.profile.base_controller.limits = {1.0, 2.0, 2.0, 2.0};
  return robot;
}

inline std::shared_ptr<const simulation::Scene> RoomScene() {
  return simulation::MakeScene(Room(), TrayRobot());
}

/// An object that stands on the tray of a robot at X_MB, `p_TO` from the tray's middle.
inline world::ObjectState OnTray(const std::string& name, const std::string& model,
                                 const geometry::Pose2& X_MB,
                                 const Eigen::Vector2d& p_TO = Eigen::Vector2d::Zero()) {
  world::ObjectState object;
  object.name = name;
  object.model = model;
  object.X_MO =
      geometry::Lift(X_MB) * geometry::Lift({kTrayX + p_TO.x(), p_TO.y(), 0.0}, kTrayTop + 0.0002);
  return object;
}

inline robot::RobotState StandingAt(const geometry::Pose2& X_MB) {
  robot::RobotState state;
  state.X_MB = X_MB;
  return state;
}

}  // namespace hires::test_support
