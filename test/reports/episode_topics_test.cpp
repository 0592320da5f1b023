#include "reports/episode/episode_topics.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "hires/base/text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::reports::episode_topics_test {
namespace {

using test_support::ConfigErrorOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kFile = HIRES_SOURCE_DIR "/config/episode.yaml";

const EpisodeConfig& OfPr2() {
  static const EpisodeConfig config = ReadEpisodeConfig(kFile);
  return config;
}

std::vector<BagTopic> WholeBag() {
  std::vector<BagTopic> bag;
  for (const EpisodeTopic& topic : OfPr2().topics) bag.push_back({topic.topic, topic.type, 1});
  return bag;
}

BagTopic* Find(const std::string& name, std::vector<BagTopic>* bag) {
  for (BagTopic& topic : *bag) {
    if (topic.name == name) return &topic;
  }
  return nullptr;
}

TEST(EpisodeTopicsTest, NamesOfTheRobotStandForTopicsAndActionsForTheirParts) {
  EXPECT_EQ(OfPr2().Of("odometry").topic, "/base_odometry/odom");
  EXPECT_EQ(OfPr2().Of("transforms").need, TopicNeed::kNeeded);
  EXPECT_EQ(OfPr2().Of("execute_action/goal").topic, "/execute_action/goal");
  EXPECT_EQ(OfPr2().Of("execute_action/goal").type, "hires/ExecuteActionActionGoal");
  EXPECT_EQ(OfPr2().Of("execute_action/cancel").type, "actionlib_msgs/GoalID");
  const auto num_arms = std::count_if(OfPr2().topics.begin(), OfPr2().topics.end(),
                                      [](const auto& topic) { return topic.role == "grippers"; });
  EXPECT_EQ(num_arms, 2);
}

TEST(EpisodeTopicsTest, AWholeBagNeedsNoAdvice) {
  const TopicCheck check = CheckTopics(OfPr2(), WholeBag());
  EXPECT_TRUE(check.is_usable());
  EXPECT_THAT(check.Advice(), IsEmpty());
}

TEST(EpisodeTopicsTest, WhatIsNeededAndHasNoMessageIsNamedWithWhatToRecord) {
  auto bag = WholeBag();
  Find("/tf", &bag)->num_messages = 0;
  const TopicCheck check = CheckTopics(OfPr2(), bag);
  EXPECT_FALSE(check.is_usable());
  EXPECT_THAT(check.Advice(), HasSubstr("needed:\n  /tf (tf2_msgs/TFMessage)"));
  EXPECT_THAT(check.Advice(), HasSubstr("rosbag record"));
  EXPECT_THAT(check.Advice(), HasSubstr(" /base_odometry/odom"));
}

TEST(EpisodeTopicsTest, WhatCameUnderAnotherNameIsSaidWithHowToNameIt) {
  const auto advice_for = [](const std::string& name, const std::string& other) {
    auto bag = WholeBag();
    Find(name, &bag)->name = other;
    return CheckTopics(OfPr2(), bag).Advice();
  };
  EXPECT_THAT(advice_for("/base_odometry/odom", "/odom"),
              HasSubstr("there are\n  /odom (nav_msgs/Odometry)\nif they are what is missing"));
  EXPECT_THAT(advice_for("/joint_states", "/robot1/joint_states"),
              HasSubstr("\n  /robot1/joint_states (sensor_msgs/JointState)"));
  EXPECT_THAT(advice_for("/execute_action/goal", "/a/execute_action/goal"), HasSubstr("--episode"));
  // Of the same type, but known as what it is; and what nobody misses.
  EXPECT_THAT(advice_for("/tf", "/else"), Not(HasSubstr("/tf_static")));
  EXPECT_THAT(advice_for("/base_scan", "/scan"), IsEmpty());
}

TEST(EpisodeTopicsTest, AWrongTypeUnderAKnownNameCountsAsMissing) {
  auto bag = WholeBag();
  Find("/joint_states", &bag)->type = "std_msgs/String";
  Find("/detections", &bag)->type = "std_msgs/String";
  Find("/base_scan", &bag)->type = "std_msgs/String";  // is not read
  const TopicCheck check = CheckTopics(OfPr2(), bag);
  EXPECT_FALSE(check.is_usable());
  EXPECT_FALSE(check.Has("detections"));
  EXPECT_THAT(check.Advice(), HasSubstr("topic /joint_states has messages of type std_msgs/String, "
                                        "wanted sensor_msgs/JointState"));
  EXPECT_THAT(check.Advice(), Not(HasSubstr("/base_scan has")));
}

TEST(EpisodeTopicsTest, WithoutWhatHelpsABagIsUsable) {
  auto bag = WholeBag();
  Find("/execute_action/goal", &bag)->num_messages = 0;
  const TopicCheck check = CheckTopics(OfPr2(), bag);
  EXPECT_TRUE(check.is_usable());
  EXPECT_THAT(check.Advice(), HasSubstr("helps:\n  /execute_action/goal"));
  EXPECT_THAT(check.Advice(), HasSubstr("episode_recorder.launch record:=FOLDER"));
}

TEST(EpisodeTopicsTest, AnEmptyBagLacksAllThatIsNeeded) {
  EXPECT_FALSE(CheckTopics(OfPr2(), {}).is_usable());
}

TEST(EpisodeTopicsTest, AFileWithoutATopicThatIsReadOrWithAnUnknownNameIsRefused) {
  const test_support::TemporaryFolder folder;
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string text = base::ReadTextFile(kFile);
    text.replace(text.find(from), from.size(), to);
    const std::string names = "names: robots";
    text.replace(text.find(names), names.size(), "names: " HIRES_SOURCE_DIR "/config/robots");
    const std::string path = folder.Write("episode.yaml", text);
    return ConfigErrorOf([&] { ReadEpisodeConfig(path); });
  };
  EXPECT_THAT(refusal("role: odometry", "role: wheels"), HasSubstr("role 'odometry'"));
  EXPECT_THAT(refusal("{joint_states}", "{joint_state}"), HasSubstr("did you mean"));
  EXPECT_THAT(refusal("need: helps", "need: nice"), HasSubstr("need"));
}

TEST(BagRotationTest, ABagIsFullBySizeByTimeAndWhenTheClockBeginsAgain) {
  BagRotation rotation("/tmp/bags", "2026-11-21-20-41-00", {1000, 60.0, 100});
  EXPECT_FALSE(rotation.has_begun());
  EXPECT_EQ(rotation.Next(10.0), "/tmp/bags/hires_2026-11-21-20-41-00_0.bag.active");
  EXPECT_EQ(rotation.final_path(), "/tmp/bags/hires_2026-11-21-20-41-00_0.bag");
  EXPECT_FALSE(rotation.IsFull(999, 69.9));
  EXPECT_TRUE(rotation.IsFull(1000, 11.0));
  EXPECT_TRUE(rotation.IsFull(0, 70.0));
  EXPECT_TRUE(rotation.IsFull(0, 9.9));
  EXPECT_EQ(rotation.Next(70.0), "/tmp/bags/hires_2026-11-21-20-41-00_1.bag.active");
  EXPECT_FALSE(rotation.IsFull(0, 71.0));
}

}  // namespace
}  // namespace hires::reports::episode_topics_test
