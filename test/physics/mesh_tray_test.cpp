// What stands on a face of a mesh tips as on a box.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/geometry/inertia.h"
#include "hires/physics/physics_world.h"
#include "support/box_mesh.h"

namespace hires::physics::mesh_tray_test {
namespace {

using Eigen::Vector3d;
using hires::test_support::Basket;
using hires::test_support::Tub;

constexpr double kFloorTop = 0.01;  // [m]

geometry::Collision Shape(const std::string& name, geometry::Shape shape, const Vector3d& p_BS) {
  geometry::Collision collision;
  collision.name = name;
  collision.shape = std::move(shape);
  collision.X_BS.translation = p_BS;
  return collision;
}

/// [rad] after 0.8 s in which the ground is shaken to one side by `share` of what tips a solid of
/// that half width and height.
double TiltOf(const geometry::Shape& tray, const Vector3d& p_Tray, const geometry::Shape& load,
              double half_width, double height, double share, double yaw) {
  PhysicsWorld world{PhysicsParams()};
  world.AddStatic({Shape("tray", tray, p_Tray)}, {});
  const auto* can = std::get_if<geometry::Cylinder>(&load);
  const geometry::Box box{{2 * half_width, 2 * half_width, height}};
  const geometry::MassProperties properties{
      0.5,
      {0.0, 0.0, height / 2},
      can != nullptr ? geometry::SolidInertia(*can, 0.5) : geometry::SolidInertia(box, 0.5)};
  BodyState state;
  state.X_WB.translation = {0.02, 0.01, kFloorTop};
  state.X_WB.rotation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ());
  const BodyId body =
      world.AddLoose(properties, {Shape("load", load, {0.0, 0.0, height / 2})}, state);
  for (int i = 0; i < 200; ++i) world.Step();  // it settles
  const double tipping = 9.81 * half_width / (height / 2);
  world.SetExtraAcceleration(share * tipping * Vector3d(std::cos(yaw), std::sin(yaw), 0.0));
  for (int i = 0; i < 800; ++i) world.Step();
  return geometry::TiltOf(world.GetState(body).X_WB.rotation);
}

TEST(MeshTrayTest, ACylinderTipsWhereTheClosedFormSaysOnEveryKindOfTray) {
  const geometry::Cylinder can{0.03, 0.3};
  const std::vector<std::pair<geometry::Shape, Vector3d>> trays{
      {geometry::Box{{0.4, 0.3, 0.02}}, {0.0, 0.0, 0.0}}, {Basket(), {}}, {Tub(), {}}};
  for (std::size_t i = 0; i < trays.size(); ++i) {
    for (const double yaw : {0.0, 0.4, 2.3}) {
      EXPECT_LT(TiltOf(trays[i].first, trays[i].second, can, 0.03, 0.3, 0.97, yaw), 0.02)
          << i << " " << yaw;
      EXPECT_GT(TiltOf(trays[i].first, trays[i].second, can, 0.03, 0.3, 1.03, yaw), 0.05)
          << i << " " << yaw;
    }
  }
}

TEST(MeshTrayTest, SoDoesAMeshThatStandsThere) {
  const geometry::Shape carton = hires::test_support::BoxMesh({0.06, 0.06, 0.3});
  for (const geometry::Shape& tray : {geometry::Shape(Basket()), geometry::Shape(Tub())}) {
    EXPECT_LT(TiltOf(tray, {}, carton, 0.03, 0.3, 0.97, 0.0), 0.02);
    EXPECT_GT(TiltOf(tray, {}, carton, 0.03, 0.3, 1.03, 0.0), 0.05);
  }
}

}  // namespace
}  // namespace hires::physics::mesh_tray_test
