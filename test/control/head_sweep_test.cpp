#include "hires/control/head_sweep.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "hires/perception/camera_view.h"
#include "support/restaurant_translation.h"

namespace hires::control::head_sweep_test {
namespace {

using hires::test_support::RestaurantContext;
using testing::UnorderedElementsAre;

const std::vector<std::string> kPlaces = {"placingareawestlefttable1", "placingareaeastlefttable1"};

class HeadSweepTest : public testing::Test {
 protected:
  HeadSweepTest() {
    body_.X_MB = {7.68, 9.6, 1.57};  // south of table1
    body_.joints = RestaurantContext().robot->profile.joints;
    body_.joints["head_tilt_joint"] = -0.3;
  }
  HeadSweep Make() const {
    HeadSweep sweep(RestaurantContext().robot, params_);
    sweep.SetPlaces(kPlaces, RestaurantContext().areas);
    return sweep;
  }
  /// A while, in which the head does what it is told. @return targets in their order.
  std::vector<std::string> Play(HeadSweep* sweep, double seconds) {
    std::vector<std::string> targets;
    for (const double end = body_.time + seconds; body_.time < end; body_.time += 0.1) {
      const auto turn = sweep->Update(body_, true, known_);
      if (!turn) continue;
      targets.push_back(sweep->target());
      for (std::size_t i = 0; i < turn->joints.size(); ++i) {
        body_.joints[turn->joints[i]] = turn->points.back().positions[i];
      }
    }
    return targets;
  }

  SweepParams params_;
  sensing::BodyReading body_;
  std::vector<robot::SeenObject> known_;
};

TEST_F(HeadSweepTest, EveryPlaceOfTheTaskIsLookedAt) {
  HeadSweep sweep = Make();
  const auto targets = Play(&sweep, 12.0);
  for (const std::string& place : kPlaces) {
    const auto view = perception::ViewOf(*RestaurantContext().robot, body_.X_MB, body_.joints);
    const bool is_seen = view.Contains(RestaurantContext().areas.Require(place).X_FA.translation);
    EXPECT_TRUE(is_seen || std::count(targets.begin(), targets.end(), place) > 0) << place;
  }
  EXPECT_FALSE(targets.empty());
}

TEST_F(HeadSweepTest, AfterTheTurnTheCameraSeesTheTarget) {
  HeadSweep sweep = Make();
  const auto turn = sweep.Update(body_, true, known_);
  ASSERT_TRUE(turn);
  ASSERT_EQ(turn->points.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    body_.joints[turn->joints[i]] = turn->points.back().positions[i];
    const double way = std::abs(turn->points[1].positions[i] - turn->points[0].positions[i]);
    EXPECT_LE(1.5 * way / turn->duration(), params_.speed + 1e-9);
  }
  const auto view = perception::ViewOf(*RestaurantContext().robot, body_.X_MB, body_.joints);
  EXPECT_TRUE(view.Contains(RestaurantContext().areas.Require(sweep.target()).X_FA.translation));
}

TEST_F(HeadSweepTest, AHeadThatObeysLateRestsAsLongAllTheSame) {
  HeadSweep sweep = Make();
  const auto first = sweep.Update(body_, true, known_);
  ASSERT_TRUE(first);
  body_.time += first->duration() + 1.0;  // the command is under way
  EXPECT_FALSE(sweep.Update(body_, true, known_));
  for (std::size_t i = 0; i < first->joints.size(); ++i) {
    body_.joints[first->joints[i]] = first->points.back().positions[i];
  }
  const double arrived = body_.time;
  while (!sweep.Update(body_, false, known_) && body_.time < arrived + 60.0) body_.time += 0.01;
  EXPECT_GE(body_.time - arrived, params_.dwell - 1e-9);
  EXPECT_LE(body_.time - arrived, params_.dwell + 0.02) << "the other place waits";
}

TEST_F(HeadSweepTest, AHeadThatNeverObeysIsAskedForSomethingElse) {
  HeadSweep sweep = Make();
  const auto first = sweep.Update(body_, true, known_);
  ASSERT_TRUE(first);
  const std::string target = sweep.target();
  const double asked = body_.time;
  do body_.time += 0.1;
  while (!sweep.Update(body_, false, known_) && body_.time < asked + 60.0);
  EXPECT_GT(body_.time - asked, first->duration());
  EXPECT_LT(body_.time - asked, first->duration() + 5.0);
  EXPECT_NE(sweep.target(), target);
}

TEST_F(HeadSweepTest, AnActionThatUsesTheHeadHasIt) {
  HeadSweep sweep = Make();
  sweep.SetBusy(true, 0.0);
  EXPECT_TRUE(Play(&sweep, 10.0).empty());
  sweep.SetBusy(false, body_.time);
  EXPECT_TRUE(Play(&sweep, params_.hands_off - 0.2).empty()) << "it may go on at once";
  EXPECT_FALSE(Play(&sweep, 1.0).empty());
}

TEST_F(HeadSweepTest, WhatIsFarAwayIsNotLookedAt) {
  HeadSweep sweep = Make();
  body_.X_MB = {12.5, 11.8, 3.14};
  EXPECT_TRUE(Play(&sweep, 10.0).empty());
}

TEST_F(HeadSweepTest, AnObjectOnTheTrayIsLookedAtWhereItIs) {
  HeadSweep sweep = Make();
  sweep.SetPlaces({"mug1", "mug2"}, RestaurantContext().areas);
  const auto X_MB = geometry::Lift(body_.X_MB);
  known_.push_back({"mug1", "coffee_cup", X_MB * geometry::Lift({0.28, 0.0, 0.0}, 0.346), 0.0, ""});
  const auto targets = Play(&sweep, 3.0);
  EXPECT_THAT(targets, testing::Each("mug1"));
  EXPECT_FALSE(targets.empty());
}

TEST_F(HeadSweepTest, AtThePicturesEdgeNothingWasLookedAt) {
  HeadSweep sweep = Make();
  sweep.SetPlaces({"mug1"}, RestaurantContext().areas);
  const auto view = perception::ViewOf(*RestaurantContext().robot, body_.X_MB, body_.joints);
  const double edge = 0.45 * view.height;  // of half the height: in view, and not wholly
  const Eigen::Vector3d p_C(1.5 * std::cos(edge), 0.0, -1.5 * std::sin(edge));
  const Eigen::Vector3d p_M = view.X_MC * p_C - Eigen::Vector3d(0.0, 0.0, 0.05);
  ASSERT_TRUE(view.Contains(p_M + Eigen::Vector3d(0.0, 0.0, 0.05)));
  known_.push_back({"mug1", "coffee_cup", {p_M, Eigen::Quaterniond::Identity()}, 0.0, ""});
  EXPECT_TRUE(sweep.Update(body_, true, known_)) << "it is looked at, as it may not have been seen";
}

TEST_F(HeadSweepTest, WithoutPlacesOrWhenSwitchedOffTheHeadRests) {
  HeadSweep idle(RestaurantContext().robot, params_);
  EXPECT_TRUE(Play(&idle, 5.0).empty());
  params_.enabled = false;
  HeadSweep off = Make();
  EXPECT_TRUE(Play(&off, 5.0).empty());
}

TEST(SweepParamsTest, WhatMakesNoSenseIsNamed) {
  const auto read = [](const std::string& speed) {
    return ReadSweepParams(
        base::ParamReader::FromString("enabled: true\nrange: 3.2\nperiod: 4.0\n"
                                      "dwell: 1.0\nspeed: " +
                                          speed + "\nhands_off: 2.0\n",
                                      "sweep.yaml"));
  };
  EXPECT_EQ(read("0.5").speed, 0.5);
  EXPECT_THROW(read("0.0"), base::ConfigError);
}

}  // namespace
}  // namespace hires::control::head_sweep_test
