// Things to stand, and what carries them.
#pragma once

#include <cmath>
#include <string>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/physics/physics_world.h"
#include "physics/scenes.h"

namespace hires::physics::test_support {

enum class Thing { kCube, kBook, kCan, kMeshBox };
enum class Carrier { kBoxPlate, kDisc, kMeshPlate, kStaticBox };
constexpr int kNumCarriers = 4;

inline std::string NameOf(Thing thing) {
  constexpr const char* kNames[] = {"Cube", "Book", "Can", "MeshBox"};
  return kNames[static_cast<int>(thing)];
}

inline std::string NameOf(Carrier carrier) {
  constexpr const char* kNames[] = {"BoxPlate", "Disc", "MeshPlate", "StaticBox"};
  return kNames[static_cast<int>(carrier)];
}

/// A shape with its height.
struct Drawn {
  geometry::Shape shape;
  double height;            ///< [m]
  Eigen::Matrix3d inertia;  ///< of 1 kg
};

inline Drawn MakeBox(const Eigen::Vector3d& size, bool is_mesh = false) {
  const geometry::Box box{size};
  const Eigen::Matrix3d inertia = geometry::SolidInertia(box, 1.0);
  if (is_mesh) return {hires::test_support::BoxMesh(size), size.z(), inertia};
  return {box, size.z(), inertia};
}

inline Drawn MakeCan(double radius, double height) {
  const geometry::Cylinder can{radius, height};
  return {can, height, geometry::SolidInertia(can, 1.0)};
}

inline Drawn DrawThing(Thing thing, base::Rng* rng) {
  if (thing == Thing::kCan) {
    const double radius = rng->Uniform(0.02, 0.06);
    return MakeCan(radius, rng->Uniform(0.03, 0.25));
  }
  Eigen::Vector3d size(rng->Uniform(0.03, 0.12), rng->Uniform(0.03, 0.12), rng->Uniform(0.03, 0.2));
  if (thing == Thing::kCube) size = Eigen::Vector3d::Constant(0.06);
  if (thing == Thing::kBook) size = {0.2, 0.14, rng->Uniform(0.01, 0.04)};
  return MakeBox(size, thing == Thing::kMeshBox);
}

inline geometry::Pose3 Rotated(double yaw, const Eigen::Vector3d& at) {
  geometry::Pose3 pose;
  pose.rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  pose.translation = at;
  return pose;
}

/// Half of all yaws are whole quarter turns, in which edges are parallel but for rounding.
inline double DrawYaw(base::Rng* rng) {
  const double any = rng->Uniform(-geometry::kPi, geometry::kPi);
  return rng->Uniform(0.0, 1.0) < 0.5 ? any
                                      : geometry::kPi / 2 * std::round(any / (geometry::kPi / 2));
}

/// A world with something that carries, up to z = `top` at its middle.
struct Carried {
  PhysicsWorld world{PhysicsParams()};
  geometry::Pose3 X_WC;
  double top{0.0};

  /// On top of all that is there.
  BodyId Put(const Drawn& thing, double mass, double yaw, double friction) {
    BodyState state;
    state.X_WB = Rotated(yaw, X_WC.translation);
    state.X_WB.translation.z() = top + thing.height / 2;
    top += thing.height;
    return world.AddLoose(
        {mass, Eigen::Vector3d::Zero(), mass * thing.inertia},
        {hires::test_support::MakeCollision(thing.shape, Eigen::Vector3d::Zero(), friction)},
        state);
  }
};

inline void AddCarrier(Carrier carrier, base::Rng* rng, Carried* scene) {
  const double thickness = rng->Uniform(0.005, 0.1), friction = rng->Uniform(0.2, 1.0);
  const double yaw = DrawYaw(rng);
  const double x = rng->Uniform(-9.0, 9.0), y = rng->Uniform(-9.0, 9.0);
  scene->X_WC = Rotated(yaw, {x, y, rng->Uniform(0.0, 1.0)});
  scene->top = scene->X_WC.translation.z() + thickness / 2;
  const Eigen::Vector3d size(0.5, 0.4, thickness);
  geometry::Shape shape = geometry::Box{size};
  if (carrier == Carrier::kDisc) shape = geometry::Cylinder{0.3, thickness};
  if (carrier == Carrier::kMeshPlate) shape = hires::test_support::BoxMesh(size);
  const auto plate = hires::test_support::MakeCollision(shape, Eigen::Vector3d::Zero(), friction);
  if (carrier == Carrier::kStaticBox) {
    scene->world.AddStatic({plate}, scene->X_WC);
  } else {
    scene->world.AddDriven({plate}, scene->X_WC);
  }
}

}  // namespace hires::physics::test_support
