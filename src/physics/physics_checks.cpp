#include "hires/physics/physics_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "hires/geometry/angles.h"
#include "hires/physics/physics_world.h"

namespace hires::physics {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;    // [m/s^2]
constexpr double kTimeStep = 0.001;  // [s]
constexpr double kNoSlipFriction = 3.0;
constexpr double kSlidingFriction = 0.2;
constexpr double kRestitution = 0.5;
constexpr int kHeadings = 36;
constexpr int kPulseHeadings = 6;  // spread over one sixth of the circle: a pulse takes long
// [rad] Far beyond the angle at which any of these cylinders balances on its rim: none comes back.
// It tells which side of a closed form's boundary a body is on, not what counts as a fall
// elsewhere.
constexpr double kFallen = 1.0;
constexpr int kHalvings = 14;  // of the bracket around a boundary: 6e-5 of its width

/// One cylinder on a wide plate that moves as told along one heading.
class Ground {
 public:
  Ground(const UprightCylinder& body, double heading, double friction, double restitution = 0.0,
         double drop_height = 0.0)
      : direction_(std::cos(heading), std::sin(heading), 0.0), world_(PhysicsParams()) {
    geometry::Collision plate;
    plate.name = "plate";
    plate.shape = geometry::Box{{40.0, 40.0, 0.1}};
    plate.X_BS.translation.z() = -0.05;
    plate.friction = friction;
    plate.restitution = restitution;
    ground_ = world_.AddDriven({plate}, geometry::Pose3());
    const geometry::Cylinder cylinder{body.radius, body.height};
    geometry::Collision solid;
    solid.name = "cylinder";
    solid.shape = cylinder;
    solid.friction = friction;
    BodyState state;
    state.X_WB.translation.z() = body.height / 2 + drop_height;
    body_ = world_.AddLoose(
        {body.mass, Vector3d::Zero(), geometry::SolidInertia(cylinder, body.mass)}, {solid}, state);
  }

  /// Ground and body move at this speed from now on.
  void SetCommonSpeed(double speed) {
    SetGroundSpeed(speed);
    SetBodySpeed(speed);
  }

  void SetBodySpeed(double speed) {
    BodyState state = world_.GetState(body_);
    state.V_WB.linear = speed * direction_;
    world_.SetState(body_, state);
  }

  /// @param angular  [rad/s] in the map.
  void SpinBody(const Vector3d& angular) {
    BodyState state = world_.GetState(body_);
    state.V_WB.angular = angular;
    world_.SetState(body_, state);
  }

  void SetGroundSpeed(double speed) {
    BodyState state = world_.GetState(ground_);
    state.V_WB.linear = speed * direction_;
    world_.SetMotion(ground_, state);
  }

  void Step(int num_steps = 1) {
    for (int i = 0; i < num_steps; ++i) world_.Step();
  }

  Vector3d axis() const { return world_.GetState(body_).X_WB.rotation * Vector3d::UnitZ(); }
  double tilt() const { return geometry::TiltOf(world_.GetState(body_).X_WB.rotation); }
  Vector3d place() const {  ///< of the body's centre against the ground [m]
    return world_.GetState(body_).X_WB.translation - world_.GetState(ground_).X_WB.translation;
  }
  Vector3d velocity() const { return world_.GetState(body_).V_WB.linear; }
  int num_contacts() const { return world_.num_contacts(); }

 private:
  Vector3d direction_;
  PhysicsWorld world_;
  BodyId ground_{0}, body_{0};
};

/// The least value in lower..upper for which `happens`; it is taken to go on happening above.
double Onset(double lower, double upper, const std::function<bool(double)>& happens) {
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (lower + upper);
    (happens(middle) ? upper : lower) = middle;
  }
  return upper;
}

double Heading(int index) { return 2.0 * geometry::kPi * index / kHeadings; }

/// Steps until the body has fallen, or has risen again to less than half of its largest tilt.
bool FallsOver(Ground* ground, const std::function<double(double)>& ground_speed) {
  double largest = 0.0;
  for (int step = 1; step <= 5000; ++step) {
    ground->SetGroundSpeed(ground_speed(step * kTimeStep));
    ground->Step();
    const double tilt = ground->tilt();
    if (tilt > kFallen) return true;
    largest = std::max(largest, tilt);
    if (largest > 0.005 && tilt < 0.5 * largest) return false;
  }
  return false;
}

bool TipsAt(const UprightCylinder& body, double heading, double acceleration) {
  Ground ground(body, heading, kNoSlipFriction);
  for (int step = 1; step <= 2000; ++step) {
    ground.SetGroundSpeed(acceleration * step * kTimeStep);
    ground.Step();
    if (ground.tilt() > 0.05) return true;
  }
  return false;
}

bool SlidesAt(const UprightCylinder& body, double heading, double acceleration) {
  Ground ground(body, heading, kSlidingFriction);
  ground.Step(100);
  const Vector3d start = ground.place();
  for (int step = 1; step <= 1000; ++step) {
    ground.SetGroundSpeed(acceleration * step * kTimeStep);
    ground.Step();
    if ((ground.place() - start).head<2>().norm() > 0.001) return true;
  }
  return false;
}

bool TopplesOnSuddenStop(const UprightCylinder& body, double heading, double speed) {
  Ground ground(body, heading, kNoSlipFriction);
  ground.SetCommonSpeed(speed);
  ground.Step(100);
  return FallsOver(&ground, [](double) { return 0.0; });
}

bool TopplesOnPulse(const UprightCylinder& body, double heading, double acceleration,
                    double duration) {
  Ground ground(body, heading, kNoSlipFriction);
  ground.SetCommonSpeed(acceleration * duration);
  ground.Step(100);
  return FallsOver(
      &ground, [&](double time) { return acceleration * (duration - std::min(time, duration)); });
}

PhysicsCheck Compare(std::string name, std::string unit, double expected, double measured,
                     double tolerance) {
  PhysicsCheck check{std::move(name), std::move(unit), expected, measured, 0.0, tolerance, ""};
  check.error = std::abs(measured - expected);
  if (expected != 0.0) check.error /= std::abs(expected);
  if (!std::isfinite(check.error)) check.error = HUGE_VAL;  // a NaN is no success
  return check;
}

/// The value of `measure` that is farthest from `expected`.
double Worst(int num_headings, double expected, const std::function<double(double)>& measure) {
  double worst = expected;
  for (int i = 0; i < num_headings; ++i) {
    const double measured = measure(Heading(i));
    if (!(std::abs(measured - expected) <= std::abs(worst - expected))) worst = measured;
  }
  return worst;
}

PhysicsCheck CheckTipping(const UprightCylinder& body) {
  const double expected = TippingAcceleration(body, kGravity);
  const double measured = Worst(kHeadings, expected, [&](double heading) {
    return Onset(0.8 * expected, 1.2 * expected,
                 [&](double a) { return TipsAt(body, heading, a); });
  });
  return Compare("onset of tipping, 36 headings", "m/s^2", expected, measured, 0.01);
}

PhysicsCheck CheckSliding(const UprightCylinder& body) {
  const double expected = SlidingAcceleration(kSlidingFriction, kGravity);
  const double measured = Worst(kHeadings, expected, [&](double heading) {
    return Onset(0.8 * expected, 1.2 * expected,
                 [&](double a) { return SlidesAt(body, heading, a); });
  });
  return Compare("onset of sliding, friction 0.2, 36 headings", "m/s^2", expected, measured, 0.01);
}

PhysicsCheck CheckSuddenStop(const UprightCylinder& body) {
  const double expected = SuddenStopTopplingSpeed(body, kGravity);
  const double measured = Worst(kHeadings, expected, [&](double heading) {
    return Onset(0.8 * expected, 1.2 * expected,
                 [&](double speed) { return TopplesOnSuddenStop(body, heading, speed); });
  });
  return Compare("toppling by a sudden stop, friction 3, 36 headings", "m/s", expected, measured,
                 0.03);
}

PhysicsCheck CheckPulse(const UprightCylinder& body, double x, double tolerance) {
  const double acceleration = x * TippingAcceleration(body, kGravity);
  const double expected = OverturningPulseDuration(body, acceleration, kGravity);
  const double measured = Worst(kPulseHeadings, expected, [&](double heading) {
    return Onset(0.8 * expected, 1.2 * expected, [&](double duration) {
      return TopplesOnPulse(body, heading, acceleration, duration);
    });
  });
  PhysicsCheck check = Compare(fmt::format("overturning pulse, x = {}, 6 headings", x), "s",
                               expected, measured, tolerance);
  check.remark = fmt::format("Housner's linearised form gives {:.4f} s",
                             HousnerPulseDuration(body, acceleration, kGravity));
  return check;
}

PhysicsCheck CheckFreeFall(const UprightCylinder& body) {
  Ground ground(body, 0.0, 1.0, 0.0, 20.0);
  const double start = ground.place().z();
  ground.Step(1000);
  return Compare("free fall of 1 s", "m", kGravity / 2, start - ground.place().z(), 0.002);
}

/// The axis of a spinning cylinder that nothing turns goes round the angular momentum L at the rate
/// |L| / I_x [Goldstein, Classical Mechanics, section 5.6]; so the rate tells I_z / I_x, for which
/// a solid cylinder has 6 r^2 / (3 r^2 + h^2) (dissertation, Eq. 5.4).
PhysicsCheck CheckPrecession(const UprightCylinder& body) {
  constexpr double kSpin = 3.0, kNod = 0.1;  // [rad/s] about the axis, and across it
  constexpr int kSteps = 1000;
  const double square = body.radius * body.radius;
  const double ratio = 6.0 * square / (3.0 * square + body.height * body.height);
  Ground ground(body, 0.0, 1.0, 0.0, 20.0);  // it falls meanwhile
  ground.SpinBody({kNod, 0.0, kSpin});
  const Vector3d momentum = Vector3d(kNod, 0.0, ratio * kSpin).normalized();  // times I_x
  const Vector3d across = momentum.unitOrthogonal();
  const auto angle = [&] {
    const Vector3d axis = ground.axis();
    return std::atan2(axis.dot(momentum.cross(across)), axis.dot(across));
  };
  const double start = angle();
  ground.Step(kSteps);
  const double rate = geometry::WrapToPi(angle() - start) / (kSteps * kTimeStep);
  return Compare("ratio of the moments of inertia I_z / I_x, by free precession", "1", ratio,
                 std::sqrt(std::max(0.0, rate * rate - kNod * kNod)) / kSpin, 0.01);
}

PhysicsCheck CheckStoppingDistance(const UprightCylinder& body) {
  constexpr double kSpeed = 1.0;  // [m/s]
  const double expected = kSpeed * kSpeed / (2.0 * kSlidingFriction * kGravity);
  const double measured = Worst(kHeadings, expected, [&](double heading) {
    Ground ground(body, heading, kSlidingFriction);
    ground.Step(100);
    const Vector3d start = ground.place();
    ground.SetBodySpeed(kSpeed);
    ground.Step(1000);
    return (ground.place() - start).head<2>().norm();
  });
  return Compare("stopping distance from 1 m/s, friction 0.2, 36 headings", "m", expected, measured,
                 0.01);
}

PhysicsCheck CheckRestitution(const UprightCylinder& body) {
  Ground ground(body, 0.0, 1.0, kRestitution, 0.1);
  double before = ground.velocity().z();
  for (int step = 0; step < 1000; ++step) {
    ground.Step();
    const double after = ground.velocity().z();
    if (after > 0.0) {
      // The step of the impact begins with the weight's part of it.
      return Compare("restitution 0.5 after a fall of 0.1 m", "1", kRestitution, -after / before,
                     0.01);
    }
    before = after;
  }
  return Compare("restitution 0.5 after a fall of 0.1 m", "1", kRestitution, 0.0, 0.01);
}

std::vector<PhysicsCheck> CheckRest(const UprightCylinder& body) {
  Ground ground(body, 0.0, 1.0);
  ground.Step(100);
  const Vector3d start = ground.place();
  double drift = 0.0, tilt = 0.0;
  for (int step = 0; step < 60000; ++step) {
    ground.Step();
    drift = std::max(drift, (ground.place() - start).norm());
    tilt = std::max(tilt, ground.tilt());
  }
  return {Compare("drift within 60 s of rest", "m", 0.0, drift, 1e-4),
          Compare("tilt within 60 s of rest", "rad", 0.0, tilt, 1e-3)};
}

}  // namespace

std::vector<PhysicsCheck> RunPhysicsChecks(const UprightCylinder& body,
                                           const std::string& body_name) {
  std::vector<PhysicsCheck> checks{CheckTipping(body), CheckSliding(body), CheckSuddenStop(body),
                                   CheckPulse(body, 1.05, 0.05)};
  for (const double x : {1.2, 1.5, 2.0, 3.0, 5.0}) checks.push_back(CheckPulse(body, x, 0.02));
  checks.push_back(CheckFreeFall(body));
  checks.push_back(CheckPrecession(body));
  checks.push_back(CheckStoppingDistance(body));
  checks.push_back(CheckRestitution(body));
  for (PhysicsCheck& check : CheckRest(body)) checks.push_back(std::move(check));
  for (PhysicsCheck& check : checks) check.name += ", " + body_name;
  return checks;
}

}  // namespace hires::physics
