#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <limits>

#include "hires/robot/load_robot.h"
#include "reports/experience/experience_writer.h"
#include "reports/experience/load_follower.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::reports::experience_recording_test {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using knowledge::ExperienceStore;
using knowledge::ToppleEpisodePart;
using knowledge::ToppleState;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kPeriod = knowledge::kExperiencePeriod;

/// A robot that drives along x at 0.2 m/s with a mill on its tray.
class LoadFollowerTest : public ::testing::Test {
 protected:
  LoadFollowerTest()
      : robot_(robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml")),
        follower_({}, robot_, {}) {}

  /// @param tilt  [rad] of the mill.
  std::optional<ToppleEpisodePart> Step(double tilt = 0.0) {
    time_ += kPeriod;
    state_.X_MB = {0.2 * time_, 0.0, 0.0};
    world::WorldState world;
    const auto X_RL = robot::ForwardKinematics(robot_.model, robot_.profile.joints);
    Pose3 X_MO = geometry::Lift(state_.X_MB) *
                 X_RL[*robot_.model.FindLink(robot_.profile.tray_link)] * robot_.profile.X_TO;
    X_MO.translation += offset_;
    X_MO.rotation = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX());
    if (has_mug_) world.objects.push_back({"mug1", "mug", {}, {}, ""});
    if (has_mill_) world.objects.push_back({"PepperMill1", "peppermill", X_MO, {}, hand_});
    return follower_.Add(time_, world, state_);
  }

  /// Parts of so many steps.
  int Steps(int number, double tilt = 0.0) {
    int parts = 0;
    for (int i = 0; i < number; ++i) parts += Step(tilt).has_value();
    return parts;
  }

  robot::Robot robot_;
  LoadFollower follower_;
  robot::RobotState state_;
  Eigen::Vector3d offset_{Eigen::Vector3d::Zero()};
  std::string hand_;
  double time_{10.0};
  bool has_mug_{true}, has_mill_{true};
};

TEST_F(LoadFollowerTest, WhatStandsOnTheTrayIsFollowed) {
  EXPECT_EQ(Steps(3), 0) << "too few for a jerk";
  const auto part = Step();
  ASSERT_TRUE(part);
  EXPECT_EQ(follower_.load(), "PepperMill1");
  EXPECT_NEAR(part->base.v, 0.2, 1e-9);
  EXPECT_NEAR(part->deviation, 0.0, 1e-9);
  EXPECT_EQ(part->state, ToppleState::kNoTopple);
}

TEST_F(LoadFollowerTest, WhatAHandTakesIsNotFollowedAndBeginsAnew) {
  EXPECT_EQ(Steps(10), 7);
  hand_ = "r_gripper_palm_link";
  EXPECT_EQ(Steps(10), 0);
  EXPECT_EQ(follower_.load(), "");
  hand_ = "";
  EXPECT_EQ(Steps(10), 7);
}

TEST_F(LoadFollowerTest, WhatLeavesTheTrayUprightOrTheWorldIsNotFollowed) {
  EXPECT_EQ(Steps(10), 7);
  offset_ = {0.0, 2.0, 0.0};
  EXPECT_EQ(Steps(10), 0);
  offset_.setZero();
  EXPECT_EQ(Steps(10), 7);
  has_mill_ = false;
  EXPECT_EQ(Steps(10), 0);
}

TEST_F(LoadFollowerTest, WhatLiesIsFollowedForAWhileAndAnEpisodeIsOver) {
  EXPECT_EQ(Steps(10), 7);
  const auto first = Step(0.6);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->state, ToppleState::kTopple);
  EXPECT_EQ(first->episode, 0u);
  offset_ = {0.0, 0.3, -0.7};  // beside the robot, on the floor
  EXPECT_EQ(Steps(100, 1.5), 30) << "1.5 s";
  EXPECT_EQ(Steps(10, 0.0), 0) << "it stands, but not on the tray";
  offset_.setZero();
  EXPECT_EQ(Steps(3, 0.6), 0) << "it leans on the tray too much to begin with";
  EXPECT_EQ(Steps(3), 0);
  const auto next = Step();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->episode, 1u);
}

TEST_F(LoadFollowerTest, AGapOrTimeThatGoesBackBeginsAnew) {
  EXPECT_EQ(Steps(10), 7);
  time_ += 2.0 * kPeriod;
  EXPECT_EQ(Steps(10), 7);
  time_ = 3.0;
  EXPECT_EQ(Steps(10), 7);
}

TEST_F(LoadFollowerTest, WhatComesTooSoonIsPassedOver) {
  EXPECT_EQ(Steps(10), 7);
  time_ -= 0.8 * kPeriod;
  EXPECT_EQ(Steps(1), 0);
  time_ -= 0.2 * kPeriod;
  EXPECT_EQ(Steps(10), 10);
}

TEST_F(LoadFollowerTest, OneThatIsNamedIsWaitedFor) {
  follower_ = LoadFollower({"mug1", 1.5}, robot_, {});
  EXPECT_EQ(Steps(10), 0);
  follower_ = LoadFollower({"peppermill1", 1.5}, robot_, {});
  EXPECT_EQ(Steps(10), 7);
}

TEST_F(LoadFollowerTest, WhatIsNoNumberIsRefusedAndForgotten) {
  EXPECT_EQ(Steps(10), 7);
  offset_.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(test_support::ConfigErrorOf([&] { Step(); }), HasSubstr("the pose of PepperMill1"));
  offset_.setZero();
  EXPECT_EQ(Steps(10), 7) << "a sample is missing: differences are taken anew";
}

TEST_F(LoadFollowerTest, AMomentThatCannotBeReadIsAGap) {
  EXPECT_EQ(Steps(10), 7);
  state_.joints["no_such_joint"] = 1.0;
  EXPECT_THAT(test_support::ConfigErrorOf([&] { Step(); }), HasSubstr("no_such_joint"));
  state_.joints.clear();
  EXPECT_EQ(Steps(10), 7);
}

TEST_F(LoadFollowerTest, ARobotWithoutTrayIsRefused) {
  robot_.profile.tray_link.clear();
  EXPECT_THAT(test_support::ConfigErrorOf([&] { LoadFollower({}, robot_, {}); }),
              HasSubstr("has no tray"));
}

TEST(ToppleMonitorConfigTest, WhatIsWrongIsNamed) {
  const auto error = [](const std::string& world, const std::string& rest) {
    return test_support::ConfigErrorOf([&] {
      ReadToppleMonitorConfig(base::ParamReader::FromString(
          "world_state: " + world + "\nrobot_state: b\nobject: \"\"\n" + rest, "m.yaml"));
    });
  };
  EXPECT_THAT(error("\"\"", "after_fall: 1.5"), HasSubstr("wanted a topic"));
  EXPECT_THAT(error("a", "after_fall: -1"), HasSubstr("after_fall"));
  EXPECT_THAT(error("a", "after_fall: 1.5\nperiod: 1"), HasSubstr("period"));
}

class ExperienceWriterTest : public ::testing::Test {
 protected:
  ToppleEpisodePart PartAt(double time, ToppleState state = ToppleState::kNoTopple) {
    ToppleEpisodePart part;
    part.time = time;
    part.state = state;
    return part;
  }

  std::vector<std::string> Stored() {
    std::vector<std::string> lines;
    ExperienceStore(path_, ExperienceStore::Mode::kRead).ForEach({}, [&](const auto& stored) {
      lines.push_back(*stored.run + " " + *stored.action + " " +
                      std::to_string(static_cast<int>(stored.part.time)));
    });
    return lines;
  }

  test_support::TemporaryFolder folder_;
  std::string path_{(folder_.path() / "experiences.db").string()};
  ExperienceStore store_{path_, ExperienceStore::Mode::kWrite};
};

TEST_F(ExperienceWriterTest, AnotherActionAndTheEndWrite) {
  {
    ExperienceWriter writer(&store_, "today");
    writer.Add(PartAt(1.0));
    EXPECT_THAT(Stored(), ElementsAre());
    writer.SetAction("move_base(home)");
    EXPECT_THAT(Stored(), ElementsAre("today  1"));
    writer.Add(PartAt(2.0));
    writer.SetRun("today/2");
    writer.Add(PartAt(1.0));
  }
  EXPECT_THAT(Stored(),
              ElementsAre("today  1", "today move_base(home) 2", "today/2 move_base(home) 1"));
}

TEST_F(ExperienceWriterTest, AFallIsWrittenAtOnceAndOthersEachSecond) {
  ExperienceWriter writer(&store_, "today");
  writer.Add(PartAt(1.0, ToppleState::kTopple));
  EXPECT_EQ(writer.num_written(), 1u);
  for (int i = 0; i < 19; ++i) writer.Add(PartAt(2.0, ToppleState::kTopple));
  EXPECT_EQ(writer.num_written(), 1u);
  writer.Add(PartAt(3.0, ToppleState::kTopple));
  EXPECT_EQ(writer.num_written(), 21u);
}

TEST_F(ExperienceWriterTest, WhatCannotBeWrittenIsKeptAndTriedAgain) {
  ExperienceWriter writer(&store_, "today");
  {
    SQLite::Database other(path_, SQLite::OPEN_READWRITE);
    other.exec("ALTER TABLE parts RENAME TO elsewhere");
    writer.Add(PartAt(1.0));
    writer.Flush();
    EXPECT_THAT(writer.problem(), HasSubstr(path_));
    EXPECT_EQ(writer.num_written(), 0u);
    other.exec("ALTER TABLE elsewhere RENAME TO parts");
  }
  writer.Add(PartAt(2.0));
  writer.Flush();
  EXPECT_EQ(writer.problem(), "");
  EXPECT_EQ(writer.num_written(), 2u);
  EXPECT_THAT(Stored(), ElementsAre("today  1", "today  2"));
}

}  // namespace
}  // namespace hires::reports::experience_recording_test
