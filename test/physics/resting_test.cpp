// What stands on something that does not move stays where it is, whatever both are and however they
// are turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/physics/physics_world.h"
#include "physics/scenes.h"
#include "support/rounds.h"

namespace hires::physics::resting_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using geometry::Pose3;

constexpr int kSteps = 200;
constexpr double kMoved = 1e-3;  // [m]

enum class Thing { kCube, kBook, kCan, kMeshBox };
enum class Carrier { kBoxPlate, kDisc, kMeshPlate, kStaticBox };

struct Case {
  Thing thing;
  Carrier carrier;
};

std::string NameOf(const Case& at) {
  constexpr const char* kThings[] = {"Cube", "Book", "Can", "MeshBox"};
  constexpr const char* kCarriers[] = {"BoxPlate", "Disc", "MeshPlate", "StaticBox"};
  return std::string(kThings[static_cast<int>(at.thing)]) + "On" +
         kCarriers[static_cast<int>(at.carrier)];
}

/// A shape with its height.
struct Drawn {
  geometry::Shape shape;
  double height;
  Eigen::Matrix3d inertia;  // of 0.3 kg
};

constexpr double kMass = 0.3;

Drawn DrawThing(Thing thing, base::Rng* rng) {
  if (thing == Thing::kCan) {
    const geometry::Cylinder can{rng->Uniform(0.02, 0.06), rng->Uniform(0.03, 0.25)};
    return {can, can.length, geometry::SolidInertia(can, kMass)};
  }
  Vector3d size(rng->Uniform(0.03, 0.12), rng->Uniform(0.03, 0.12), rng->Uniform(0.03, 0.2));
  if (thing == Thing::kCube) size = Vector3d::Constant(0.06);
  if (thing == Thing::kBook) size = {0.2, 0.14, rng->Uniform(0.01, 0.04)};
  const geometry::Box box{size};
  const Eigen::Matrix3d inertia = geometry::SolidInertia(box, kMass);
  if (thing == Thing::kMeshBox) return {test_support::BoxMesh(size), size.z(), inertia};
  return {box, size.z(), inertia};
}

Pose3 Rotated(double yaw, const Vector3d& at) {
  Pose3 pose;
  pose.rotation = AngleAxisd(yaw, Vector3d::UnitZ());
  pose.translation = at;
  return pose;
}

/// Half of all yaws are whole quarter turns, in which edges are parallel but for rounding.
double DrawYaw(base::Rng* rng) {
  const double any = rng->Uniform(-geometry::kPi, geometry::kPi);
  return rng->Uniform(0.0, 1.0) < 0.5 ? any
                                      : geometry::kPi / 2 * std::round(any / (geometry::kPi / 2));
}

/// A world with something that carries, up to z = `top` at its middle.
struct Scene {
  PhysicsWorld world{PhysicsParams()};
  Pose3 X_WC;
  double top{0.0};
};

void AddCarrier(Carrier carrier, base::Rng* rng, Scene* scene) {
  const double thickness = rng->Uniform(0.005, 0.1), friction = rng->Uniform(0.2, 1.0);
  const double yaw = DrawYaw(rng);
  scene->X_WC =
      Rotated(yaw, {rng->Uniform(-9.0, 9.0), rng->Uniform(-9.0, 9.0), rng->Uniform(0.0, 1.0)});
  scene->top = scene->X_WC.translation.z() + thickness / 2;
  const Vector3d size(0.5, 0.4, thickness);
  geometry::Shape shape = geometry::Box{size};
  if (carrier == Carrier::kDisc) shape = geometry::Cylinder{0.3, thickness};
  if (carrier == Carrier::kMeshPlate) shape = test_support::BoxMesh(size);
  const auto plate = test_support::MakeCollision(shape, Vector3d::Zero(), friction);
  if (carrier == Carrier::kStaticBox) {
    scene->world.AddStatic({plate}, scene->X_WC);
    return;
  }
  scene->world.AddDriven({plate}, scene->X_WC);
}

class RestingTest : public testing::TestWithParam<Case> {};

TEST_P(RestingTest, StaysWhereItIs) {
  const base::Rng seed(2026);
  int num_moved = 0;
  double farthest = 0.0;
  const int num_truths = test_support::Rounds(1000);
  for (int i = 0; i < num_truths; ++i) {
    base::Rng rng = seed.Fork(i);
    Scene scene;
    AddCarrier(GetParam().carrier, &rng, &scene);
    const Drawn thing = DrawThing(GetParam().thing, &rng);
    BodyState state;
    state.X_WB = Rotated(DrawYaw(&rng), scene.X_WC.translation);
    state.X_WB.translation.z() = scene.top + thing.height / 2;
    const BodyId body = scene.world.AddLoose(
        {kMass, Vector3d::Zero(), thing.inertia},
        {test_support::MakeCollision(thing.shape, Vector3d::Zero(), rng.Uniform(0.2, 1.0))}, state);
    double moved = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      scene.world.Step();
      moved = std::max(
          moved, (scene.world.GetState(body).X_WB.translation - state.X_WB.translation).norm());
    }
    farthest = std::max(farthest, moved);
    if (moved > kMoved || scene.world.broken()) ++num_moved;
  }
  EXPECT_EQ(num_moved, 0) << "of " << num_truths << "; the farthest by " << farthest << " m";
}

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  for (const Thing thing : {Thing::kCube, Thing::kBook, Thing::kCan, Thing::kMeshBox}) {
    for (const Carrier carrier :
         {Carrier::kBoxPlate, Carrier::kDisc, Carrier::kMeshPlate, Carrier::kStaticBox}) {
      cases.push_back({thing, carrier});
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(All, RestingTest, testing::ValuesIn(AllCases()),
                         [](const auto& info) { return NameOf(info.param); });

}  // namespace
}  // namespace hires::physics::resting_test
