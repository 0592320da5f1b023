// Loose bodies that stand on loose bodies: they stay where they are, and slide and tip where closed
// forms say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/physics/closed_forms.h"
#include "physics/carriers.h"
#include "support/rounds.h"

namespace hires::physics::stacks_test {
namespace {

using Eigen::Vector3d;
using test_support::AddCarrier;
using test_support::Carried;
using test_support::Carrier;
using test_support::Drawn;
using test_support::DrawThing;
using test_support::DrawYaw;
using test_support::kNumCarriers;
using test_support::MakeBox;
using test_support::MakeCan;
using test_support::NameOf;
using test_support::Thing;

constexpr int kSteps = 200;
constexpr double kMoved = 1e-3;  // [m]
constexpr double kGravity = 9.81;

enum class Lower { kBox, kCan, kMesh };

Drawn DrawLower(Lower lower, base::Rng* rng) {
  const double height = rng->Uniform(0.02, 0.1);
  if (lower == Lower::kCan) return MakeCan(0.11, height);
  return MakeBox({0.22, 0.2, height}, lower == Lower::kMesh);
}

/// From 0.02 to 2 kg, as often tenfold as half.
double DrawMass(base::Rng* rng) { return 0.02 * std::pow(100.0, rng->Uniform(0.0, 1.0)); }

struct Case {
  Thing upper;
  Lower lower;
};

class StacksTest : public testing::TestWithParam<Case> {};

/// How far any of the bodies is from where it was, at most [m].
double FarthestMove(Carried* scene, const std::vector<BodyId>& bodies) {
  std::vector<Vector3d> starts;
  for (const BodyId body : bodies) {
    starts.push_back(scene->world.GetState(body).X_WB.translation);
  }
  double moved = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    scene->world.Step();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      moved =
          std::max(moved, (scene->world.GetState(bodies[i]).X_WB.translation - starts[i]).norm());
    }
  }
  return moved;
}

TEST_P(StacksTest, StayWhereTheyAreOnEveryCarrier) {
  const base::Rng seed(2027);
  int num_moved = 0;
  double farthest = 0.0;
  const int num_truths = hires::test_support::Rounds(1000) * kNumCarriers;
  for (int i = 0; i < num_truths; ++i) {
    base::Rng rng = seed.Fork(i);
    Carried scene;
    AddCarrier(static_cast<Carrier>(i % kNumCarriers), &rng, &scene);
    std::vector<BodyId> bodies;
    for (const Drawn& thing :
         {DrawLower(GetParam().lower, &rng), DrawThing(GetParam().upper, &rng)}) {
      const double mass = DrawMass(&rng), yaw = DrawYaw(&rng);
      bodies.push_back(scene.Put(thing, mass, yaw, rng.Uniform(0.2, 1.0)));
    }
    const double moved = FarthestMove(&scene, bodies);
    farthest = std::max(farthest, moved);
    if (moved > kMoved || scene.world.broken()) ++num_moved;
  }
  EXPECT_EQ(num_moved, 0) << "of " << num_truths << "; the farthest by " << farthest << " m";
  EXPECT_TRUE(PhysicsWorld::TakeSolverMessages().empty());
}

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  for (const Thing upper : {Thing::kCube, Thing::kBook, Thing::kCan, Thing::kMeshBox}) {
    for (const Lower lower : {Lower::kBox, Lower::kCan, Lower::kMesh}) {
      cases.push_back({upper, lower});
    }
  }
  return cases;
}

std::string NameOfCase(const testing::TestParamInfo<Case>& info) {
  constexpr const char* kLowers[] = {"Box", "Can", "Mesh"};
  return NameOf(info.param.upper) + "On" + kLowers[static_cast<int>(info.param.lower)];
}

INSTANTIATE_TEST_SUITE_P(All, StacksTest, testing::ValuesIn(AllCases()), NameOfCase);

/// Two loose bodies on a plate that moves as told.
struct Pile {
  Carried scene;
  BodyId plate, lower, upper;

  Pile(const Drawn& lower_thing, const Drawn& upper_thing, double lower_friction,
       double upper_friction, double upper_yaw) {
    plate = scene.world.AddDriven({hires::test_support::MakeCollision(
                                      geometry::Box{{40.0, 40.0, 0.1}}, {0.0, 0.0, -0.05}, 3.0)},
                                  geometry::Pose3());
    lower = scene.Put(lower_thing, 0.8, 0.3, lower_friction);
    upper = scene.Put(upper_thing, 0.3, upper_yaw, upper_friction);
  }

  void Accelerate(const Vector3d& acceleration, int num_steps) {
    for (int i = 0; i < num_steps; ++i) {
      BodyState state = scene.world.GetState(plate);
      state.V_WB.linear += acceleration * 0.001;
      scene.world.SetMotion(plate, state);
      scene.world.Step();
    }
  }

  Vector3d PlaceOf(BodyId body, BodyId on) const {
    return scene.world.GetState(body).X_WB.translation - scene.world.GetState(on).X_WB.translation;
  }
  double TiltOf(BodyId body) const {
    return geometry::TiltOf(scene.world.GetState(body).X_WB.rotation);
  }
};

Vector3d Along(double heading) { return {std::cos(heading), std::sin(heading), 0.0}; }

/// How far the upper one slides on the lower one, and that on the plate [m].
struct Slides {
  double upper, lower;
};

Slides SlideAt(Pile pile, const Vector3d& acceleration) {
  pile.Accelerate(Vector3d::Zero(), 100);
  const Vector3d upper = pile.PlaceOf(pile.upper, pile.lower);
  const Vector3d lower = pile.PlaceOf(pile.lower, pile.plate);
  pile.Accelerate(acceleration, 800);
  return {(pile.PlaceOf(pile.upper, pile.lower) - upper).norm(),
          (pile.PlaceOf(pile.lower, pile.plate) - lower).norm()};
}

int DrawOf(int num, base::Rng* rng) { return static_cast<int>(rng->Uniform(0.0, num)); }

struct Drawing {
  Drawn lower, upper;
  double heading, yaw, friction;
};

Drawing DrawSliding(base::Rng* rng) {
  Drawing drawing;
  drawing.lower = DrawLower(static_cast<Lower>(DrawOf(3, rng)), rng);
  drawing.friction = rng->Uniform(0.1, 0.5);
  drawing.heading = rng->Uniform(-geometry::kPi, geometry::kPi);
  drawing.yaw = DrawYaw(rng);
  const double width = rng->Uniform(0.06, 0.1);
  // Too low to tip before it slides.
  const double height = rng->Uniform(0.3, 0.9) * width;
  const int shape = DrawOf(3, rng);
  drawing.upper =
      shape == 2 ? MakeCan(width / 2, height) : MakeBox({width, 1.2 * width, height}, shape == 1);
  return drawing;
}

TEST(StackTest, TheUpperBodySlidesAboveFrictionTimesGravityOnly) {
  const base::Rng seed(31);
  const int num_piles = hires::test_support::Rounds(400);
  for (int i = 0; i < num_piles; ++i) {
    base::Rng rng = seed.Fork(i);
    const Drawing at = DrawSliding(&rng);
    const double onset = SlidingAcceleration(at.friction, kGravity);
    const auto slide = [&](double acceleration) {
      return SlideAt(Pile(at.lower, at.upper, 3.0, at.friction, at.yaw),
                     acceleration * Along(at.heading));
    };
    const Slides below = slide(0.99 * onset), above = slide(1.01 * onset);
    EXPECT_LT(below.upper, 1e-4) << "pile " << i;
    EXPECT_GT(above.upper, 1e-3) << "pile " << i;
    EXPECT_LT(above.lower, 1e-4) << "pile " << i;
  }
}

TEST(StackTest, ThePileSlidesAsAWhole) {
  const base::Rng seed(32);
  const int num_piles = hires::test_support::Rounds(200);
  for (int i = 0; i < num_piles; ++i) {
    base::Rng rng = seed.Fork(i);
    const Drawing at = DrawSliding(&rng);
    const double onset = SlidingAcceleration(at.friction, kGravity);
    const auto slide = [&](double acceleration) {
      return SlideAt(Pile(at.lower, at.upper, at.friction, 1.0, at.yaw),
                     acceleration * Along(at.heading));
    };
    const Slides below = slide(0.99 * onset), above = slide(1.01 * onset);
    EXPECT_LT(below.lower, 1e-4) << "pile " << i;
    EXPECT_GT(above.lower, 1e-3) << "pile " << i;
    EXPECT_LT(above.upper, 1e-3) << "pile " << i;
  }
}

/// Whether the body tilts by 0.05 rad within two seconds.
bool Tips(BodyId body, const Vector3d& acceleration, Pile* pile) {
  pile->Accelerate(Vector3d::Zero(), 100);
  for (int i = 0; i < 20; ++i) {
    pile->Accelerate(acceleration, 100);
    if (pile->TiltOf(body) > 0.05) return true;
  }
  return false;
}

TEST(StackTest, TheUpperBodyTipsOverItsEdge) {
  const base::Rng seed(33);
  const int num_piles = hires::test_support::Rounds(400);
  for (int i = 0; i < num_piles; ++i) {
    base::Rng rng = seed.Fork(i);
    const Drawn lower = DrawLower(static_cast<Lower>(DrawOf(3, &rng)), &rng);
    const double width = rng.Uniform(0.03, 0.08), height = rng.Uniform(1.5, 3.0) * width;
    const double yaw = DrawYaw(&rng);
    const int shape = DrawOf(3, &rng);
    const Drawn upper =
        shape == 2 ? MakeCan(width / 2, height) : MakeBox({width, 1.2 * width, height}, shape == 1);
    // A can tips wherever it is pushed, a box over the edge that the push is square to.
    const double heading = shape == 2 ? rng.Uniform(-geometry::kPi, geometry::kPi) : yaw;
    const double onset = kGravity * width / height;
    const auto tips = [&](double acceleration) {
      Pile pile(lower, upper, 3.0, 3.0, yaw);
      return Tips(pile.upper, acceleration * Along(heading), &pile);
    };
    EXPECT_FALSE(tips(0.99 * onset)) << "pile " << i;
    EXPECT_TRUE(tips(1.01 * onset)) << "pile " << i;
  }
}

TEST(StackTest, APileOfTwoTipsAsAWhole) {
  const base::Rng seed(34);
  const int num_piles = hires::test_support::Rounds(200);
  for (int i = 0; i < num_piles; ++i) {
    base::Rng rng = seed.Fork(i);
    const double width = rng.Uniform(0.05, 0.1), height = rng.Uniform(0.6, 1.5) * width;
    const int shape = DrawOf(3, &rng);
    const Drawn half =
        shape == 2 ? MakeCan(width / 2, height) : MakeBox({width, width, height}, shape == 1);
    const auto tips = [&](double acceleration) {
      Pile pile(half, half, 3.0, 3.0, 0.3);
      return Tips(pile.lower, acceleration * Along(0.3), &pile);
    };
    // Both are alike but for their masses of 0.8 and 0.3 kg.
    const double middle = (0.8 * 0.5 + 0.3 * 1.5) / 1.1 * height;
    const double onset = kGravity * 0.5 * width / middle;
    EXPECT_FALSE(tips(0.99 * onset)) << "pile " << i;
    EXPECT_TRUE(tips(1.01 * onset)) << "pile " << i;
  }
}

}  // namespace
}  // namespace hires::physics::stacks_test
