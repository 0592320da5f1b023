// What stands on something that does not move stays where it is, whatever both are and however they
// are turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hires/base/rng.h"
#include "physics/carriers.h"
#include "support/rounds.h"

namespace hires::physics::resting_test {
namespace {

using Eigen::Vector3d;
using test_support::AddCarrier;
using test_support::Carried;
using test_support::Carrier;
using test_support::Drawn;
using test_support::DrawThing;
using test_support::DrawYaw;
using test_support::Thing;

constexpr int kSteps = 200;
constexpr double kMoved = 1e-3;  // [m]

constexpr double kMass = 0.3;

struct Case {
  Thing thing;
  Carrier carrier;
};

class RestingTest : public testing::TestWithParam<Case> {};

TEST_P(RestingTest, StaysWhereItIs) {
  const base::Rng seed(2026);
  int num_moved = 0;
  double farthest = 0.0;
  const int num_truths = hires::test_support::Rounds(1000);
  for (int i = 0; i < num_truths; ++i) {
    base::Rng rng = seed.Fork(i);
    Carried scene;
    AddCarrier(GetParam().carrier, &rng, &scene);
    const Drawn thing = DrawThing(GetParam().thing, &rng);
    const double yaw = DrawYaw(&rng);
    const BodyId body = scene.Put(thing, kMass, yaw, rng.Uniform(0.2, 1.0));
    const Vector3d start = scene.world.GetState(body).X_WB.translation;
    double moved = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      scene.world.Step();
      moved = std::max(moved, (scene.world.GetState(body).X_WB.translation - start).norm());
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

INSTANTIATE_TEST_SUITE_P(All, RestingTest, testing::ValuesIn(AllCases()), [](const auto& info) {
  return NameOf(info.param.thing) + "On" + NameOf(info.param.carrier);
});

}  // namespace
}  // namespace hires::physics::resting_test
