#include "physics/contact_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "hires/base/rng.h"

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
  contact.friction = friction;
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

TEST(ContactSolverTest, EachBodyOfAPileCarriesTheOnesAbove) {
  const Vector3d falling(0.0, 0.0, -0.00981);
  std::vector<SolverBody> bodies{MakeBody(1.0, {0, 0, 0.05}, falling),
                                 MakeBody(2.0, {0, 0, 0.15}, falling),
                                 MakeBody(0.1, {0, 0, 0.25}, falling)};
  std::vector<SolverContact> contacts;
  for (int i = 0; i < 3; ++i) AddSquare(0.1 * i, i, i - 1, 0.5, &contacts);
  SolveContacts(kSoftness, &contacts, &bodies);
  for (const SolverBody& body : bodies) {
    EXPECT_NEAR(body.impulse.z(), 0.00981 * body.mass, 1e-6);
    EXPECT_LT(body.impulse.head<2>().norm(), 1e-12);
    EXPECT_LT(body.torque_impulse.norm(), 1e-12);
  }
}

TEST(ContactSolverTest, FrictionEndsAtItsBound) {
  for (const double speed : {0.001, 0.01}) {  // 0.4 of the weight's impulse is 0.004 N s
    std::vector<SolverBody> bodies{MakeBody(1.0, {0, 0, 0.01}, {speed, 0.0, -0.01})};
    std::vector<SolverContact> contacts;
    AddSquare(0.0, 0, -1, 0.4, &contacts);
    SolveContacts(kSoftness, &contacts, &bodies);
    EXPECT_NEAR(bodies[0].impulse.x(), -std::min(speed, 0.004), 1e-6);
  }
}

TEST(ContactSolverTest, HeldBodyPushesAndIsNotPushed) {
  std::vector<SolverBody> bodies{MakeBody(0.0, {0, 0, 0.15}, {0.0, 0.0, -0.5}),
                                 MakeBody(1.0, {0, 0, 0.05}, Vector3d::Zero())};
  std::vector<SolverContact> contacts;
  AddSquare(0.1, 0, 1, 0.0, &contacts);
  SolveContacts(kSoftness, &contacts, &bodies);
  EXPECT_NEAR(bodies[1].impulse.z(), -0.5, 1e-5);
}

TEST(ContactSolverTest, FrictionBoundIsTheSameInAllDirections) {
  for (int i = 0; i < 16; ++i) {
    const Vector3d along(std::cos(0.4 * i), std::sin(0.4 * i), 0.0);
    for (const double speed : {0.0039, 0.0041}) {
      const Vector3d velocity = speed * along - 0.01 * Vector3d::UnitZ();
      std::vector<SolverBody> bodies{MakeBody(1.0, {0, 0, 0.01}, velocity)};
      std::vector<SolverContact> contacts;
      AddSquare(0.0, 0, -1, 0.4, &contacts);
      SolveContacts(kSoftness, &contacts, &bodies);
      EXPECT_LT((bodies[0].impulse.head<2>() + std::min(speed, 0.004) * along.head<2>()).norm(),
                1e-6)
          << i;
    }
  }
}

/// Three bodies on one another, with five contacts each at random places.
struct Pile {
  std::vector<SolverBody> bodies;
  std::vector<SolverContact> contacts;
};

Pile DrawPile(base::Rng rng) {
  const auto draw = [&](double most) { return rng.Uniform(-most, most); };
  Pile pile;
  for (int k = 0; k < 3; ++k) {
    pile.bodies.push_back(MakeBody(rng.Uniform(0.1, 2.0), {0.0, 0.0, 0.05 + 0.1 * k},
                                   {draw(0.05), draw(0.05), draw(0.02) - 0.01}));
    pile.bodies.back().w = {draw(0.2), draw(0.2), draw(0.2)};
    const double friction = rng.Uniform(0.0, 1.0);
    for (int j = 0; j < 5; ++j) {
      pile.contacts.push_back(Below({draw(0.05), draw(0.05), 0.1 * k}, k, k - 1, friction));
    }
  }
  return pile;
}

/// A body on four points that leans, at any speed: the tall ones tip while they slide.
Pile DrawLeaning(base::Rng rng) {
  const double radius = rng.Uniform(0.01, 0.1), height = radius * rng.Uniform(0.5, 10.0);
  const double speed = rng.Uniform(0.0, 1.0) < 0.5 ? rng.Uniform(0.0, 0.05) : rng.Uniform(0.0, 1.5);
  const double heading = rng.Uniform(0.0, 6.283);
  Pile pile;
  SolverBody body = MakeBody(rng.Uniform(0.05, 2.0), {0, 0, height},
                             {speed * std::cos(heading), speed * std::sin(heading), -0.00981});
  const double I = body.mass * (radius * radius / 4 + height * height / 3);
  body.inertia = Vector3d(I, I, body.mass * radius * radius / 2).asDiagonal();
  body.w = {rng.Uniform(-0.05, 0.05), rng.Uniform(-0.05, 0.05), rng.Uniform(-2.0, 2.0)};
  pile.bodies = {body};
  const double friction = std::exp(rng.Uniform(std::log(0.02), std::log(3.0)));
  for (int i = 0; i < 5; ++i) {
    const double angle = i == 4 ? heading : 1.5708 * i;
    pile.contacts.push_back(
        Below({radius * std::cos(angle), radius * std::sin(angle), 0.0}, 0, -1, friction));
  }
  return pile;
}

Vector3d VelocityAt(const SolverBody& body, const Vector3d& position) {
  const Vector3d v = body.v + body.impulse / body.mass;
  const Vector3d w = body.w + body.inertia.inverse() * body.torque_impulse;
  return v + w.cross(position - body.p_WC);
}

/// The largest violation of the equations of contact_solver.h, as a velocity [m/s].
double LargestViolation(const Pile& pile) {
  double largest = 0.0;
  for (const SolverContact& contact : pile.contacts) {
    Vector3d u = VelocityAt(pile.bodies[contact.body], contact.position) - contact.wanted;
    if (contact.other >= 0) u -= VelocityAt(pile.bodies[contact.other], contact.position);
    u += kSoftness * contact.impulse;
    const Vector3d& n = contact.normal;
    const double p_n = n.dot(contact.impulse), u_n = n.dot(u);
    const Vector3d p_t = contact.impulse - p_n * n, u_t = u - u_n * n;
    largest = std::max(largest, p_n > 0.0 ? std::abs(u_n) : -u_n);
    const bool sticks = p_t.norm() < (1.0 - 1e-6) * contact.friction * p_n;
    const Vector3d amiss = sticks ? u_t : Vector3d(u_t + u_t.norm() * p_t.normalized());
    if (p_n > 0.0) largest = std::max(largest, amiss.norm());
  }
  return largest;
}

/// Piles whose solution violates Coulomb's law by more than 1e-5 m/s, of 2000.
int NumViolated(Pile (*draw)(base::Rng), int seed_value) {
  const base::Rng seed(seed_value);
  int num_violated = 0;
  for (int i = 0; i < 2000; ++i) {
    Pile pile = draw(seed.Fork(i));
    SolveContacts(kSoftness, &pile.contacts, &pile.bodies);
    for (const SolverContact& contact : pile.contacts) {
      const double p_n = contact.normal.dot(contact.impulse);
      EXPECT_GE(p_n, -1e-9);
      EXPECT_LE((contact.impulse - p_n * contact.normal).norm(), contact.friction * p_n + 1e-8)
          << i;
    }
    num_violated += LargestViolation(pile) > 1e-5 ? 1 : 0;
  }
  return num_violated;
}

/// Bodies that jam (high friction, spinning) and piles of random points may stay unsolved: of 2000,
/// 1 % and 5 % were. Of 3,000,000 islands of stacks_test 32 were.
TEST(ContactSolverTest, ImpulsesObeyCoulombsLaw) {
  EXPECT_LE(NumViolated(DrawLeaning, 4), 20);
  EXPECT_LE(NumViolated(DrawPile, 21), 100);
}

/// Coulomb's law with impacts can have several solutions: then the methods may find different ones.
TEST(ContactSolverTest, BothMethodsMostlyFindTheSameMotion) {
  const base::Rng seed(3);
  int num_compared = 0, num_same = 0;
  for (int i = 0; i < 1000; ++i) {
    Pile pile = DrawLeaning(seed.Fork(i));
    if (pile.contacts[0].friction > 0.6) continue;
    Pile swept = pile;
    SolveContacts(kSoftness, &pile.contacts, &pile.bodies);
    SolveContacts(kSoftness, &swept.contacts, &swept.bodies, ContactMethod::kGaussSeidel);
    if (std::max(LargestViolation(pile), LargestViolation(swept)) > 1e-6) continue;
    ++num_compared;
    const Vector3d difference = pile.bodies[0].impulse - swept.bodies[0].impulse;
    num_same += difference.norm() < 1e-4 * pile.bodies[0].mass ? 1 : 0;
  }
  EXPECT_GT(num_compared, 600);
  EXPECT_GT(num_same, 0.93 * num_compared);
}

/// A leaning body of radius b and height of its centre c that slides on its front edge tips about
/// it: N = m g / (1 - m b (mu c - b) / I) [plane rigid-body mechanics].
TEST(ContactSolverTest, SlidingOnOneEdgePressesMoreThanTheWeight) {
  const double b = 0.033, c = 0.1, friction = 0.4, I = 0.0036, g_dt = 0.00981;
  SolverBody body = MakeBody(1.0, {0.0, 0.0, c}, {0.5, 0.0, -g_dt});
  body.inertia = I * Matrix3d::Identity();
  std::vector<SolverBody> bodies{body};
  std::vector<SolverContact> contacts{Below({b, 0.0, 0.0}, 0, -1, friction)};
  SolveContacts(kSoftness, &contacts, &bodies);
  const double expected = g_dt / (1.0 - b * (friction * c - b) / I);
  EXPECT_NEAR(bodies[0].impulse.z(), expected, 1e-4 * expected);
  EXPECT_NEAR(bodies[0].impulse.x(), -friction * expected, 1e-4 * expected);
}

}  // namespace
}  // namespace hires::physics::contact_solver_test
