#include "hires/sensing/tray_objects.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/geometry/angles.h"
#include "hires/perception/line_of_sight.h"
#include "support/sight_scenes.h"

namespace hires::sensing::tray_objects_test {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using test_support::At;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// As on the PR2: the laser stands behind the tray, which is 0.25 m deep and 0.64 m wide, and 0.02 m
// above it. The tray's frame is the map of the small world that beams are cast in, lifted so that
// its floor does not matter.
const Pose3 kLaser = At(-0.1, 0.0, 0.02);
const geometry::Polygon kTray{{-0.1, -0.32}, {0.15, -0.32}, {0.15, 0.32}, {-0.1, 0.32}};

std::shared_ptr<const perception::Surroundings> Things() {
  world::World world;
  test_support::AddModel(&world, test_support::Mill("mug", 0.1, 0.037));
  test_support::AddModel(&world, test_support::Mill("mill", 0.27, 0.025));
  world::ObjectModel box = test_support::Mill("box");
  box.collisions = {
      test_support::Shape("box", geometry::Box{{0.06, 0.09, 0.12}}, {0.0, 0.0, 0.06})};
  test_support::AddModel(&world, box);
  world::ObjectModel saucer = test_support::Mill("saucer", 0.01, 0.06);
  test_support::AddModel(&world, saucer);
  return std::make_shared<const perception::Surroundings>(world);
}

/// 640 beams with the noise of a Hokuyo.
robot::ScanReading Scan(const std::shared_ptr<const perception::Surroundings>& models,
                        const std::vector<world::ObjectState>& objects, double noise,
                        base::Rng* rng) {
  const perception::LineOfSight sight(models, objects);
  robot::ScanReading scan{-1.4, 2.8 / 639, 0.04, {}};
  for (int i = 0; i < 640; ++i) {
    const double angle = scan.angle_min + i * scan.angle_increment;
    const double range = sight.Cast(kLaser.translation, {std::cos(angle), std::sin(angle), 0.0});
    scan.ranges.push_back(static_cast<float>(range + rng->Normal(0.0, noise)));
  }
  return scan;
}

class TrayObjectsTest : public ::testing::Test {
 protected:
  BelievedOnTray Believe(const world::ObjectState& object) const {
    return {object.name, object.X_MO, models_->Model(object.model).collisions};
  }
  std::vector<BelievedOnTray> Believe(const std::vector<world::ObjectState>& objects) const {
    std::vector<BelievedOnTray> believed;
    for (const world::ObjectState& object : objects) believed.push_back(Believe(object));
    return believed;
  }
  TrayReading Read(const std::vector<world::ObjectState>& truth,
                   const std::vector<world::ObjectState>& belief, double noise = 0.0) {
    base::Rng rng(1);
    return ReadTray(Scan(models_, truth, noise, &rng), kLaser, kTray, Believe(belief), {});
  }
  static world::ObjectState Put(const std::string& name, const std::string& model, double x,
                                double y, double yaw = 0.0) {
    return test_support::Thing(name, model, geometry::Lift({x, y, yaw}));
  }

  std::shared_ptr<const perception::Surroundings> models_ = Things();
};

TEST_F(TrayObjectsTest, ABoxIsSeenByItsSideTowardsTheLaser) {
  const auto reading = Read({Put("box1", "box", 0.05, 0.0)}, {});
  ASSERT_THAT(reading.things, SizeIs(1));
  const TrayThing& thing = reading.things[0];
  EXPECT_NEAR(thing.X_TB.x, 0.02, 0.001);
  EXPECT_NEAR(thing.X_TB.y, 0.0, 0.001);
  EXPECT_NEAR(thing.size.x(), 0.09, 0.002);
  EXPECT_NEAR(thing.size.y(), 0.0, 0.001);
  // The side of 0.09 m, 0.12 m before the laser, takes 2 atan(0.045 / 0.12) = 0.718 rad.
  EXPECT_NEAR(thing.num_beams(), 0.718 / (2.8 / 639), 2);
}

TEST_F(TrayObjectsTest, ATurnedBoxHasATurnedFootprint) {
  const auto reading = Read({Put("box1", "box", 0.05, 0.15, 0.5)}, {});
  ASSERT_THAT(reading.things, SizeIs(1));
  // Two of its sides are seen, so the footprint is whole.
  EXPECT_NEAR(reading.things[0].X_TB.x, 0.05, 0.004);
  EXPECT_NEAR(reading.things[0].X_TB.y, 0.15, 0.004);
  EXPECT_NEAR(reading.things[0].size.x(), 0.09, 0.006);
  EXPECT_NEAR(reading.things[0].size.y(), 0.06, 0.006);
  EXPECT_NEAR(std::sin(2.0 * (reading.things[0].X_TB.yaw - 0.5 - geometry::kPi / 2)), 0.0, 0.05);
}

TEST_F(TrayObjectsTest, WhatStandsWhereItIsBelievedIsInPlace) {
  const auto mug = Put("mug1", "mug", 0.07, -0.13);
  const auto reading = Read({mug}, {mug}, 0.005);
  ASSERT_THAT(reading.objects, SizeIs(1));
  EXPECT_EQ(reading.objects[0].state, TrayState::kInPlace);
  EXPECT_GT(reading.objects[0].num_beams, 30);
  EXPECT_THAT(reading.surplus, IsEmpty());
}

TEST_F(TrayObjectsTest, AnEmptyTrayHasNothingAndMissesWhatIsBelieved) {
  const auto reading = Read({}, {Put("mug1", "mug", 0.07, 0.0)});
  EXPECT_THAT(reading.things, IsEmpty());
  EXPECT_EQ(reading.objects[0].state, TrayState::kMissing);
}

TEST_F(TrayObjectsTest, AMovedMugIsFoundWhereItIs) {
  const auto reading =
      Read({Put("mug1", "mug", 0.03, 0.15)}, {Put("mug1", "mug", 0.07, 0.0)}, 0.005);
  EXPECT_EQ(reading.objects[0].state, TrayState::kMoved);
  EXPECT_NEAR(reading.objects[0].X_TO.translation.x(), 0.03, 0.005);
  EXPECT_NEAR(reading.objects[0].X_TO.translation.y(), 0.15, 0.005);
  EXPECT_THAT(reading.surplus, IsEmpty());
}

TEST_F(TrayObjectsTest, WhatNobodyKnowsOfIsSurplus) {
  const auto mug = Put("mug1", "mug", 0.05, -0.15);
  const auto reading = Read({mug, Put("mug2", "mug", 0.05, 0.15)}, {mug}, 0.005);
  EXPECT_EQ(reading.objects[0].state, TrayState::kInPlace);
  ASSERT_THAT(reading.surplus, SizeIs(1));
  EXPECT_NEAR(reading.surplus[0].X_TB.y, 0.15, 0.03);
}

TEST_F(TrayObjectsTest, ABoxThatStandsInTheMissingMugsPlaceIsNotTheMug) {
  const auto reading = Read({Put("box1", "box", 0.05, 0.15)}, {Put("mug1", "mug", 0.05, -0.15)});
  EXPECT_EQ(reading.objects[0].state, TrayState::kMissing);
  EXPECT_THAT(reading.surplus, SizeIs(1));
}

TEST_F(TrayObjectsTest, WhatStandsBehindAnotherThingOrLowerThanTheScanIsUnknown) {
  const auto box = Put("box1", "box", 0.0, 0.0);
  const auto reading =
      Read({box}, {box, Put("mill1", "mill", 0.09, 0.0), Put("saucer1", "saucer", 0.05, 0.2)});
  EXPECT_EQ(reading.objects[0].state, TrayState::kInPlace);
  EXPECT_EQ(reading.objects[1].state, TrayState::kUnknown);
  EXPECT_EQ(reading.objects[2].state, TrayState::kUnknown);
}

TEST_F(TrayObjectsTest, TwoThingsThatTouchAreToldApartByWhatIsBelieved) {
  const auto left = Put("mug1", "mug", 0.05, 0.04), right = Put("mug2", "mug", 0.05, -0.04);
  const auto reading = Read({left, right}, {left, right}, 0.005);
  EXPECT_THAT(reading.things, SizeIs(1));
  for (const TrayObject& object : reading.objects) EXPECT_EQ(object.state, TrayState::kInPlace);
}

TEST_F(TrayObjectsTest, WhatIsBesideTheTrayOrNoMeasurementIsNothing) {
  const auto beside = Read({Put("mug1", "mug", 0.21, 0.0)}, {});
  EXPECT_THAT(beside.things, IsEmpty());
  robot::ScanReading nothing{-1.4, 0.01, 0.04, std::vector<float>(280)};
  std::fill(nothing.ranges.begin(), nothing.ranges.end(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(ReadTray(nothing, kLaser, kTray, {}, {}).things, IsEmpty());
}

/// Up to three things in slots 0.17 m apart, some of which the robot knows, some of which it does
/// not, and some of which are only believed; each belief off by a few millimetres.
TEST_F(TrayObjectsTest, RandomLoadsAreReadRight) {
  const std::vector<std::string> kinds{"mug", "mill", "box"};
  int num_in_place = 0, num_surplus = 0, num_missing = 0;
  for (int seed = 0; seed < 200; ++seed) {
    base::Rng rng(seed);
    std::vector<world::ObjectState> truth, belief;
    std::vector<TrayState> wanted;
    int wanted_surplus = 0;
    for (int slot = 0; slot < 3; ++slot) {
      const auto object =
          Put("thing" + std::to_string(slot), kinds[rng.Index(3)], rng.Uniform(0.01, 0.06),
              0.17 * (slot - 1) + rng.Uniform(-0.02, 0.02), rng.Uniform(-0.3, 0.3));
      auto believed = object;
      believed.X_MO.translation +=
          Eigen::Vector3d(rng.Normal(0.0, 0.002), rng.Normal(0.0, 0.002), 0);
      const bool is_there = rng.Bernoulli(0.6), is_believed = rng.Bernoulli(0.6);
      if (is_there) truth.push_back(object);
      if (is_there && !is_believed) ++wanted_surplus;
      if (!is_believed) continue;
      belief.push_back(believed);
      wanted.push_back(is_there ? TrayState::kInPlace : TrayState::kMissing);
    }
    const auto reading =
        ReadTray(Scan(models_, truth, 0.005, &rng), kLaser, kTray, Believe(belief), {});
    ASSERT_THAT(reading.things, SizeIs(truth.size())) << "seed " << seed;
    // What is missing may be taken for a surplus thing that looks the same: either both or neither.
    int num_moved = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const TrayState state = reading.objects[i].state;
      if (state == TrayState::kMoved) {
        ++num_moved;
        ASSERT_EQ(wanted[i], TrayState::kMissing) << "seed " << seed;
        continue;
      }
      ASSERT_EQ(state, wanted[i]) << "seed " << seed << ", object " << i;
      ++(state == TrayState::kMissing ? num_missing : num_in_place);
    }
    ASSERT_EQ(static_cast<int>(reading.surplus.size()), wanted_surplus - num_moved)
        << "seed " << seed;
    num_surplus += static_cast<int>(reading.surplus.size());
  }
  EXPECT_GT(num_in_place, 100);
  EXPECT_GT(num_missing, 40);
  EXPECT_GT(num_surplus, 40);
}

TEST_F(TrayObjectsTest, ALaserThatLeansIsRefused) {
  Pose3 leaning = kLaser;
  leaning.rotation = geometry::RotationFromRpy(0.0, 0.1, 0.0);
  EXPECT_THROW(ReadTray({0.0, 0.1, 0.04, {0.1f}}, leaning, kTray, {}, {}), std::logic_error);
}

}  // namespace
}  // namespace hires::sensing::tray_objects_test
