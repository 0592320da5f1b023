#include "physics/contact_solver.h"

#include <gtest/gtest.h>
#include <ode/ode.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "hires/base/rng.h"
#include "physics/ode_session.h"

namespace hires::physics::contact_solver_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTimeStep = 0.001, kCfm = 1e-8, kSoftness = kCfm / kTimeStep;

SolverBody MakeBody(double mass, const Vector3d& place, const Vector3d& velocity) {
  SolverBody body;
  body.mass = mass;
  body.inertia = 1e-3 * mass * Matrix3d::Identity();
  body.p_WC = place;
  body.v = velocity;
  body.w.setZero();
  return body;
}

SolverContact Below(const Vector3d& position, int body, int other, double friction) {
  SolverContact contact;
  contact.position = position;
  contact.normal = Vector3d::UnitZ();
  contact.along = Vector3d::UnitX();
  contact.across = Vector3d::UnitY();
  contact.friction = friction;
  contact.slips = true;  // as ODE takes it
  contact.body = body;
  contact.other = other;
  return contact;
}

/// Four corners of a square of 0.1 m.
void AddSquare(double z, int body, int other, double friction,
               std::vector<SolverContact>* contacts) {
  for (const double x : {-0.05, 0.05}) {
    for (const double y : {-0.05, 0.05}) {
      contacts->push_back(Below({x, y, z}, body, other, friction));
    }
  }
}

TEST(ContactSolverTest, EachBodyOfAPileCarriesWhatIsAbove) {
  const Vector3d falling(0.0, 0.0, -0.00981);
  std::vector<SolverBody> bodies{MakeBody(1.0, {0, 0, 0.05}, falling),
                                 MakeBody(2.0, {0, 0, 0.15}, falling),
                                 MakeBody(0.1, {0, 0, 0.25}, falling)};
  std::vector<SolverContact> contacts;
  for (int i = 0; i < 3; ++i) AddSquare(0.1 * i, i, i - 1, 0.5, &contacts);
  ASSERT_TRUE(SolveContacts(contacts, kSoftness, &bodies));
  for (const SolverBody& body : bodies) {
    EXPECT_NEAR(body.impulse.z(), 0.00981 * body.mass, 1e-6);
    EXPECT_LT(body.impulse.head<2>().norm(), 1e-12);
    EXPECT_LT(body.turning.norm(), 1e-12);
  }
}

TEST(ContactSolverTest, FrictionEndsAtItsBound) {
  for (const double speed : {0.001, 0.01}) {  // 0.4 of the weight's impulse is 0.004 N s
    std::vector<SolverBody> bodies{MakeBody(1.0, {0, 0, 0.01}, {speed, 0.0, -0.01})};
    std::vector<SolverContact> contacts;
    AddSquare(0.0, 0, -1, 0.4, &contacts);
    ASSERT_TRUE(SolveContacts(contacts, kSoftness, &bodies));
    EXPECT_NEAR(bodies[0].impulse.x(), -std::min(speed, 0.004), 1e-6);
  }
}

TEST(ContactSolverTest, WhatIsHeldPushesAndIsNotPushed) {
  std::vector<SolverBody> bodies{MakeBody(0.0, {0, 0, 0.15}, {0.0, 0.0, -0.5}),
                                 MakeBody(1.0, {0, 0, 0.05}, Vector3d::Zero())};
  std::vector<SolverContact> contacts;
  AddSquare(0.1, 0, 1, 0.0, &contacts);
  ASSERT_TRUE(SolveContacts(contacts, kSoftness, &bodies));
  EXPECT_NEAR(bodies[1].impulse.z(), -0.5, 1e-5);
}

TEST(ContactSolverTest, FrictionThatSticksIsBoundedAlikeInAllDirections) {
  for (int i = 0; i < 16; ++i) {
    const Vector3d along(std::cos(0.4 * i), std::sin(0.4 * i), 0.0);
    for (const double speed : {0.0039, 0.0041}) {
      const Vector3d velocity = speed * along - 0.01 * Vector3d::UnitZ();
      std::vector<SolverBody> bodies{MakeBody(1.0, {0, 0, 0.01}, velocity)};
      std::vector<SolverContact> contacts;
      AddSquare(0.0, 0, -1, 0.4, &contacts);
      for (SolverContact& contact : contacts) contact.slips = false;
      ASSERT_TRUE(SolveContacts(contacts, kSoftness, &bodies));
      EXPECT_LT((bodies[0].impulse.head<2>() + std::min(speed, 0.004) * along.head<2>()).norm(),
                1e-6)
          << i;
    }
  }
}

/// Velocities that ODE gives the bodies; empty where its solver gives up.
std::vector<Vector3d> StepOfOde(const std::vector<SolverBody>& bodies,
                                const std::vector<SolverContact>& contacts) {
  dWorldID world = dWorldCreate();
  dJointGroupID joints = dJointGroupCreate(0);
  dWorldSetCFM(world, kCfm);
  std::vector<dBodyID> made;
  for (const SolverBody& body : bodies) {
    const dBodyID ode = dBodyCreate(world);
    dMass mass;
    dMassSetParameters(&mass, body.mass, 0, 0, 0, body.inertia(0, 0), body.inertia(1, 1),
                       body.inertia(2, 2), 0, 0, 0);
    dBodySetMass(ode, &mass);
    dBodySetGyroscopicMode(ode, 0);
    dBodySetPosition(ode, body.p_WC.x(), body.p_WC.y(), body.p_WC.z());
    dBodySetLinearVel(ode, body.v.x(), body.v.y(), body.v.z());
    dBodySetAngularVel(ode, body.w.x(), body.w.y(), body.w.z());
    made.push_back(ode);
  }
  for (const SolverContact& contact : contacts) {
    dContact at{};
    at.surface.mode = dContactFDir1 | dContactApprox1;
    at.surface.mu = contact.friction;
    for (int i = 0; i < 3; ++i) {
      at.geom.pos[i] = contact.position[i];
      at.geom.normal[i] = contact.normal[i];
      at.fdir1[i] = contact.along[i];
    }
    const dJointID joint = dJointCreateContact(world, joints, &at);
    dJointAttach(joint, made[contact.body], contact.other < 0 ? nullptr : made[contact.other]);
  }
  dWorldStep(world, kTimeStep);
  std::vector<Vector3d> velocities;
  for (const dBodyID body : made) {
    const dReal *v = dBodyGetLinearVel(body), *w = dBodyGetAngularVel(body);
    velocities.emplace_back(v[0], v[1], v[2]);
    velocities.emplace_back(w[0], w[1], w[2]);
  }
  dJointGroupDestroy(joints);
  dWorldDestroy(world);
  if (!TakeOdeMessages().empty()) velocities.clear();
  return velocities;
}

TEST(ContactSolverTest, AgreesWithOdeWhereThatFindsASolution) {
  EnsureOdeIsReady();
  const base::Rng seed(21);
  int num_compared = 0, num_given_up = 0;
  for (int i = 0; i < 2000; ++i) {
    base::Rng rng = seed.Fork(i);
    const auto draw = [&](double most) { return rng.Uniform(-most, most); };
    std::vector<SolverBody> bodies;
    std::vector<SolverContact> contacts;
    for (int k = 0; k < 3; ++k) {
      bodies.push_back(MakeBody(rng.Uniform(0.1, 2.0), {0.0, 0.0, 0.05 + 0.1 * k},
                                {draw(0.05), draw(0.05), draw(0.02) - 0.01}));
      bodies.back().w = {draw(0.2), draw(0.2), draw(0.2)};
      const double friction = rng.Uniform(0.0, 1.0);
      for (int j = 0; j < 5; ++j) {
        contacts.push_back(Below({draw(0.05), draw(0.05), 0.1 * k}, k, k - 1, friction));
      }
    }
    const std::vector<Vector3d> expected = StepOfOde(bodies, contacts);
    ASSERT_TRUE(SolveContacts(contacts, kSoftness, &bodies)) << "pile " << i;
    if (expected.empty()) {
      ++num_given_up;
      continue;
    }
    ++num_compared;
    for (int k = 0; k < 3; ++k) {
      const SolverBody& body = bodies[k];
      EXPECT_LT((body.v + body.impulse / body.mass - expected[2 * k]).norm(), 1e-7) << i;
      EXPECT_LT((body.w + body.inertia.inverse() * body.turning - expected[2 * k + 1]).norm(), 1e-6)
          << i;
    }
  }
  EXPECT_GT(num_compared, 500) << num_given_up << " given up";
}

}  // namespace
}  // namespace hires::physics::contact_solver_test
