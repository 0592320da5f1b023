#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/physics/physics_world.h"
#include "support/box_mesh.h"

namespace hires::test_support {

inline geometry::Collision MakeCollision(geometry::Shape shape, const Eigen::Vector3d& p_BS,
                                         double friction = 0.8) {
  geometry::Collision collision;
  collision.name = "shape";
  collision.shape = std::move(shape);
  collision.X_BS.translation = p_BS;
  collision.friction = friction;
  return collision;
}

inline physics::BodyState At(double x, double y, double z) {
  physics::BodyState state;
  state.X_WB.translation = {x, y, z};
  return state;
}

/// An upright solid cylinder whose origin is the middle of its lower face.
inline physics::BodyId AddStandingCylinder(physics::PhysicsWorld* world,
                                           const geometry::Cylinder& cylinder, double mass,
                                           const Eigen::Vector3d& foot, double friction = 0.8) {
  const Eigen::Vector3d centre(0.0, 0.0, cylinder.length / 2);
  return world->AddLoose({mass, centre, geometry::SolidInertia(cylinder, mass)},
                         {MakeCollision(cylinder, centre, friction)},
                         At(foot.x(), foot.y(), foot.z()));
}

/// Tables and chairs of a room, none of them nearer than a metre to the start.
inline void AddRoom(physics::PhysicsWorld* world, int num_boxes = 60) {
  world->AddFloor(1.0);
  for (int i = 0; i < num_boxes; ++i) {
    world->AddStatic({MakeCollision(geometry::Box{{0.5, 0.5, 0.7}}, {0.0, 0.0, 0.35}, 1.0)},
                     geometry::Lift({1.5 + i % 8, -3.5 + i / 8, 0.1 * i}));
  }
}

constexpr double kTrayTop = 0.3462;  ///< height of the tray's upper face [m]

/// A tray on a driven base, in a room, with so many pepper mills on it.
struct TrayScene {
  explicit TrayScene(int num_mills, const physics::PhysicsParams& params = {}) : world(params) {
    AddRoom(&world);
    base = world.AddDriven(
        {MakeCollision(geometry::Box{{0.668, 0.668, 0.2}}, {0.0, 0.0, 0.15}, 0.5),
         MakeCollision(geometry::Box{{0.250, 0.658, 0.005}}, {0.2045, 0.0, kTrayTop - 0.0025})},
        geometry::Pose3());
    for (int i = 0; i < num_mills; ++i) {
      const bool is_alone = num_mills == 1;
      const double x = is_alone ? 0.2 : 0.14 + 0.09 * (i % 2);
      const double y = is_alone ? 0.0 : -0.28 + 0.08 * (i / 2);
      mills.push_back(AddStandingCylinder(&world, {0.037, 0.274}, 0.14, {x, y, kTrayTop}));
    }
  }

  physics::PhysicsWorld world;
  physics::BodyId base{0};
  std::vector<physics::BodyId> mills;
};

}  // namespace hires::test_support
