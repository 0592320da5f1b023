#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/sensing/object_memory.h"
#include "hires/world/unknown_box.h"
#include "support/sight_scenes.h"

namespace hires::sensing::tray_memory_test {
namespace {

using geometry::Pose3;
using perception::LineOfSight;
using perception::Surroundings;
using test_support::Thing;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNoise = 0.005;  // [m] of a Hokuyo
const MemoryParams kParams;

std::shared_ptr<const robot::Robot> Pr2() {
  static const auto pr2 = std::make_shared<const robot::Robot>(
      robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"));
  return pr2;
}

/// A PR2 somewhere in an empty room, what really stands on its tray, and what it remembers of that.
class TrayMemoryTest : public testing::Test {
 protected:
  Pose3 X_ML(const std::string& link) const {
    const auto X_RL = robot::ForwardKinematics(Pr2()->model, body_.joints);
    return geometry::Lift(body_.X_MB) *
           X_RL[*Pr2()->model.FindLink(Pr2()->profile.base_link)].Inverse() *
           X_RL[*Pr2()->model.FindLink(link)];
  }
  Pose3 X_BL() const { return geometry::Lift(body_.X_MB).Inverse() * X_ML("base_tray_laser_link"); }

  /// On the tray; x and y in its frame, whose plate reaches from 0 to 0.25 and from -0.33 to 0.33.
  world::ObjectState Put(const std::string& name, double x, double y,
                         const std::string& model = "mug") const {
    return Thing(name, model, X_ML("base_tray_link") * test_support::At(x, y, 0.0002));
  }
  void Believe(const world::ObjectState& object) {
    memory_.Believe(object.name, object.model, "base_footprint",
                    geometry::Lift(body_.X_MB).Inverse() * object.X_MO);
  }
  robot::ScanReading Measure(const std::vector<world::ObjectState>& truth) {
    const LineOfSight sight(surroundings_, truth,
                            perception::ShapesOf(*Pr2(), body_.X_MB, body_.joints));
    const Pose3 X_MLaser = X_ML("base_tray_laser_link");
    robot::ScanReading scan{-1.4, 2.8 / 639, 0.08, {}};
    for (int i = 0; i < 640; ++i) {
      const double angle = scan.angle_min + i * scan.angle_increment;
      const Eigen::Vector3d ahead(std::cos(angle), std::sin(angle), 0.0);
      const double range = sight.Cast(X_MLaser.translation, X_MLaser.rotation * ahead);
      scan.ranges.push_back(
          static_cast<float>(std::max(range + rng_.Normal(0.0, kNoise), scan.range_min)));
    }
    return scan;
  }
  std::string Use(const robot::ScanReading& scan) {
    body_.time += 0.1;
    return memory_.ScanTray(body_, scan, X_BL());
  }
  void Scan(const std::vector<world::ObjectState>& truth, int times = 1) {
    for (int i = 0; i < times; ++i) ASSERT_EQ(Use(Measure(truth)), "");
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& [name, object] : memory_.objects()) names.push_back(name);
    return names;
  }
  /// [m] from where it is remembered to where it really is.
  double ErrorOf(const world::ObjectState& truth) const {
    for (const robot::SeenObject& seen : memory_.Known(body_)) {
      if (seen.name != truth.name) continue;
      return (seen.X_MO.translation - truth.X_MO.translation).norm();
    }
    return std::numeric_limits<double>::infinity();
  }

  std::shared_ptr<const Surroundings> surroundings_ = test_support::EmptyRoom();
  ObjectMemory memory_{surroundings_, Pr2(), kParams};
  BodyReading body_{10.0, {2.0, 1.0, 0.7}, Pr2()->profile.joints};
  base::Rng rng_{5};
};

TEST_F(TrayMemoryTest, WhatIsSaidToStandThereIsKnownToBeThereAndWhere) {
  const auto mug = Put("mug1", 0.17, 0.13);
  Believe(Put("mug1", 0.177, 0.124));
  ASSERT_GT(ErrorOf(mug), 0.009);
  EXPECT_FALSE(memory_.objects().at("mug1").is_observed);
  Scan({mug}, 20);
  EXPECT_TRUE(memory_.objects().at("mug1").is_observed);
  EXPECT_LT(ErrorOf(mug), 0.005);
  EXPECT_EQ(memory_.objects().at("mug1").time, 0.0) << "a scan is no sight";
}

TEST_F(TrayMemoryTest, WhatMovesOnTheTrayIsFollowed) {
  Believe(Put("mug1", 0.15, 0.0));
  const auto there = Put("mug1", 0.12, -0.16);
  Scan({there});
  EXPECT_LT(ErrorOf(there), 0.01);
  body_.X_MB = {-3.0, 4.0, -1.0};  // it rides along
  EXPECT_LT(ErrorOf(Put("mug1", 0.12, -0.16)), 0.01);
}

TEST_F(TrayMemoryTest, WhatIsGoneHasVanishedAfterSeveralScansInARow) {
  const auto mug = Put("mug1", 0.15, 0.0);
  Believe(mug);
  Scan({mug}, 3);
  Scan({}, kParams.scans_to_vanish - 1);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  Scan({mug});  // the count begins again
  Scan({}, kParams.scans_to_vanish - 1);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  Scan({});
  EXPECT_THAT(Names(), IsEmpty());
  EXPECT_THAT(memory_.Vanished(), ElementsAre("mug1"));
  Believe(mug);
  EXPECT_THAT(Names(), IsEmpty()) << "hearsay weighs less than what was seen";
}

TEST_F(TrayMemoryTest, OfSeveralTheOneThatFellIsGone) {
  const auto left = Put("mug1", 0.15, 0.15), middle = Put("mug2", 0.19, 0.0),
             right = Put("mug3", 0.15, -0.15);
  for (const auto& mug : {left, middle, right}) Believe(mug);
  Scan({left, middle, right}, 10);
  Scan({left, right}, 10);
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug3"));
  EXPECT_THAT(memory_.Vanished(), ElementsAre("mug2"));
  EXPECT_LT(ErrorOf(left), 0.003);
  EXPECT_LT(ErrorOf(right), 0.003);
}

TEST_F(TrayMemoryTest, NothingIsConcludedOfWhatIsHidden) {
  const auto jug = Put("jug1", 0.10, 0.0, "jug"), mug = Put("mug1", 0.21, 0.0);
  Believe(jug);
  Believe(mug);
  Scan({jug}, 30);
  EXPECT_THAT(Names(), ElementsAre("jug1", "mug1"));
  EXPECT_LT(ErrorOf(mug), 1e-9);
}

TEST_F(TrayMemoryTest, WhatNobodyKnowsGetsNameAndBoxAndGoesAgain) {
  const auto mug = Put("mug1", 0.15, 0.15), other = Put("other", 0.14, -0.12);
  Believe(mug);
  Scan({mug, other}, kParams.scans_to_appear - 1);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  Scan({mug, other});
  ASSERT_THAT(Names(), ElementsAre("mug1", "unknown1"));
  const RememberedObject& unknown = memory_.objects().at("unknown1");
  EXPECT_EQ(unknown.link, "base_footprint");
  const Eigen::Vector3d size = world::SizeOfUnknownBox(unknown.model);
  EXPECT_EQ(size.z(), ObjectMemory::kHeightOnTray);
  const Eigen::Vector3d p_U =
      (X_ML("base_footprint") * unknown.X_LO).Inverse() * other.X_MO.translation;
  EXPECT_LT((p_U.head<2>().array().abs() + 0.03 - size.head<2>().array() / 2).maxCoeff(), 0.0)
      << "most of the mug, of radius 0.04, is in it: " << p_U.transpose() << " in "
      << unknown.model;
  Scan({mug, other}, 60);
  EXPECT_THAT(Names(), ElementsAre("mug1", "unknown1"));
  Scan({mug}, kParams.scans_to_vanish);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_THAT(memory_.Vanished(), ElementsAre("unknown1"));
}

TEST_F(TrayMemoryTest, AThingThatIsThereForAMomentIsNothing) {
  for (int i = 0; i < 4; ++i) {
    Scan({Put("other", 0.14, -0.12)}, kParams.scans_to_appear - 1);
    Scan({});
  }
  EXPECT_THAT(Names(), IsEmpty());
}

TEST_F(TrayMemoryTest, RandomLoadsStayWhatTheyAre) {
  double sum = 0.0;
  int count = 0;
  for (int seed = 0; seed < 20; ++seed) {
    base::Rng rng(seed);
    memory_ = ObjectMemory(surroundings_, Pr2(), kParams);
    std::vector<world::ObjectState> truth;
    for (int slot = 0; slot < 3; ++slot) {
      if (!rng.Bernoulli(0.7)) continue;
      truth.push_back(Put("thing" + std::to_string(slot), rng.Uniform(0.15, 0.19),
                          0.17 * (slot - 1) + rng.Uniform(-0.02, 0.02),
                          rng.Bernoulli(0.5) ? "mug" : "jug"));
      auto believed = truth.back();
      believed.X_MO.translation += Eigen::Vector3d(rng.Normal(0, 0.004), rng.Normal(0, 0.004), 0);
      Believe(believed);
    }
    Scan(truth, 40);
    ASSERT_EQ(Names().size(), truth.size()) << "seed " << seed;
    EXPECT_THAT(memory_.Vanished(), IsEmpty()) << "seed " << seed;
    for (const auto& object : truth) {
      sum += ErrorOf(object);
      ++count;
    }
  }
  ASSERT_GT(count, 30);
  EXPECT_LT(sum / count, 0.004);
}

TEST_F(TrayMemoryTest, ALaserThatMeasuresNothingSaysNothing) {
  Believe(Put("mug1", 0.15, 0.0));
  robot::ScanReading scan = Measure({});
  for (const float range : {std::numeric_limits<float>::quiet_NaN(), 0.0F, -1.0F}) {
    std::fill(scan.ranges.begin(), scan.ranges.end(), range);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(Use(scan), "");
    EXPECT_THAT(Names(), ElementsAre("mug1")) << range;
  }
  std::fill(scan.ranges.begin(), scan.ranges.end(), std::numeric_limits<float>::infinity());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(Use(scan), "");
  EXPECT_THAT(Names(), IsEmpty()) << "an infinite range says that nothing is there";
}

TEST_F(TrayMemoryTest, WhatTheHandHoldsOverTheTrayHidesAndIsNothingNew) {
  const auto behind = Put("mug2", 0.21, 0.0);
  auto held = Put("mug1", 0.11, 0.0);
  const std::string palm = "r_gripper_palm_link";
  memory_.Believe("mug1", "mug", palm, X_ML(palm).Inverse() * held.X_MO);
  ASSERT_TRUE(memory_.objects().at("mug1").is_held);
  Believe(behind);
  Scan({held}, 30);
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug2"));
  EXPECT_TRUE(memory_.objects().at("mug1").is_held);
}

TEST_F(TrayMemoryTest, WhatTheCameraNamesIsUnknownNoMore) {
  const auto other = Put("mug5", 0.14, -0.12);
  Scan({other}, kParams.scans_to_appear);
  ASSERT_THAT(Names(), ElementsAre("unknown1"));
  const Pose3 X_MC = perception::ViewOf(*Pr2(), body_.X_MB, body_.joints).X_MC;
  memory_.Look(body_, {{"mug5", "mug", X_MC.Inverse() * other.X_MO, 1.0}});
  EXPECT_THAT(Names(), ElementsAre("mug5"));
  Scan({other}, 40);
  EXPECT_THAT(Names(), ElementsAre("mug5"));
}

TEST_F(TrayMemoryTest, AScanOfAnotherLaserIsRefused) {
  const robot::ScanReading scan = Measure({});
  Pose3 leaning = X_BL();
  leaning.rotation = leaning.rotation * geometry::RotationFromRpy(0.0, 0.3, 0.0);
  EXPECT_THAT(memory_.ScanTray(body_, scan, leaning), HasSubstr("leans by 0.300 rad"));
  Pose3 low = X_BL();
  low.translation.z() -= 0.2;
  EXPECT_THAT(memory_.ScanTray(body_, scan, low), HasSubstr("-0.180 m above the tray"));
  auto bare = *Pr2();
  bare.profile.tray_link.clear();
  ObjectMemory memory(surroundings_, std::make_shared<const robot::Robot>(bare), kParams);
  EXPECT_THAT(memory.ScanTray(body_, scan, X_BL()), HasSubstr("has no tray"));
  EXPECT_FALSE(memory_.tray());
}

}  // namespace
}  // namespace hires::sensing::tray_memory_test
