#include "hires/ros/knowledge/blackboard_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/knowledge/fluent.h"
#include "support/messages.h"

namespace hires_ros::blackboard_messages_test {
namespace {

namespace knowledge = hires::knowledge;
using hires::temporal::kForever;
using hires::test_support::ConfigErrorOf;
using ::testing::HasSubstr;

knowledge::Fluent EveryKind() {
  knowledge::Fluent fluent;
  fluent.concept_name = "Mug";
  fluent.instance = "mug1";
  fluent.properties = {{"hasPose", "Pose", std::string("pose1")},
                       {"hasX", "xsd:float", 0.1},
                       {"hasY", "xsd:double", -1e300},
                       {"hasCount", "xsd:int", std::int64_t{1} << 60},
                       {"isClean", "xsd:boolean", true},
                       {"hasText", "xsd:string", std::string("\xc3\xa4 \n")}};
  fluent.start = {1.5, 2.5};
  fluent.finish = {3.0, kForever};
  return fluent;
}

TEST(BlackboardMessagesTest, AFluentComesBackAsItWas) {
  EXPECT_TRUE(FromMessage(ToMessage(EveryKind())) == EveryKind());
}

TEST(BlackboardMessagesTest, ZerosAreEverAndTheMomentZeroIsKept) {
  hires::Fluent message;
  EXPECT_EQ(FromMessage(message).start, (hires::temporal::Bounds{-kForever, -kForever}));
  EXPECT_EQ(FromMessage(message).finish, (hires::temporal::Bounds{kForever, kForever}));
  knowledge::Fluent fluent;
  fluent.start = {0.0, 0.0};
  fluent.finish = {0.0, 0.0};
  EXPECT_TRUE(std::signbit(ToMessage(fluent).start_earliest));
  EXPECT_TRUE(FromMessage(ToMessage(fluent)) == fluent);
  fluent.start = {0.0, 1.0};
  EXPECT_TRUE(FromMessage(ToMessage(fluent)) == fluent);
}

TEST(BlackboardMessagesTest, AnEpisodeComesBackAsItWas) {
  knowledge::Episode episode;
  episode.id = 7;
  episode.name = "2026-01-01T00:00:00";
  episode.task = "serve";
  episode.outcome = "succeeded";
  episode.label = knowledge::Episode::Label::kImagined;
  episode.parent = 3;
  episode.start = 1.0;
  const knowledge::Episode back = FromMessage(ToMessage(episode));
  EXPECT_EQ(back.id, 7);
  EXPECT_EQ(back.name, episode.name);
  EXPECT_EQ(back.task, "serve");
  EXPECT_EQ(back.outcome, "succeeded");
  EXPECT_EQ(back.label, knowledge::Episode::Label::kImagined);
  EXPECT_EQ(back.parent, 3);
  EXPECT_EQ(back.start, 1.0);
  EXPECT_EQ(back.finish, kForever);
}

TEST(BlackboardMessagesTest, AQueryComesBackAsItWas) {
  using Reach = knowledge::FluentQuery::ConceptFilter::Reach;
  knowledge::FluentQuery query;
  query.concepts = {{"Mug", Reach::kBelow}, {"Pose", Reach::kExact}, {"Table", Reach::kAbove}};
  query.instance = "mug1";
  query.properties = {{"hasPose", std::nullopt},
                      {"hasX", 1.5},
                      {"hasCount", std::int64_t{3}},
                      {"isClean", true},
                      {"hasText", std::string("x")}};
  query.all_properties = false;
  query.time.kind = knowledge::FluentQuery::TimeFilter::Kind::kAllen;
  query.time.interval = {1.0, 2.0};
  query.time.relations = {hires::temporal::Allen::kBefore, hires::temporal::Allen::kMetBy};
  query.episode = 4;
  query.label = knowledge::Episode::Label::kImagined;
  query.sparql = "select";
  query.limit = 17;
  query.cursor = "c";
  const knowledge::FluentQuery back = FromMessage(ToMessage(query));
  ASSERT_EQ(back.concepts.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.concepts[i].name, query.concepts[i].name);
    EXPECT_EQ(back.concepts[i].reach, query.concepts[i].reach);
  }
  ASSERT_EQ(back.properties.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(back.properties[i].role, query.properties[i].role);
    EXPECT_EQ(back.properties[i].filler, query.properties[i].filler);
  }
  EXPECT_EQ(back.instance, "mug1");
  EXPECT_FALSE(back.all_properties);
  EXPECT_EQ(back.time.kind, query.time.kind);
  EXPECT_EQ(back.time.interval, query.time.interval);
  EXPECT_EQ(back.time.relations, query.time.relations);
  EXPECT_EQ(back.episode, query.episode);
  EXPECT_EQ(back.label, query.label);
  EXPECT_EQ(back.sparql, "select");
  EXPECT_EQ(back.limit, 17u);
  EXPECT_EQ(back.cursor, "c");
}

TEST(BlackboardMessagesTest, AnEmptyQueryAsksForAllThatHoldsNowReally) {
  const knowledge::FluentQuery query = FromMessage(hires::FluentQuery());
  EXPECT_TRUE(query.concepts.empty());
  EXPECT_EQ(query.time.kind, knowledge::FluentQuery::TimeFilter::Kind::kNow);
  EXPECT_FALSE(query.episode.has_value());
  EXPECT_EQ(query.label, knowledge::Episode::Label::kReal);
  EXPECT_EQ(query.limit, 1000u);
}

TEST(BlackboardMessagesTest, AChangeComesBackAsItWas) {
  knowledge::Change change;
  change.sequence = 12;
  change.kind = knowledge::Change::Kind::kRemoved;
  change.fluent = EveryKind();
  change.time = 5.0;
  change.episode = 2;
  change.label = knowledge::Episode::Label::kImagined;
  change.source = knowledge::Source::kMonitor;
  const knowledge::Change back = FromMessage(ToMessage(change));
  EXPECT_EQ(back.sequence, 12u);
  EXPECT_EQ(back.kind, change.kind);
  EXPECT_TRUE(back.fluent == change.fluent);
  EXPECT_EQ(back.time, 5.0);
  EXPECT_EQ(back.episode, 2);
  EXPECT_EQ(back.label, change.label);
  EXPECT_EQ(back.source, change.source);
}

TEST(BlackboardMessagesTest, EverySourceHasItsCode) {
  for (const auto source : {knowledge::Source::kKnowledge, knowledge::Source::kObservation,
                            knowledge::Source::kPerson, knowledge::Source::kMonitor}) {
    EXPECT_EQ(FromMessage(ToMessage(knowledge::Assertion{source, 1, 2.0})).source, source);
  }
  EXPECT_EQ(FromMessage(hires::Assertion()).source, knowledge::Source::kObservation);
}

TEST(BlackboardMessagesTest, CodesThatAreNoneAreNamed) {
  hires::Assertion assertion;
  assertion.source = 4;
  EXPECT_THAT(ConfigErrorOf([&] { FromMessage(assertion); }), HasSubstr("source is 4"));
  hires::FluentQuery query;
  query.time_kind = 4;
  EXPECT_THAT(ConfigErrorOf([&] { FromMessage(query); }), HasSubstr("time_kind is 4"));
  query.time_kind = 0;
  query.world = 3;
  EXPECT_THAT(ConfigErrorOf([&] { FromMessage(query); }), HasSubstr("world is 3"));
  query.world = 0;
  query.relations = {"befor"};
  EXPECT_THAT(ConfigErrorOf([&] { FromMessage(query); }), HasSubstr("befor"));
  hires::FluentChange change;
  change.kind = 3;
  EXPECT_THAT(ConfigErrorOf([&] { FromMessage(change); }), HasSubstr("kind is 3"));
}

}  // namespace
}  // namespace hires_ros::blackboard_messages_test
