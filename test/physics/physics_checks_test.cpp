#include "hires/physics/physics_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hires/physics/physics_world.h"
#include "support/planar_oracle.h"
#include "support/rounds.h"

namespace hires::physics::physics_checks_test {
namespace {

void ExpectAllPass(const UprightCylinder& body, const char* name) {
  PhysicsWorld::TakeSolverMessages();
  const std::vector<PhysicsCheck> checks = RunPhysicsChecks(body, name);
  EXPECT_EQ(checks.size(), 15u);
  for (const PhysicsCheck& check : checks) {
    EXPECT_TRUE(check.passed()) << check.name << ": expected " << check.expected << " "
                                << check.unit << ", measured " << check.measured << ", error "
                                << check.error << ", tolerance " << check.tolerance;
    EXPECT_NE(check.name.find(name), std::string::npos);
  }
  EXPECT_TRUE(PhysicsWorld::TakeSolverMessages().empty());
}

TEST(PhysicsChecksTest, MillOfTheThesisTextObeysTheory) {
  HIRES_LONG_CASE();
  ExpectAllPass({0.037, 0.274, 0.140}, "mill of the text");
}

TEST(PhysicsChecksTest, MillOfTheAppendixObeysTheory) {
  HIRES_LONG_CASE();
  ExpectAllPass({0.035, 0.300, 0.500}, "mill of the appendix");
}

TEST(PhysicsChecksTest, MillOfTheRepositoryObeysTheory) {
  ExpectAllPass({0.037, 0.274, 0.350}, "mill of the repository");
}

TEST(PhysicsChecksTest, FrictionObeysTheory) {
  PhysicsWorld::TakeSolverMessages();
  for (const PhysicsCheck& check : RunFrictionChecks()) {
    EXPECT_TRUE(check.passed()) << check.name << ": expected " << check.expected << ", measured "
                                << check.measured << " " << check.unit << ", error " << check.error;
  }
  EXPECT_TRUE(PhysicsWorld::TakeSolverMessages().empty());
}

TEST(PhysicsChecksTest, SpeedsWithoutAClosedFormAreThoseOfThePlanarOracle) {
  for (const SlipAndTip& one : SlipAndTipCases()) {
    const double r = one.body.radius, h = one.body.height;
    const test_support::PlanarBody body{r, h / 2, (3.0 * r * r + h * h) / 12.0};
    const double speed = test_support::PlanarLimit(body, one.friction, HUGE_VAL,
                                                   test_support::SuddenStop, 0.05, 4.0, 1e-4);
    EXPECT_NEAR(one.speed, speed, 1e-3 * speed) << "friction " << one.friction << ", radius " << r;
  }
}

TEST(PhysicsChecksTest, EveryShapeRestsOnEveryPlateAndABoxTipsAsTheorySays) {
  PhysicsWorld::TakeSolverMessages();
  for (const PhysicsCheck& check : RunShapeChecks()) {
    EXPECT_TRUE(check.passed()) << check.name << ": measured " << check.measured << " "
                                << check.unit;
  }
  EXPECT_TRUE(PhysicsWorld::TakeSolverMessages().empty());
}

TEST(PhysicsChecksTest, ErrorBeyondToleranceFails) {
  PhysicsCheck check;
  check.tolerance = 0.01;
  check.error = 0.0101;
  EXPECT_FALSE(check.passed());
  check.error = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(check.passed());
}

}  // namespace
}  // namespace hires::physics::physics_checks_test
