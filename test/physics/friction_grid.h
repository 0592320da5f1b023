#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/geometry/angles.h"
#include "hires/physics/physics_world.h"
#include "physics/scenes.h"
#include "support/planar_oracle.h"

namespace hires::test_support {

constexpr double kMostSlide = 0.10;  ///< [m] as standing.slide of config/scene.yaml

/// A body of the grid: what the simulator and what the planar oracle get.
struct GridBody {
  std::string name;
  geometry::MassProperties mass;  ///< its origin is the middle of its lower face
  std::vector<geometry::Collision> shapes;
  PlanarBody planar;
};

/// @param kind   box (square base), cylinder, cone (solid, on a flat foot), stack (two boxes, one
/// body)
/// @param ratio  b/c: half the base's width over the height of the center of mass
/// @param c      [m]
inline GridBody MakeGridBody(const std::string& kind, double ratio, double c, double friction) {
  constexpr double kMass = 0.4;  // [kg]
  const double b = ratio * c;
  GridBody body{kind, {kMass, {0.0, 0.0, c}, Eigen::Matrix3d::Identity()}, {}, {b, c, 0.0}};
  const auto add = [&](geometry::Shape shape, double height) {
    body.shapes.push_back(MakeCollision(std::move(shape), {0.0, 0.0, height}, friction));
  };
  if (kind == "box") {
    const geometry::Box box{{2.0 * b, 2.0 * b, 2.0 * c}};
    add(box, c);
    body.mass.I_BBcm = geometry::SolidInertia(box, kMass);
  } else if (kind == "cylinder") {
    const geometry::Cylinder cylinder{b, 2.0 * c};
    add(cylinder, c);
    body.mass.I_BBcm = geometry::SolidInertia(cylinder, kMass);
  } else if (kind == "cone") {
    const double h = 4.0 * c;
    add(geometry::Cylinder{b, 0.2 * c}, 0.1 * c);
    const double across = 3.0 / 80.0 * (4.0 * b * b + h * h);
    body.mass.I_BBcm =
        kMass * Eigen::Vector3d(across, across, 0.3 * b * b).asDiagonal().toDenseMatrix();
  } else {
    const geometry::Box lower{{2.0 * b, 2.0 * b, c}}, upper{{b, b, c}};
    add(lower, 0.5 * c);
    add(upper, 1.5 * c);
    const Eigen::Vector3d off(0.0, 0.0, 0.5 * c);
    body.mass.I_BBcm =
        geometry::SolidInertia(lower, 0.5 * kMass) + geometry::SolidInertia(upper, 0.5 * kMass) +
        kMass * (off.squaredNorm() * Eigen::Matrix3d::Identity() - off * off.transpose());
  }
  body.planar.gyration = body.mass.I_BBcm(1, 1) / kMass;
  return body;
}

/// One body on a wide plate in the product's simulator; the scene is turned to a heading.
class GridScene {
 public:
  /// @param heading  [rad] of the motion and of the body
  /// @param yaw      [rad] of the body against the motion: its edges are oblique to it
  GridScene(const GridBody& body, double friction, const PlateMotion& motion, double heading,
            double yaw = 0.0)
      : motion_(motion),
        turned_(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())),
        balance_(std::atan2(body.planar.b * (yaw == 0.0 ? 1.0 : std::sqrt(2.0)), body.planar.c)),
        world_(physics::PhysicsParams()) {
    plate_ = world_.AddDriven(
        {MakeCollision(geometry::Box{{40.0, 40.0, 0.1}}, {0.0, 0.0, -0.05}, friction)},
        PoseAt(-kSettle));
    physics::BodyState state{PoseAt(-kSettle), {}};
    state.V_WB.linear = turned_ * Eigen::Vector3d(motion.start_speed, 0.0, 0.0);
    state.X_WB.rotation = state.X_WB.rotation * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    body_ = world_.AddLoose(body.mass, body.shapes, state);
  }

  PlanarVerdict Play() {
    const double dt = world_.params().time_step;
    for (long i = -std::lround(kSettle / dt); i < 0; ++i) Step(i * dt);
    start_ = Relative().translation;
    double quiet = 0.0;
    Eigen::Vector3d before = start_;
    for (long i = 0; i * dt < motion_.end + kLongest && quiet < kQuiet; ++i) {
      Step(i * dt);
      const geometry::Pose3 X_PB = Relative();
      const double tilt = geometry::TiltOf(X_PB.rotation);
      max_tilt_ = std::max(max_tilt_, tilt);
      slide_ = std::max(slide_, (X_PB.translation - start_).head<2>().norm());
      if (tilt > balance_ + kBeyondBalance) return PlanarVerdict::kTips;
      if (slide_ > kMostSlide) return PlanarVerdict::kSlides;
      const bool moves =
          tilt > 1e-3 || (X_PB.translation - before).norm() > 1e-4 * dt || i * dt < motion_.end;
      before = X_PB.translation;
      quiet = moves ? 0.0 : quiet + dt;
    }
    return PlanarVerdict::kStays;
  }
  double slide() const { return slide_; }
  double max_tilt() const { return max_tilt_; }

 private:
  static constexpr double kSettle = 0.1;          // [s]
  static constexpr double kLongest = 8.0;         // [s] after the plate moves steadily
  static constexpr double kQuiet = 0.05;          // [s]
  static constexpr double kBeyondBalance = 0.25;  // [rad]

  geometry::Pose3 PoseAt(double time) const {
    const PlatePose plate = motion_.pose(time);
    geometry::Pose3 X_WP;
    X_WP.translation = turned_ * Eigen::Vector3d(plate.x, 0.0, plate.z);
    X_WP.rotation = turned_ * Eigen::AngleAxisd(plate.pitch, Eigen::Vector3d::UnitY());
    return X_WP;
  }
  void Step(double time) {
    const double dt = world_.params().time_step;
    const PlatePose now = motion_.pose(time), next = motion_.pose(time + dt);
    physics::BodyState state{PoseAt(time), {}};
    state.V_WB.linear =
        turned_ * Eigen::Vector3d((next.x - now.x) / dt, 0.0, (next.z - now.z) / dt);
    state.V_WB.angular = turned_ * Eigen::Vector3d(0.0, (next.pitch - now.pitch) / dt, 0.0);
    world_.SetMotion(plate_, state);
    world_.Step();
  }
  geometry::Pose3 Relative() const {
    return world_.GetState(plate_).X_WB.Inverse() * world_.GetState(body_).X_WB;
  }

  const PlateMotion motion_;
  const Eigen::Quaterniond turned_;
  const double balance_;
  physics::PhysicsWorld world_;
  physics::BodyId plate_{0}, body_{0};
  Eigen::Vector3d start_{Eigen::Vector3d::Zero()};
  double slide_{0.0}, max_tilt_{0.0};
};

/// A motion with one number that is looked for.
struct GridMotion {
  std::string name, unit;
  double lower{0.0}, upper{0.0};
  std::function<PlateMotion(double)> at;
};

/// The same on a floor uneven by `roughness` [m]: waves of 0.15 to 2.4 m as simulation's
/// FloorProfile has them, here all along the motion; wheels 0.2 m before and behind the middle.
inline PlateMotion OnUnevenFloor(const PlateMotion& even, double roughness) {
  constexpr int kWaves = 12;
  constexpr double kWheelArm = 0.2, kShortest = 0.15, kLongest = 2.4;  // [m]
  const auto height = [=](double x) {
    double sum = 0.0, variance = 0.0;
    for (int i = 0; i < kWaves; ++i) {
      const double length = kShortest * std::pow(kLongest / kShortest, i / (kWaves - 1.0));
      sum += length * std::cos(2.0 * geometry::kPi * x / length + 2.4 * i);
      variance += 0.5 * length * length;
    }
    return roughness / std::sqrt(variance) * sum;
  };
  const auto pose = [=](double time) {
    PlatePose plate = even.pose(time);
    const double front = height(plate.x + kWheelArm), rear = height(plate.x - kWheelArm);
    plate.z = 0.5 * (front + rear);
    plate.pitch = (rear - front) / (2.0 * kWheelArm);
    return plate;
  };
  return {pose, even.start_speed, even.end};
}

inline std::vector<GridMotion> GridMotions() {
  return {{"sudden stop", "m/s", 0.02, 4.0, SuddenStop},
          {"constant deceleration from 1 m/s", "m/s^2", 0.1, 60.0,
           [](double a) { return RampedStop(1.0, a); }},
          {"pulse of 0.15 s", "m/s^2", 0.1, 60.0, [](double a) { return Pulse(a, 0.15); }},
          {"stop from 1 m/s, deceleration rises within 0.1 s", "m/s^2", 0.1, 60.0,
           [](double a) { return RampedStop(1.0, a, 0.1); }},
          {"constant deceleration from 1 m/s, floor uneven by 0.0005 m", "m/s^2", 0.1, 60.0,
           [](double a) { return OnUnevenFloor(RampedStop(1.0, a), 0.0005); }}};
}

/// What the oracle says of a body and a motion.
struct OracleLimit {
  std::optional<double> value;                   ///< none: it stays up to the motion's upper end
  PlanarVerdict verdict{PlanarVerdict::kStays};  ///< just beyond it
  double goal{0.0};  ///< 0.03 where time steps of 1 and 0.1 ms agree, 0.05 elsewhere; 0: chaotic
};

inline OracleLimit FindOracleLimit(const PlanarBody& body, double friction,
                                   const GridMotion& motion) {
  const auto run = [&](double value, double step) {
    return PlanarOracle(body, friction, motion.at(value), step).Run(kMostSlide).verdict;
  };
  constexpr double kRatio = 1.25, kNear = 1.03;
  double upper = motion.lower;
  while (upper <= motion.upper && run(upper, 1e-3) == PlanarVerdict::kStays) upper *= kRatio;
  OracleLimit limit;
  if (upper > motion.upper) return limit;
  double lower = upper / kRatio;
  const auto halve = [&](double ratio, double step) {
    while (upper > ratio * lower) {
      const double middle = std::sqrt(lower * upper);
      const PlanarVerdict verdict = run(middle, step);
      if (verdict != PlanarVerdict::kStays) limit.verdict = verdict;
      (verdict == PlanarVerdict::kStays ? lower : upper) = middle;
    }
  };
  halve(1.01, 1e-3);
  const double coarse = upper;
  lower = coarse / kNear;
  upper = coarse * kNear;
  while (run(lower, 1e-4) != PlanarVerdict::kStays) lower /= kNear;
  while (run(upper, 1e-4) == PlanarVerdict::kStays) upper *= kNear;
  halve(1.001, 1e-4);
  limit.value = upper;
  for (const double goal : {0.03, 0.05}) {
    const bool agree = run((1.0 - goal) * upper, 1e-3) == PlanarVerdict::kStays &&
                       run((1.0 - goal) * upper, 1e-4) == PlanarVerdict::kStays &&
                       run((1.0 + goal) * upper, 1e-3) == run((1.0 + goal) * upper, 1e-4) &&
                       run((1.0 + goal) * upper, 1e-4) != PlanarVerdict::kStays;
    if (agree) {
      limit.goal = goal;
      break;
    }
  }
  return limit;
}

/// The smallest of some margins e at which the simulator stays at (1 - e) and does not at (1 + e)
/// times the limit, at every heading; 1: none of them.
inline double GridError(const GridBody& body, double friction, const GridMotion& motion,
                        double limit, int num_headings) {
  const auto stays = [&](double value, double heading) {
    return GridScene(body, friction, motion.at(value), heading).Play() == PlanarVerdict::kStays;
  };
  double error = 0.005;
  for (int i = 0; i < num_headings; ++i) {
    const double heading = 2.0 * geometry::kPi * i / num_headings;
    for (const double e : {0.005, 0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.5, 1.0}) {
      if (e < error) continue;
      error = e;
      if (e == 1.0 || (stays((1.0 - e) * limit, heading) && !stays((1.0 + e) * limit, heading)))
        break;
    }
  }
  return error;
}

}  // namespace hires::test_support
