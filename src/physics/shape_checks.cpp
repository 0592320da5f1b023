// Boxes, cylinders and meshes at rest and pushed, on plates of every thickness.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "hires/geometry/angles.h"
#include "hires/physics/physics_checks.h"
#include "hires/physics/physics_world.h"

namespace hires::physics {
namespace {

using Eigen::Vector3d;

constexpr double kMass = 0.3;                                                 // [kg]
constexpr std::array<double, 6> kPlates{0.005, 0.01, 0.02, 0.03, 0.06, 0.1};  // [m] thick
constexpr int kTurns = 8;         // every other one parallel to the plate's edges but for rounding
constexpr double kResting = 1.0;  // [s]
constexpr double kMayMove = 0.001;  // [m]
constexpr int kTipHalvings = 12;

struct Thing {
  const char* name;
  geometry::Shape shape;
  double height;  ///< [m]
  Eigen::Matrix3d inertia;
};

geometry::Shape BoxAsMesh(const Vector3d& size) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, ((i >> 2) & 1) - 0.5);
    mesh->vertices.push_back(corner.cwiseProduct(size));
  }
  mesh->triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return std::shared_ptr<const geometry::TriangleMesh>(std::move(mesh));
}

std::vector<Thing> Things() {
  const geometry::Box cube{{0.06, 0.06, 0.06}}, book{{0.2, 0.14, 0.03}}, carton{{0.05, 0.08, 0.2}};
  const geometry::Cylinder can{0.03, 0.12};
  return {{"cube", cube, 0.06, geometry::SolidInertia(cube, kMass)},
          {"book", book, 0.03, geometry::SolidInertia(book, kMass)},
          {"carton as a mesh", BoxAsMesh(carton.size), 0.2, geometry::SolidInertia(carton, kMass)},
          {"can", can, 0.12, geometry::SolidInertia(can, kMass)}};
}

/// A thing on the middle of a plate that moves as told.
class Plate {
 public:
  Plate(const Thing& thing, double thickness, double yaw, double friction)
      : world_(PhysicsParams()) {
    geometry::Collision plate;
    plate.name = "plate";
    plate.shape = geometry::Box{{0.6, 0.5, thickness}};
    plate.friction = friction;
    geometry::Pose3 X_WP;
    X_WP.rotation = Eigen::AngleAxisd(0.7, Vector3d::UnitZ());
    plate_ = world_.AddDriven({plate}, X_WP);
    geometry::Collision solid;
    solid.name = thing.name;
    solid.shape = thing.shape;
    solid.friction = friction;
    BodyState state;
    state.X_WB.rotation = Eigen::AngleAxisd(0.7 + yaw, Vector3d::UnitZ());
    state.X_WB.translation.z() = 0.5 * (thickness + thing.height);
    thing_ = world_.AddLoose({kMass, Vector3d::Zero(), thing.inertia}, {solid}, state);
  }

  void Step() { world_.Step(); }
  void SetSpeed(const Vector3d& velocity) {
    BodyState state = world_.GetState(plate_);
    state.V_WB.linear = velocity;
    world_.SetMotion(plate_, state);
  }
  Vector3d place() const {
    return world_.GetState(thing_).X_WB.translation - world_.GetState(plate_).X_WB.translation;
  }
  double tilt() const { return geometry::TiltOf(world_.GetState(thing_).X_WB.rotation); }

 private:
  PhysicsWorld world_;
  BodyId plate_{0}, thing_{0};
};

PhysicsCheck CheckRest(const Thing& thing) {
  double farthest = 0.0;
  for (const double thickness : kPlates) {
    for (int i = 0; i < kTurns; ++i) {
      Plate plate(thing, thickness, i * 2.0 * geometry::kPi / kTurns, 0.6);
      const Vector3d start = plate.place();
      for (double time = 0.0; time < kResting; time += PhysicsParams().time_step) {
        plate.Step();
        farthest = std::max(farthest, (plate.place() - start).norm());
      }
    }
  }
  PhysicsCheck check{fmt::format("{} at rest on plates of {} to {} m, {} headings: moves",
                                 thing.name, kPlates.front(), kPlates.back(), kTurns),
                     "m",
                     0.0,
                     farthest,
                     farthest,
                     kMayMove,
                     ""};
  if (!std::isfinite(check.error)) check.error = HUGE_VAL;
  return check;
}

/// Where pushing harder and harder begins to tip it. @param direction  of the push, against the
/// thing
bool Tips(const Thing& thing, double thickness, double direction, double acceleration) {
  Plate plate(thing, thickness, 0.0, 3.0);
  const double heading = 0.7 + direction;
  for (int step = 1; step <= 2000; ++step) {
    const double speed = acceleration * step * PhysicsParams().time_step;
    plate.SetSpeed({speed * std::cos(heading), speed * std::sin(heading), 0.0});
    plate.Step();
    if (plate.tilt() > 0.05) return true;
  }
  return false;
}

PhysicsCheck CheckTipping(const geometry::Box& box) {
  const Thing thing{"box", box, box.size.z(), geometry::SolidInertia(box, kMass)};
  double worst = 1.0;  // measured to expected
  for (const double thickness : kPlates) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double width = quarter % 2 == 0 ? box.size.x() : box.size.y();
      const double expected = PhysicsParams().gravity * width / box.size.z();
      double lower = 0.8 * expected, upper = 1.2 * expected;
      for (int i = 0; i < kTipHalvings; ++i) {
        const double middle = 0.5 * (lower + upper);
        (Tips(thing, thickness, 0.5 * geometry::kPi * quarter, middle) ? upper : lower) = middle;
      }
      if (std::abs(upper / expected - 1.0) > std::abs(worst - 1.0)) worst = upper / expected;
    }
  }
  return {fmt::format("onset of tipping of a box over each edge, plates of {} to {} m",
                      kPlates.front(), kPlates.back()),
          "of g w / h",
          1.0,
          worst,
          std::abs(worst - 1.0),
          0.01,
          ""};
}

}  // namespace

std::vector<PhysicsCheck> RunShapeChecks() {
  std::vector<PhysicsCheck> checks;
  for (const Thing& thing : Things()) checks.push_back(CheckRest(thing));
  checks.push_back(CheckTipping({{0.06, 0.08, 0.2}}));
  return checks;
}

}  // namespace hires::physics
