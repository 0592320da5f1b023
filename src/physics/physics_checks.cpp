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
constexpr int kHalvings = 14;   // of the bracket around a boundary: 6e-5 of its width
constexpr int kSliding = 1000;  // steps after which a body that only slides tips no more
constexpr double kTolerance = 0.03;
constexpr double kSlope = 0.01;  // [rad] several times that of a floor uneven by 0.0005 m

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

  /// All leans back by `slope` [rad], looked at in the ground's own axes: forward is uphill.
  void Lean(double slope) {
    world_.SetExtraAcceleration(
        kGravity * ((1.0 - std::cos(slope)) * Vector3d::UnitZ() - std::sin(slope) * direction_));
  }

  /// Ground and body turn together from now on, the body `arm` [m] from the axis.
  void TurnTogether(double arm, double rate) {
    BodyState ground, body = world_.GetState(body_);
    ground.V_WB.angular = body.V_WB.angular = rate * Vector3d::UnitZ();
    body.X_WB.translation += arm * direction_;
    body.V_WB.linear = body.V_WB.angular.cross(body.X_WB.translation);
    world_.SetMotion(ground_, ground);
    world_.SetState(body_, body);
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
  double tilt_rate() const {  ///< [rad/s] forward
    return world_.GetState(body_).V_WB.angular.dot(Vector3d::UnitZ().cross(direction_));
  }
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
    if (largest < 0.005 && step > kSliding) return false;
  }
  return false;
}

/// Whether the body tips or slides within 1 s.
bool Gives(Ground* ground, double acceleration) {
  const double start = ground->place().head<2>().norm();
  for (int step = 1; step <= 1000; ++step) {
    ground->SetGroundSpeed(acceleration * step * kTimeStep);
    ground->Step();
    if (ground->tilt() > 0.05) return true;
    if (std::abs(ground->place().head<2>().norm() - start) > 0.001) return true;
  }
  return false;
}

bool GivesAt(const UprightCylinder& body, double friction, double slope, double heading,
             double acceleration) {
  Ground ground(body, heading, friction);
  ground.Lean(slope);
  ground.Step(100);
  return Gives(&ground, acceleration);
}

bool GivesOnTurningGround(const UprightCylinder& body, double friction, double arm, double heading,
                          double rate) {
  Ground ground(body, heading, friction);
  ground.TurnTogether(arm, rate);
  return Gives(&ground, 0.0);
}

bool TopplesOnSuddenStop(const UprightCylinder& body, double friction, double heading,
                         double speed) {
  Ground ground(body, heading, friction);
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

/// The onset that is farthest from `expected`, over 36 headings; each is looked for only beyond
/// those of the headings before.
PhysicsCheck CheckOnset(std::string name, std::string unit, double expected, double tolerance,
                        const std::function<bool(double heading, double value)>& happens) {
  const auto onset = [&](double lower, double upper, double heading) {
    return Onset(lower, upper, [&](double value) { return happens(heading, value); });
  };
  double least = onset(0.8 * expected, 1.2 * expected, 0.0), most = least;
  for (int i = 1; i < kHeadings; ++i) {
    const double heading = Heading(i), slack = 1e-4 * expected;
    if (happens(heading, least - slack)) least = onset(0.8 * expected, least, heading);
    if (!happens(heading, most + slack)) most = onset(most, 1.2 * expected, heading);
  }
  const bool is_low = std::abs(least - expected) > std::abs(most - expected);
  return Compare(std::move(name), std::move(unit), expected, is_low ? least : most, tolerance);
}

/// A cylinder whose centre of mass is 0.1 m high. @param ratio  b/c, radius over that height
UprightCylinder CylinderOf(double ratio) { return {0.1 * ratio, 0.2, 0.3}; }

double RatioOf(const UprightCylinder& body) { return 2.0 * body.radius / body.height; }

/// It slides from a = mu g or tips from a = g b / c, whichever is less; uphill from less.
PhysicsCheck CheckOnsetAt(const UprightCylinder& body, double friction, double slope,
                          double tolerance) {
  const double ratio = RatioOf(body);
  const double expected =
      kGravity * (std::min(ratio, friction) * std::cos(slope) - std::sin(slope));
  return CheckOnset(fmt::format("onset of {}, friction {}, b/c {:.2g}, slope {}, 36 headings",
                                ratio < friction ? "tipping" : "sliding", friction, ratio, slope),
                    "m/s^2", expected, tolerance, [&](double heading, double a) {
                      return GivesAt(body, friction, slope, heading, a);
                    });
}

/// @param expected  [m/s] from where it topples, whether it slips or not
PhysicsCheck CheckSuddenStop(const UprightCylinder& body, double friction, double expected) {
  return CheckOnset(fmt::format("toppling by a sudden stop, friction {}, b/c {:.2g}, 36 headings",
                                friction, RatioOf(body)),
                    "m/s", expected, kTolerance, [&](double heading, double speed) {
                      return TopplesOnSuddenStop(body, friction, heading, speed);
                    });
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

/// The onset on ground that turns at 1 rad/s, by w^2 R.
PhysicsCheck CheckTurning(double ratio, double friction) {
  const double arm = kGravity * std::min(ratio, friction);
  return CheckOnset(fmt::format("onset of {}, friction {}, b/c {}, turning {:.3f} m from the axis",
                                ratio < friction ? "tipping" : "sliding", friction, ratio, arm),
                    "rad/s", 1.0, kTolerance, [&](double heading, double rate) {
                      return GivesOnTurningGround(CylinderOf(ratio), friction, arm, heading, rate);
                    });
}

PhysicsCheck CheckStoppingDistance(const UprightCylinder& body, double friction, double speed,
                                   double tolerance) {
  const double expected = speed * speed / (2.0 * friction * kGravity);
  const double measured = Worst(kHeadings, expected, [&](double heading) {
    Ground ground(body, heading, friction);
    ground.Step(100);
    const Vector3d start = ground.place();
    ground.SetBodySpeed(speed);
    ground.Step(1200);
    return (ground.place() - start).head<2>().norm();
  });
  return Compare(
      fmt::format("stopping distance from {:.3g} m/s, friction {}, 36 headings", speed, friction),
      "m", expected, measured, tolerance);
}

/// A body that slides on while it tips leans on its front edge with N = m g / (1 - m b (mu c - b) /
/// I) and tips with N (mu c - b) / I, I about its center of mass.
PhysicsCheck CheckLeaningEdge(double ratio, double friction) {
  constexpr int kSteps = 10;
  const UprightCylinder body = CylinderOf(ratio);
  const double b = body.radius, c = body.height / 2, gyration = (3.0 * b * b + 4.0 * c * c) / 12.0;
  const double arm = (friction * c - b) / gyration;
  const double expected = kGravity * arm / (1.0 - b * arm);
  const double measured = Worst(kHeadings, expected, [&](double heading) {
    Ground ground(body, heading, friction);
    ground.Step(100);
    ground.SetBodySpeed(2.0);
    ground.Step(kSteps);
    return ground.tilt_rate() / (kSteps * kTimeStep);
  });
  return Compare(fmt::format("tipping of a sliding body, friction {}, b/c {}", friction, ratio),
                 "rad/s^2", expected, measured, kTolerance);
}

}  // namespace

const std::vector<SlipAndTip>& SlipAndTipCases() {
  static const std::vector<SlipAndTip> cases{
      {{0.033, 0.2, 0.5}, 0.36, 0.6368}, {{0.033, 0.2, 0.5}, 0.4, 0.5331},
      {{0.033, 0.2, 0.5}, 0.55, 0.4413}, {{0.033, 0.2, 0.5}, 0.8, 0.4092},
      {{0.01, 0.2, 0.5}, 0.2, 0.1276},   {{0.05, 0.2, 0.5}, 0.6, 0.8246},
      {{0.07, 0.2, 0.5}, 1.0, 1.0201}};
  return cases;
}

std::vector<PhysicsCheck> RunFrictionChecks() {
  const UprightCylinder wide = CylinderOf(2.0);
  std::vector<PhysicsCheck> checks{
      CheckOnsetAt(wide, 0.1, kSlope, kTolerance),
      CheckOnsetAt(CylinderOf(0.33), kNoSlipFriction, kSlope, kTolerance), CheckTurning(2.0, 0.05),
      CheckTurning(0.1, 0.8)};
  for (const double friction : {0.02, 0.1, 0.5, 1.5}) {
    checks.push_back(CheckOnsetAt(wide, friction, 0.0, kTolerance));
    const double speed = std::sqrt(0.2 * friction * kGravity);  // it slides for 0.1 m
    checks.push_back(CheckStoppingDistance(wide, friction, speed, kTolerance));
  }
  for (const double ratio : {0.1, 0.5, 1.0, 2.0})
    checks.push_back(CheckOnsetAt(CylinderOf(ratio), kNoSlipFriction, 0.0, kTolerance));
  for (const auto& [ratio, friction] :
       {std::pair(0.1, 0.2), std::pair(0.33, 0.4), std::pair(0.5, 0.9), std::pair(1.0, 1.2)}) {
    checks.push_back(CheckLeaningEdge(ratio, friction));
  }
  for (const double ratio : {0.2, 0.5, 1.0}) {
    const UprightCylinder body = CylinderOf(ratio);
    const double speed = SuddenStopTopplingSpeed(body, kGravity);
    checks.push_back(CheckSuddenStop(body, kNoSlipFriction, speed));
  }
  for (const SlipAndTip& one : SlipAndTipCases()) {
    checks.push_back(CheckSuddenStop(one.body, one.friction, one.speed));
    checks.back().remark = "expected: planar solver of the tests, no closed form";
  }
  return checks;
}

std::vector<PhysicsCheck> RunPhysicsChecks(const UprightCylinder& body,
                                           const std::string& body_name) {
  std::vector<PhysicsCheck> checks{
      CheckOnsetAt(body, kNoSlipFriction, 0.0, 0.01),
      CheckOnsetAt(body, kSlidingFriction, 0.0, 0.01),
      CheckSuddenStop(body, kNoSlipFriction, SuddenStopTopplingSpeed(body, kGravity)),
      CheckPulse(body, 1.05, 0.05)};
  checks[0].name = "onset of tipping, 36 headings";  // names by which results are published
  checks[1].name = "onset of sliding, friction 0.2, 36 headings";
  checks[2].name = "toppling by a sudden stop, friction 3, 36 headings";
  for (const double x : {1.2, 1.5, 2.0, 3.0, 5.0}) checks.push_back(CheckPulse(body, x, 0.02));
  checks.push_back(CheckFreeFall(body));
  checks.push_back(CheckPrecession(body));
  checks.push_back(CheckStoppingDistance(body, kSlidingFriction, 1.0, 0.01));
  checks.push_back(CheckRestitution(body));
  for (PhysicsCheck& check : CheckRest(body)) checks.push_back(std::move(check));
  for (PhysicsCheck& check : checks) check.name += ", " + body_name;
  return checks;
}

}  // namespace hires::physics
