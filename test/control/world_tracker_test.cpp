#include "hires/control/world_tracker.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "hires/perception/camera_view.h"
#include "hires/robot/load_robot.h"
#include "support/fake_frame_tree.h"
#include "support/scenes.h"
#include "support/sight_scenes.h"

namespace hires::control::world_tracker_test {
namespace {

using hires::test_support::At;
using hires::test_support::EmptyRoom;
using sensing::ObjectEstimator;
using sensing::RobotStateEstimator;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

std::shared_ptr<const robot::Robot> Pr2() {
  static const auto pr2 = std::make_shared<const robot::Robot>(
      robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"));
  return pr2;
}

/// A PR2 whose sensors speak at 20 Hz, and a mug before it.
class WorldTrackerTest : public testing::Test {
 protected:
  explicit WorldTrackerTest(bool lockstep = true, bool sees_floor = false)
      : floor_(FloorFor(sees_floor)),
        tracker_(&state_, &objects_, floor_.get(), HeadSweep(Pr2(), {}), lockstep,
                 {[this](const sensing::RobotEstimate& now, const auto& known) {
                    known_at_.push_back(now.time);
                    names_.clear();
                    for (const robot::SeenObject& object : known) names_.push_back(object.name);
                  },
                  [](const robot::JointTrajectory&) {},
                  [this](double time, translation::ObservedWorld observed) {
                    observed_at_.push_back(time);
                    observed_ = std::move(observed);
                  },
                  [this](const std::string& why) { warnings_.push_back(why); }}) {
    joints_ = Pr2()->profile.joints;
    joints_["head_tilt_joint"] = 0.5;
  }
  std::unique_ptr<sensing::FloorWatch> FloorFor(bool sees_floor) const {
    if (!sees_floor) return nullptr;
    return std::make_unique<sensing::FloorWatch>(
        &state_, std::make_shared<world::World>(hires::test_support::Room()), Pr2(),
        sensing::FloorWatchParams{}, sensing::GroundWatchParams{});
  }
  void Tell(double time, bool with_joints = true) {
    tree_->Tell("map", "odom_combined", time, X_MO_);
    state_.OnTransforms(time);
    state_.OnOdometry(time, "odom_combined", "base_footprint", {});
    if (with_joints) state_.OnJoints(time, {joints_, {}});
    tracker_.Process();
  }
  /// A mug 1.5 m before the robot.
  void See(double time, double height = 0.7) {
    perception::Detection mug;
    mug.instance = "mug1";
    mug.label = "mug";
    mug.X_CO = perception::ViewOf(*Pr2(), {}, joints_).X_MC.Inverse() * At(1.5, 0.1, height);
    objects_.OnLook({time, Pr2()->profile.upper_body->camera_link, {mug}});
    tracker_.Process();
  }

  std::shared_ptr<hires::test_support::FakeFrameTree> tree_ =
      std::make_shared<hires::test_support::FakeFrameTree>();
  RobotStateEstimator state_{Pr2(), {"map", "odom_combined", "base_footprint"}, {}, {}, tree_};
  ObjectEstimator objects_{EmptyRoom(), Pr2(), {}, &state_};
  robot::JointPositions joints_;
  geometry::Pose3 X_MO_;
  std::vector<double> known_at_, observed_at_;
  std::vector<std::string> names_, warnings_;
  translation::ObservedWorld observed_;
  std::unique_ptr<sensing::FloorWatch> floor_;  // or null
  WorldTracker tracker_;
};

TEST_F(WorldTrackerTest, TemperaturesHoldUntilNewerOnesCome) {
  tracker_.OnTemperatures({{"mug1", 62.5}, {"mug2", 21.0}});
  tracker_.OnTemperatures({{"mug1", 60.0}});
  for (int i = 1; i <= 20; ++i) Tell(1.0 + 0.05 * i);
  EXPECT_THAT(observed_.temperatures,
              ElementsAre(testing::Pair("mug1", 60.0), testing::Pair("mug2", 21.0)));
}

TEST_F(WorldTrackerTest, OfAnObjectThatIsOnlySaidToBeSomewhereNoTemperatureIsTaken) {
  objects_.OnStated({{"mug1", "mug", "", At(1.5, 0.1, 0.7)}});
  for (int i = 1; i <= 20; ++i) Tell(1.0 + 0.05 * i);
  tracker_.OnTemperatures({{"mug1", 21.0}});
  Tell(2.05);
  EXPECT_THAT(observed_.temperatures, IsEmpty());
  See(2.1);
  for (int i = 22; i <= 24; ++i) Tell(1.0 + 0.05 * i);
  tracker_.OnTemperatures({{"mug1", 62.5}});
  Tell(2.25);
  Tell(2.3);
  EXPECT_THAT(observed_.temperatures, ElementsAre(testing::Pair("mug1", 62.5)));
}

TEST_F(WorldTrackerTest, EachMomentIsTakenOnceAndInOrderOnceItIsSettled) {
  for (int i = 1; i <= 20; ++i) Tell(1.0 + 0.05 * i);
  ASSERT_THAT(observed_at_, testing::Not(IsEmpty()));
  EXPECT_TRUE(std::is_sorted(observed_at_.begin(), observed_at_.end()));
  EXPECT_EQ(std::adjacent_find(observed_at_.begin(), observed_at_.end()), observed_at_.end());
  const double last = observed_at_.back();
  state_.OnJoints(last + 0.05, {joints_, {}});
  tracker_.Process();
  EXPECT_EQ(observed_at_.back(), last) << "where it stands then may still be told";
  Tell(last + 0.05);
  EXPECT_EQ(observed_at_.back(), last + 0.05);
  EXPECT_EQ(tracker_.num_moments(), observed_at_.size());
}

TEST_F(WorldTrackerTest, InLockstepKnownObjectsAreToldWithLooksAlone) {
  for (int i = 1; i <= 20; ++i) Tell(1.0 + 0.05 * i);
  EXPECT_THAT(known_at_, IsEmpty());
  See(2.0);
  for (int i = 21; i <= 40; ++i) Tell(1.0 + 0.05 * i);
  EXPECT_THAT(known_at_, ElementsAre(2.0));
  EXPECT_THAT(names_, ElementsAre("mug1"));
  EXPECT_EQ(tracker_.num_looks(), 1u);
  ASSERT_THAT(observed_.state.world.objects, SizeIs(1));
  EXPECT_NEAR(observed_.state.world.objects[0].X_MO.translation.x(), 1.5, 1e-6);
}

TEST_F(WorldTrackerTest, MomentsWithoutOdometryAreDroppedAndSaid) {
  state_.OnJoints(1.0, {joints_, {}});
  tracker_.Process();
  EXPECT_THAT(observed_at_, IsEmpty());
  EXPECT_EQ(tracker_.num_moments(), 0u);
}

/// Messages of each topic come in order; how topics interleave is chance where a program was held
/// up.
TEST_F(WorldTrackerTest, WhatWaitedWhileItWasHeldUpIsMadeUseOfInWhateverOrderTopicsAreRead) {
  using Word = std::function<void(double)>;
  std::vector<Word> topics{
      [this](double time) {
        tree_->Tell("map", "odom_combined", time, {});
        state_.OnTransforms(time);
      },
      [this](double time) { state_.OnOdometry(time, "odom_combined", "base_footprint", {}); },
      [this](double time) {
        state_.OnJoints(time, {joints_, {}});
      }};
  std::vector<std::size_t> order{0, 1, 2};
  double time = 1.0;
  std::size_t num_told = 0;
  do {
    for (int i = 0; i < 20; ++i, ++num_told) Tell(time += 0.05);
    const double held_up = time;
    for (const std::size_t topic : order) {
      for (int i = 1; i <= 50; ++i) {
        topics[topic](time = held_up + 0.05 * i);
        tracker_.Process();
      }
    }
    num_told += 50;
    EXPECT_EQ(observed_at_.size(), num_told) << order[0] << order[1] << order[2];
    EXPECT_EQ(tracker_.num_dropped(), 0u) << order[0] << order[1] << order[2];
  } while (std::next_permutation(order.begin(), order.end()));
}

class FloorTrackerTest : public WorldTrackerTest {
 protected:
  FloorTrackerTest() : WorldTrackerTest(true, true) { X_MO_ = At(2.0, 2.0, 0.0); }
  /// Shows the floor before the robot, and something on it where See sees a mug.
  void Sweep(double time) {
    perception::PointCloud cloud{0, 1, {}};
    for (float x = 0.8F; x < 2.4F; x += 0.02F) {
      for (float y = -0.6F; y < 0.6F; y += 0.02F) {
        const bool is_thing = std::hypot(x - 1.5F, y - 0.1F) < 0.05F;
        cloud.points.emplace_back(x, y, is_thing ? 0.08F : 0.0F);
      }
    }
    cloud.width = static_cast<int>(cloud.points.size());
    floor_->OnCloud(time, "base_footprint", cloud);
  }
};

TEST_F(FloorTrackerTest, WhatFellToTheFloorIsNoOtherThingThere) {
  double time = 1.0;
  const auto pass = [&](double seconds) {
    for (const double end = time + seconds; time < end;) Tell(time += 0.05);
  };
  pass(1.0);
  for (int i = 0; i < 2; ++i) {
    Sweep(time);
    pass(2.3);
  }
  See(time);
  pass(0.5);
  EXPECT_THAT(names_, ElementsAre("mug1", "obstacle1")) << "it stands on a table";
  See(time, 0.0);
  pass(0.5);
  EXPECT_THAT(names_, ElementsAre("mug1"));
  EXPECT_THAT(observed_.vanished, testing::Contains("obstacle1"));
}

class FreeTrackerTest : public WorldTrackerTest {
 protected:
  FreeTrackerTest() : WorldTrackerTest(false) {}
};

TEST_F(FreeTrackerTest, WithoutLockstepTheyAreToldTenTimesASecond) {
  for (int i = 1; i <= 60; ++i) Tell(1.0 + 0.05 * i);
  ASSERT_THAT(known_at_, SizeIs(testing::Ge(20u)));
  std::vector<double> steps;
  for (std::size_t i = 1; i < known_at_.size(); ++i)
    steps.push_back(known_at_[i] - known_at_[i - 1]);
  EXPECT_THAT(steps, Each(testing::AllOf(testing::Ge(0.1 - 1e-9), testing::Le(0.15 + 1e-9))));
}

}  // namespace
}  // namespace hires::control::world_tracker_test
