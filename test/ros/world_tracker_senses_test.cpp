#include "hires/ros/world_tracker_senses.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "hires/base/rng.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose2;
using hires::perception::Detection;

OdometryReading Odometry(double x) {
  OdometryReading reading;
  reading.X_OB = {x, 0.0, 0.0};
  return reading;
}

std::vector<TrackerMoment> TakeAll(TrackerSenses* senses) {
  std::vector<TrackerMoment> moments;
  while (auto moment = senses->Take()) moments.push_back(std::move(*moment));
  return moments;
}

TEST(TrackerSensesTest, AMomentNeedsOdometryJointsAndAPlace) {
  TrackerSenses senses;
  EXPECT_EQ(senses.Missing(), "odometry");
  senses.OnJoints(10.0, {{"a", 1.0}});
  EXPECT_FALSE(senses.Take());
  senses.OnOdometry(10.0, Odometry(1.0));
  EXPECT_EQ(senses.Missing(), "localisation");
  EXPECT_FALSE(senses.Take());
  senses.OnLocalisation(10.0, {5.0, 2.0, 0.0});
  EXPECT_EQ(senses.Missing(), "");
  const auto moments = TakeAll(&senses);
  ASSERT_EQ(moments.size(), 1u);
  EXPECT_EQ(moments[0].body.time, 10.0);
  EXPECT_EQ(moments[0].body.X_MB.x, 5.0);
  EXPECT_EQ(moments[0].body.joints.at("a"), 1.0);
  EXPECT_FALSE(moments[0].look);
}

TEST(TrackerSensesTest, OdometryLeadsOnFromTheLastLocalisation) {
  TrackerSenses senses;
  senses.OnOdometry(10.0, Odometry(1.0));
  senses.OnLocalisation(10.0, {5.0, 2.0, 0.0});
  senses.OnOdometry(10.1, Odometry(1.3));
  senses.OnJoints(10.1, {});
  EXPECT_FALSE(senses.Take()) << "a correction may still come";
  senses.OnOdometry(10.25, Odometry(1.3));
  const auto moment = senses.Take();
  ASSERT_TRUE(moment);
  EXPECT_NEAR(moment->body.X_MB.x, 5.3, 1e-12);
}

TEST(TrackerSensesTest, ARobotThatStandsHasALocalisationOfLongAgo) {
  TrackerSenses senses;
  senses.OnLocalisation(10.0, {5.0, 2.0, 0.0});  // before the tracker was started
  for (const double stamp : {100.0, 100.2}) senses.OnOdometry(stamp, Odometry(1.0));
  senses.OnJoints(100.0, {});
  EXPECT_FALSE(senses.Take()) << "nothing tells where odometry begins";
  senses.OnOdometryOrigin(100.1, {4.0, 2.0, 0.0});
  const auto moment = senses.Take();
  ASSERT_TRUE(moment);
  EXPECT_NEAR(moment->body.X_MB.x, 5.0, 1e-12);
  EXPECT_NEAR(moment->body.X_MB.y, 2.0, 1e-12);
}

TEST(TrackerSensesTest, AnOriginOfLongAgoIsNone) {
  TrackerSenses senses;
  senses.OnOdometryOrigin(10.0, {4.0, 2.0, 0.0});
  for (const double stamp : {11.1, 11.3}) senses.OnOdometry(stamp, Odometry(1.0));
  senses.OnJoints(11.1, {});
  EXPECT_FALSE(senses.Take());
}

TEST(TrackerSensesTest, MomentsThatWaitedHaveTheOriginOfTheirTime) {
  TrackerSenses senses;
  senses.OnLocalisation(10.0, {5.0, 2.0, 0.0});
  const auto hear = [&](double stamp) {
    senses.OnOdometry(stamp, Odometry(1.0));
    senses.OnJoints(stamp, {});
    return TakeAll(&senses).size();
  };
  // tf is late by so much that the oldest moments are given up...
  double stamp = 100.0;
  for (; stamp < 102.5; stamp += 0.05) EXPECT_EQ(hear(stamp), 0u);
  EXPECT_EQ(senses.Missing(), "localisation");
  // ... and the origins of now are no good for those that wait.
  std::size_t taken = 0;
  for (const double end = stamp + 3.0; stamp < end; stamp += 0.05) {
    senses.OnOdometryOrigin(stamp + 0.05, {4.0, 2.0, 0.0});
    taken += hear(stamp);
  }
  EXPECT_GE(taken, 3.0 / 0.05) << "all that came after the first origin but the last 0.15 s";
  EXPECT_EQ(senses.Missing(), "");
}

TEST(TrackerSensesTest, ALookJoinsTheJointsOfItsMoment) {
  TrackerSenses senses;
  senses.OnLook(10.0, {{"mug1", "mug", {}, 1.0}});
  senses.OnOdometry(10.0, Odometry(0.0));
  senses.OnLocalisation(10.0, {});
  EXPECT_FALSE(senses.Take());
  senses.OnJoints(10.0, {{"head", 0.3}});
  const auto moments = TakeAll(&senses);
  ASSERT_EQ(moments.size(), 1u);
  ASSERT_TRUE(moments[0].look);
  EXPECT_EQ(moments[0].look->at(0).name, "mug1");
  EXPECT_EQ(moments[0].body.joints.at("head"), 0.3);
}

TEST(TrackerSensesTest, ALookBetweenTwoJointMessagesTakesTheEarlierOne) {
  TrackerSenses senses;
  senses.OnOdometry(10.0, Odometry(0.0));
  senses.OnLocalisation(10.0, {});
  senses.OnJoints(10.0, {{"head", 0.1}});
  senses.OnLook(10.02, {});
  senses.OnJoints(10.05, {{"head", 0.2}});
  senses.OnOdometry(10.05, Odometry(0.0));
  senses.OnLocalisation(10.05, {});
  const auto moments = TakeAll(&senses);
  ASSERT_EQ(moments.size(), 3u);
  ASSERT_TRUE(moments[1].look);
  EXPECT_EQ(moments[1].body.joints.at("head"), 0.1);
}

/// The same messages of 40 ticks; topics keep their order, and interleave as `rng` likes.
std::vector<TrackerMoment> Played(hires::base::Rng* rng) {
  std::vector<std::vector<std::function<void(TrackerSenses*)>>> topics(4);
  for (int i = 0; i < 40; ++i) {
    const double stamp = 10.0 + 0.05 * i;
    topics[0].push_back([=](TrackerSenses* s) { s->OnOdometry(stamp, Odometry(0.01 * i)); });
    topics[1].push_back([=](TrackerSenses* s) { s->OnLocalisation(stamp, {0.011 * i, 0, 0}); });
    topics[2].push_back([=](TrackerSenses* s) { s->OnJoints(stamp, {{"a", 1.0 * i}}); });
    if (i % 10 == 0) topics[3].push_back([=](TrackerSenses* s) { s->OnLook(stamp, {}); });
  }
  TrackerSenses senses;
  std::vector<std::size_t> next(4, 0);
  std::vector<TrackerMoment> moments;
  // A tick's messages arrive in any order, but all before those of the next tick but one.
  for (int i = 0; i < 40; ++i) {
    std::vector<int> order = {0, 1, 2};
    if (i % 10 == 0) order.push_back(3);
    for (std::size_t k = order.size(); k > 1; --k) {
      std::swap(order[k - 1], order[rng->Index(static_cast<int>(k))]);
    }
    for (const int topic : order) {
      topics[topic][next[topic]++](&senses);
      for (TrackerMoment& moment : TakeAll(&senses)) moments.push_back(std::move(moment));
    }
  }
  return moments;
}

TEST(TrackerSensesTest, ALookWhoseJointsWereLostIsNone) {
  TrackerSenses senses;
  for (const double stamp : {10.0, 10.1, 10.2, 10.4}) senses.OnOdometry(stamp, Odometry(1.0));
  senses.OnLocalisation(10.0, {5.0, 2.0, 0.0});
  senses.OnJoints(10.0, {{"head", 1.0}});
  senses.OnLook(10.1, {});  // the head may look elsewhere since
  senses.OnJoints(10.2, {{"head", 0.0}});
  const auto moments = TakeAll(&senses);
  ASSERT_EQ(moments.size(), 3u);
  EXPECT_FALSE(moments[1].look);
  EXPECT_EQ(senses.num_dropped(), 1);
}

TEST(TrackerSensesTest, ALookThatTookLongIsOfItsOwnTime) {
  TrackerSenses senses;
  for (int i = 0; i <= 20; ++i) {  // for 1 s
    const double stamp = 10.0 + 0.05 * i;
    senses.OnOdometry(stamp, Odometry(0.1 * i));
    senses.OnLocalisation(stamp, {0.1 * i, 0.0, 0.0});
    senses.OnJoints(stamp, {{"head", 0.01 * i}});
    EXPECT_EQ(TakeAll(&senses).size(), 1u);
  }
  senses.OnLook(10.2, {{"mug1", "mug", {}, 1.0}});
  const auto moments = TakeAll(&senses);
  ASSERT_EQ(moments.size(), 1u);
  EXPECT_TRUE(moments[0].is_late);
  EXPECT_EQ(moments[0].body.time, 10.2);
  EXPECT_NEAR(moments[0].body.X_MB.x, 0.4, 1e-12);
  EXPECT_NEAR(moments[0].body.joints.at("head"), 0.04, 1e-12);
  EXPECT_EQ(moments[0].look->at(0).name, "mug1");
  EXPECT_EQ(senses.num_dropped(), 0);
}

TEST(TrackerSensesTest, PlaceAndJointsDoNotDependOnHowTopicsInterleave) {
  hires::base::Rng first(0);
  const auto wanted = Played(&first);
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    hires::base::Rng rng(seed);
    const auto moments = Played(&rng);
    std::map<double, double> x, joints;
    for (const TrackerMoment& moment : wanted) x[moment.body.time] = moment.body.X_MB.x;
    for (const TrackerMoment& moment : wanted) {
      joints[moment.body.time] = moment.body.joints.at("a");
    }
    for (const TrackerMoment& moment : moments) {
      EXPECT_EQ(moment.body.X_MB.x, x.at(moment.body.time)) << "seed " << seed;
      EXPECT_EQ(moment.body.joints.at("a"), joints.at(moment.body.time)) << "seed " << seed;
    }
    int num_looks = 0;
    for (const TrackerMoment& moment : moments) num_looks += moment.look.has_value();
    EXPECT_EQ(num_looks, 4) << "seed " << seed;
  }
}

TEST(TrackerSensesTest, WhatIsLateOrStaysAloneIsDropped) {
  TrackerSenses senses;
  senses.OnOdometry(10.0, Odometry(0.0));
  senses.OnLocalisation(10.0, {});
  senses.OnJoints(10.0, {});
  EXPECT_TRUE(senses.Take());
  senses.OnJoints(9.0, {});
  EXPECT_EQ(senses.num_dropped(), 1);
  senses.OnLook(9.0, {});  // nobody knows where the camera was
  EXPECT_FALSE(senses.Take());
  EXPECT_EQ(senses.num_dropped(), 2);
  senses.OnLook(20.0, {});  // of a clock that nobody else has: waits, and holds up nobody
  senses.OnOdometry(10.05, Odometry(0.0));
  senses.OnLocalisation(10.05, {});
  senses.OnJoints(10.05, {});
  EXPECT_TRUE(senses.Take());
}

TEST(TrackerSensesTest, AClockThatBeginsAnewIsFollowed) {
  TrackerSenses senses;
  const auto tick = [&](double stamp) {
    senses.OnOdometry(stamp, Odometry(0.0));
    senses.OnLocalisation(stamp, {1.0, 0.0, 0.0});
    senses.OnJoints(stamp, {});
    return TakeAll(&senses).size();
  };
  EXPECT_EQ(tick(500.0), 1u);
  EXPECT_EQ(tick(0.05), 1u);
  EXPECT_EQ(tick(0.10), 1u);
}

}  // namespace
}  // namespace hires_ros
