#include "hires/knowledge/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "hires/base/error.h"
#include "knowledge/support/store_world.h"

namespace hires::knowledge::store_test {
namespace {

using temporal::kForever;
using test_support::At;
using test_support::Ever;
using test_support::HoldsAt;
using test_support::MakeFluent;
using test_support::Names;
using test_support::PoseAt;
using test_support::QueryAll;
using test_support::SmallOntology;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class StoreTest : public ::testing::Test {
 protected:
  /// What the error says; the store must be as before.
  std::string ErrorOf(const std::function<void()>& call) {
    const Store::Statistics before = store_.Stats();
    std::string text = "no error";
    try {
      call();
    } catch (const base::ConfigError& error) {
      text = error.what();
    }
    const Store::Statistics after = store_.Stats();
    EXPECT_EQ(after.changes, before.changes);
    EXPECT_EQ(after.instances, before.instances);
    EXPECT_EQ(after.fluents, before.fluents);
    EXPECT_EQ(after.episodes, before.episodes);
    return text;
  }
  std::string ErrorOfAdd(const Fluent& fluent, const Assertion& by = At(0.0)) {
    return ErrorOf([&] { store_.Add({fluent}, by); });
  }
  std::string ErrorOfProperty(const std::string& concept_name, const Property& property) {
    return ErrorOfAdd(MakeFluent(concept_name, "x1", {property}));
  }

  Store store_{":memory:", SmallOntology()};
};

// ---------------------------------------------------------------------------------- valid time

TEST_F(StoreTest, AFluentIsFoundAsItWasSaid) {
  const Fluent mug = MakeFluent("Mug", "mug1",
                                {{"hasPose", "Pose", std::string("poseMug1")},
                                 {"hasColour", "xsd:string", std::string("blue\nand white")},
                                 {"hasCount", "xsd:int", std::int64_t{-3}},
                                 {"isClean", "xsd:boolean", true},
                                 {"isClean", "xsd:boolean", false}});
  const std::vector<Change> changes = store_.Add({mug}, At(5.0, 0, Source::kPerson));
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].sequence, 1u);
  EXPECT_EQ(changes[0].kind, Change::Kind::kAdded);
  EXPECT_EQ(changes[0].time, 5.0);
  EXPECT_EQ(changes[0].source, Source::kPerson);
  Fluent expected = mug;
  expected.start = {5.0, 5.0};
  EXPECT_EQ(changes[0].fluent, expected);
  EXPECT_EQ(store_.Find("mug1"), expected);
  EXPECT_EQ(store_.Find("mug2"), std::nullopt);
}

TEST_F(StoreTest, ALoadedFluentHoldsSinceEver) {
  store_.Add({PoseAt("pose1", 1.0)}, At(-kForever));
  EXPECT_EQ(store_.Find("pose1")->start, (temporal::Bounds{-kForever, -kForever}));
  EXPECT_THAT(QueryAll(store_, HoldsAt(-1e300)), SizeIs(1));
}

TEST_F(StoreTest, AnUpdateEndsTheOldAndOpensTheNew) {
  store_.Add({PoseAt("pose1", 1.0)}, At(10.0));
  const std::vector<Change> changes = store_.Add({PoseAt("pose1", 2.0)}, At(20.0));
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].kind, Change::Kind::kUpdated);
  const std::vector<Fluent> all = QueryAll(store_, Ever());
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0].start, (temporal::Bounds{10.0, 10.0}));
  EXPECT_EQ(all[0].finish, (temporal::Bounds{20.0, 20.0}));
  EXPECT_EQ(all[1].start, (temporal::Bounds{20.0, 20.0}));
  EXPECT_EQ(all[1].finish, (temporal::Bounds{kForever, kForever}));
  EXPECT_THAT(QueryAll(store_, HoldsAt(9.9)), IsEmpty());
  EXPECT_EQ(QueryAll(store_, HoldsAt(10.0)).at(0), all[0]);
  EXPECT_EQ(QueryAll(store_, HoldsAt(19.9)).at(0), all[0]);
  EXPECT_EQ(QueryAll(store_, HoldsAt(20.0)).at(0), all[1]);
  EXPECT_THAT(QueryAll(store_, FluentQuery()), ElementsAre(all[1]));
}

TEST_F(StoreTest, TheSameAgainChangesNothing) {
  store_.Add({PoseAt("pose1", 1.0)}, At(10.0));
  EXPECT_THAT(store_.Add({PoseAt("pose1", 1.0)}, At(20.0)), IsEmpty());
  EXPECT_THAT(store_.Add({PoseAt("pose1", 1.0)}, At(5.0)), IsEmpty());
  EXPECT_EQ(store_.last_sequence(), 1u);
}

TEST_F(StoreTest, AnotherFinishIsAnotherContent) {
  Fluent pose = PoseAt("pose1", 1.0);
  store_.Add({pose}, At(10.0));
  pose.finish = {30.0, 40.0};
  EXPECT_THAT(store_.Add({pose}, At(20.0)), SizeIs(1));
  EXPECT_THAT(QueryAll(store_, HoldsAt(39.0)), SizeIs(1));
  EXPECT_THAT(QueryAll(store_, HoldsAt(40.0)), IsEmpty());
}

TEST_F(StoreTest, WhatRanOutByItselfKeepsItsFinish) {
  Fluent pose = PoseAt("pose1", 1.0);
  pose.finish = {30.0, 40.0};
  store_.Add({pose}, At(10.0));
  store_.Add({PoseAt("pose1", 2.0)}, At(50.0));
  EXPECT_EQ(QueryAll(store_, Ever()).at(0).finish, pose.finish);
  EXPECT_THAT(QueryAll(store_, HoldsAt(45.0)), IsEmpty());
}

TEST_F(StoreTest, AStartBeforeTheAssertionEndsTheOldOneThere) {
  store_.Add({PoseAt("pose1", 1.0)}, At(10.0));
  Fluent seen = PoseAt("pose1", 2.0);
  seen.start = {12.0, 14.0};  // moved between two looks
  store_.Add({seen}, At(14.5));
  EXPECT_EQ(QueryAll(store_, Ever()).at(0).finish, seen.start);
  EXPECT_THAT(QueryAll(store_, HoldsAt(11.0)), SizeIs(1));
  EXPECT_THAT(QueryAll(store_, HoldsAt(13.0)), SizeIs(2));  // either may hold
  EXPECT_THAT(QueryAll(store_, HoldsAt(14.0)), SizeIs(1));
}

TEST_F(StoreTest, AStartAfterTheAssertionLeavesAGap) {
  store_.Add({PoseAt("pose1", 1.0)}, At(10.0));
  Fluent later = PoseAt("pose1", 2.0);
  later.start = {20.0, 20.0};
  store_.Add({later}, At(15.0));
  EXPECT_THAT(QueryAll(store_, HoldsAt(17.0)), IsEmpty());
}

TEST_F(StoreTest, ARemovedInstanceHoldsNoMoreAndCanComeBack) {
  store_.Add({PoseAt("pose1", 1.0)}, At(10.0));
  const std::vector<Change> changes = store_.Remove({"pose1"}, At(20.0));
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].kind, Change::Kind::kRemoved);
  EXPECT_EQ(changes[0].time, 20.0);
  EXPECT_EQ(changes[0].fluent.finish, (temporal::Bounds{20.0, 20.0}));
  EXPECT_EQ(store_.Find("pose1"), std::nullopt);
  EXPECT_EQ(store_.Add({PoseAt("pose1", 1.0)}, At(30.0)).at(0).kind, Change::Kind::kAdded);
  EXPECT_THAT(QueryAll(store_, HoldsAt(15.0)), SizeIs(1));
  EXPECT_THAT(QueryAll(store_, HoldsAt(25.0)), IsEmpty());
  EXPECT_THAT(QueryAll(store_, HoldsAt(35.0)), SizeIs(1));
}

TEST_F(StoreTest, TwoUpdatesAtOnceLeaveOneThatNeverHeld) {
  store_.Add({PoseAt("pose1", 1.0), PoseAt("pose1", 2.0)}, At(10.0));
  EXPECT_THAT(QueryAll(store_, HoldsAt(10.0)), SizeIs(1));
  EXPECT_THAT(QueryAll(store_, Ever()), SizeIs(2));
}

TEST_F(StoreTest, AnUpdateKeepsWhatItDoesNotName) {
  store_.Add({MakeFluent("Mug", "mug1",
                         {{"hasColour", "xsd:string", std::string("blue")},
                          {"hasCount", "xsd:int", std::int64_t{1}},
                          {"hasColour", "xsd:string", std::string("white")}})},
             At(1.0));
  store_.Update({MakeFluent("Mug", "mug1",
                            {{"isClean", "xsd:boolean", true},
                             {"hasColour", "xsd:string", std::string("red")}})},
                At(2.0));
  const std::vector<Property> expected = {{"hasColour", "xsd:string", std::string("red")},
                                          {"hasCount", "xsd:int", std::int64_t{1}},
                                          {"isClean", "xsd:boolean", true}};
  EXPECT_EQ(store_.Find("mug1")->properties, expected);
}

TEST_F(StoreTest, NamesCompareWithoutCaseAndKeepTheirFirstSpelling) {
  store_.Add({PoseAt("poseMug1", 1.0)}, At(1.0));
  EXPECT_EQ(store_.Add({PoseAt("POSEMUG1", 2.0)}, At(2.0)).at(0).fluent.instance, "poseMug1");
  EXPECT_EQ(store_.Find("posemug1")->instance, "poseMug1");
  EXPECT_EQ(store_.Stats().instances, 1u);
  store_.Remove({"PoseMug1"}, At(3.0));
  EXPECT_EQ(store_.Find("poseMug1"), std::nullopt);
}

TEST_F(StoreTest, ChangesAreToldAsTheyWere) {
  std::vector<Change> told;
  const auto keep = [&](std::vector<Change> changes) {
    told.insert(told.end(), changes.begin(), changes.end());
  };
  Fluent ends = PoseAt("pose2", 5.0);
  ends.finish = {7.0, 9.0};
  keep(store_.Add({PoseAt("pose1", 1.0), ends}, At(1.0)));
  keep(store_.Add({PoseAt("pose1", 2.0)}, At(2.0, 0, Source::kPerson)));
  keep(store_.Remove({"pose1", "pose2"}, At(3.0)));
  keep(store_.Add({PoseAt("pose1", 2.0)}, At(4.0)));
  const std::vector<Change> read = store_.ChangesSince(0, 100);
  ASSERT_EQ(read.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(read[i].sequence, i + 1);
    EXPECT_EQ(read[i].sequence, told[i].sequence);
    EXPECT_EQ(read[i].kind, told[i].kind);
    EXPECT_EQ(read[i].fluent, told[i].fluent);
    EXPECT_EQ(read[i].time, told[i].time);
    EXPECT_EQ(read[i].source, told[i].source);
  }
  EXPECT_THAT(store_.ChangesSince(2, 2), SizeIs(2));
  EXPECT_EQ(store_.ChangesSince(2, 2).front().sequence, 3u);
  EXPECT_THAT(store_.ChangesSince(store_.last_sequence(), 9), IsEmpty());
  EXPECT_THAT(store_.ChangesSince(std::numeric_limits<std::uint64_t>::max(), 9), IsEmpty());
}

TEST_F(StoreTest, StatisticsCount) {
  store_.Add({PoseAt("pose1", 1.0), PoseAt("pose2", 1.0)}, At(1.0));
  store_.Add({PoseAt("pose1", 2.0)}, At(2.0));
  store_.Remove({"pose2"}, At(3.0));
  store_.StartEpisode("Serve guest1", Episode::Label::kReal, 0, 4.0);
  const Store::Statistics statistics = store_.Stats();
  EXPECT_EQ(statistics.fluents, 3u);
  EXPECT_EQ(statistics.instances, 2u);
  EXPECT_EQ(statistics.changes, 4u);
  EXPECT_EQ(statistics.episodes, 1u);
  EXPECT_GT(statistics.bytes, 0u);
  EXPECT_EQ(statistics.schema, 4);
}

// ------------------------------------------------------------------------------------ bad input

TEST_F(StoreTest, ABatchWithOneMistakeLeavesNothing) {
  EXPECT_THAT(ErrorOf([&] {
                store_.Add({PoseAt("pose1", 1.0), MakeFluent("Mugg", "mug1")}, At(1.0));
              }),
              AllOf(HasSubstr("'mug1'"), HasSubstr("'Mugg'"), HasSubstr("did you mean 'Mug'")));
  EXPECT_EQ(store_.Find("pose1"), std::nullopt);
  store_.Add({PoseAt("pose1", 1.0)}, At(1.0));  // still works, and numbers go on without a gap
  EXPECT_EQ(store_.last_sequence(), 1u);
}

TEST_F(StoreTest, AnUnknownRelationNamesTheNearest) {
  EXPECT_THAT(ErrorOfProperty("Pose", {"hasXX", "xsd:float", 1.0}),
              AllOf(HasSubstr("'hasXX'"), HasSubstr("'hasX'"), HasSubstr("'x1'")));
}

TEST_F(StoreTest, APropertyOfAnotherConceptIsRefused) {
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasX", "xsd:float", 1.0}),
              AllOf(HasSubstr("'hasX'"), HasSubstr("wanted a Pose")));
}

TEST_F(StoreTest, ALinkMustBeOfTheRangeOrBelow) {
  EXPECT_EQ(ErrorOfProperty("On", {"hasArea", "Mug", std::string("mug1")}),
            "fluent 'x1' of On, property 'hasArea': links to a Mug, the relation wants Area");
  store_.Add({MakeFluent("On", "on1", {{"hasObject", "Mug", std::string("mug1")}})}, At(0.0));
}

TEST_F(StoreTest, AValueMustBeOfItsKind) {
  EXPECT_THAT(ErrorOfProperty("Pose", {"hasX", "xsd:string", std::string("1")}),
              HasSubstr("given as xsd:string, the relation wants xsd:float"));
  EXPECT_THAT(ErrorOfProperty("Pose", {"hasX", "xsd:float", std::string("1")}),
              HasSubstr("the text '1', which is no xsd:float"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasCount", "xsd:int", 1.5}),
              HasSubstr("the number 1.5, which is no xsd:int"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasCount", "xsd:float", 1.5}), HasSubstr("xsd:int"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasCount", "xsd:int", std::int64_t{1} << 40}),
              HasSubstr("32 bits"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasColour", "xsd:colour", std::string("red")}),
              HasSubstr("'xsd:colour' is unknown"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasPose", "xsd:string", std::string("p")}),
              HasSubstr("the relation wants Pose"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasPose", "Pose", true}), HasSubstr("wanted the name"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasPose", "Posse", std::string("p")}),
              HasSubstr("did you mean 'Pose'"));
  EXPECT_THAT(ErrorOfProperty("Pose", {"hasX", "xsd:float", std::nan("")}), HasSubstr("finite"));
  EXPECT_THAT(ErrorOfProperty("Pose", {"hasX", "xsd:float", kForever}), HasSubstr("finite"));
}

TEST_F(StoreTest, AnIntegerIsANumber) {
  store_.Add({MakeFluent("Pose", "pose1", {{"hasX", "xsd:float", std::int64_t{2}}}),
              MakeFluent("Pose", "pose2", {{"hasX", "xsd:integer", std::int64_t{2}}}),
              MakeFluent("Pose", "pose3", {{"hasX", "xsd:double", 2.0}})},
             At(0.0));
  FluentQuery query;
  query.properties = {{"hasX", Filler(2.0)}};
  EXPECT_THAT(QueryAll(store_, query), SizeIs(3));
}

TEST_F(StoreTest, AFunctionalPropertyIsGivenOnce) {
  EXPECT_THAT(
      ErrorOfAdd(MakeFluent("Pose", "p", {{"hasX", "xsd:float", 1.0}, {"hasX", "xsd:float", 2.0}})),
      HasSubstr("only one"));
}

TEST_F(StoreTest, TextTooLongOrBrokenIsRefused) {
  const std::string big(std::size_t{10} << 20, 'a');
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasColour", "xsd:string", big}),
              AllOf(HasSubstr("10485760 bytes, at most 1048576"), SizeIs(::testing::Lt(300u))));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasColour", "xsd:string", std::string("\xff")}),
              HasSubstr("UTF-8"));
  EXPECT_THAT(ErrorOfAdd(PoseAt(big, 1.0)), SizeIs(::testing::Lt(300u)));
  EXPECT_THAT(ErrorOfAdd(PoseAt("", 1.0)), HasSubstr("empty"));
  EXPECT_THAT(ErrorOfAdd(PoseAt("a\nb", 1.0)), HasSubstr("control character"));
  EXPECT_THAT(ErrorOfAdd(PoseAt("a\xc3", 1.0)), HasSubstr("UTF-8"));
  EXPECT_THAT(ErrorOfProperty("Mug", {"hasPose", "Pose", std::string("a\tb")}),
              HasSubstr("control character"));
  const std::string most(1000, 'a');
  store_.Add({PoseAt(most, 1.0)}, At(0.0));
  EXPECT_EQ(store_.Find(most)->instance, most);
  EXPECT_THAT(ErrorOfAdd(PoseAt(most + "a", 1.0)), HasSubstr("1001 bytes"));
}

TEST_F(StoreTest, TooManyPropertiesAreRefused) {
  const Property count{"hasCount", "xsd:int", std::int64_t{1}};
  store_.Add({MakeFluent("Mug", "mug1", std::vector<Property>(1000, count))}, At(0.0));
  EXPECT_THAT(ErrorOfAdd(MakeFluent("Mug", "mug2", std::vector<Property>(1001, count))),
              HasSubstr("1001 properties, at most 1000"));
  const Property text{"hasColour", "xsd:string", std::string(std::size_t{1} << 20, 'a')};
  EXPECT_THAT(ErrorOfAdd(MakeFluent("Mug", "mug2", std::vector<Property>(9, text))),
              HasSubstr("at most 8388608"));
}

TEST_F(StoreTest, ImpossibleTimesAreRefused) {
  store_.Add({PoseAt("pose1", 1.0)}, At(10.0));
  EXPECT_THAT(ErrorOfAdd(PoseAt("pose1", 2.0), At(9.0)),
              AllOf(HasSubstr("'pose1'"), HasSubstr("10 s"), HasSubstr("9 s")));
  EXPECT_THAT(ErrorOf([&] { store_.Remove({"pose1"}, At(9.0)); }),
              AllOf(HasSubstr("10 s"), HasSubstr("9 s")));
  Fluent fluent = PoseAt("pose2", 1.0);
  fluent.start = {5.0, 4.0};
  EXPECT_THAT(ErrorOfAdd(fluent), HasSubstr("start between 5 and 4"));
  fluent.start = {std::nan(""), 4.0};
  EXPECT_THAT(ErrorOfAdd(fluent), HasSubstr("start"));
  fluent.start = {5.0, 5.0};
  fluent.finish = {1.0, 4.0};
  EXPECT_THAT(ErrorOfAdd(fluent), AllOf(HasSubstr("end at 4"), HasSubstr("begins at 5")));
  fluent.finish = {-kForever, -kForever};
  EXPECT_THAT(ErrorOfAdd(fluent), HasSubstr("end"));
  EXPECT_THAT(ErrorOfAdd(PoseAt("pose2", 1.0), At(kForever)), HasSubstr("inf"));
  EXPECT_THAT(ErrorOfAdd(PoseAt("pose2", 1.0), At(std::nan(""))), HasSubstr("nan"));
  store_.Remove({"pose1"}, At(20.0));
  EXPECT_THAT(ErrorOfAdd(PoseAt("pose1", 2.0), At(15.0)),
              AllOf(HasSubstr("ended at 20 s"), HasSubstr("15 s")));
}

TEST_F(StoreTest, WhatDoesNotHoldIsNotUpdatedNorRemoved) {
  EXPECT_THAT(ErrorOf([&] { store_.Update({PoseAt("pose1", 1.0)}, At(1.0)); }),
              AllOf(HasSubstr("'pose1'"), HasSubstr("does not hold")));
  EXPECT_THAT(ErrorOf([&] { store_.Remove({"pose1"}, At(1.0)); }), HasSubstr("does not hold"));
  store_.Add({PoseAt("pose1", 1.0)}, At(1.0));
  EXPECT_THAT(ErrorOf([&] {
                store_.Remove({"pose1", "pose1"}, At(2.0));
              }),
              HasSubstr("does not hold"));
  EXPECT_TRUE(store_.Find("pose1").has_value());
}

// ------------------------------------------------------------------------------- who says so

TEST_F(StoreTest, TheMonitorTellsOfItsDoingOnly) {
  const Assertion by = At(1.0, 0, Source::kMonitor);
  store_.Add({MakeFluent("RobotActivity", "drive1")}, by);
  EXPECT_THAT(ErrorOfAdd(PoseAt("pose1", 1.0), by), HasSubstr("write this as an observation"));
  EXPECT_THAT(ErrorOfAdd(MakeFluent("On", "on1"), by), HasSubstr("ExecutionRecord"));
}

TEST_F(StoreTest, TheMonitorCannotEndWhatWasObserved) {
  store_.Add({PoseAt("pose1", 1.0)}, At(0.0));
  const Assertion by = At(1.0, 0, Source::kMonitor);
  EXPECT_THAT(ErrorOfAdd(MakeFluent("RobotActivity", "pose1"), by), HasSubstr("of Pose"));
  EXPECT_THAT(ErrorOf([&] { store_.Remove({"pose1"}, by); }), HasSubstr("of Pose"));
}

// ---------------------------------------------------------------------------------- episodes

TEST_F(StoreTest, EpisodesStartAndFinish) {
  const Episode first = store_.StartEpisode("Serve guest1", Episode::Label::kReal, 0, 1447670645.7);
  EXPECT_EQ(first.id, 1);
  EXPECT_EQ(first.name, "2015-11-16T10:44:05");
  const Episode second = store_.StartEpisode("", Episode::Label::kImagined, 1, 1447670645.9);
  EXPECT_EQ(second.name, "2015-11-16T10:44:05-2");
  EXPECT_EQ(second.parent, 1);
  const Episode done = store_.FinishEpisode(1, "succeeded", 1447670700.0);
  EXPECT_EQ(done.outcome, "succeeded");
  const std::vector<Episode> all = store_.Episodes();
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0].finish, 1447670700.0);
  EXPECT_EQ(all[0].task, "Serve guest1");
  EXPECT_EQ(all[1].finish, kForever);
  EXPECT_EQ(all[1].label, Episode::Label::kImagined);
  EXPECT_EQ(store_.FindEpisode("2")->name, second.name);
  EXPECT_EQ(store_.FindEpisode(first.name)->id, 1);
  EXPECT_FALSE(store_.FindEpisode("3").has_value());
  EXPECT_FALSE(store_.FindEpisode("99999999999999999999").has_value());
  EXPECT_FALSE(store_.FindEpisode("").has_value());
}

TEST_F(StoreTest, BadEpisodesAreRefused) {
  EXPECT_THAT(ErrorOfAdd(PoseAt("pose1", 1.0), At(1.0, 7)), HasSubstr("no episode 7"));
  const auto start = [&](const std::string& task, std::int64_t parent, double time) {
    return ErrorOf([&] { store_.StartEpisode(task, Episode::Label::kReal, parent, time); });
  };
  EXPECT_THAT(start("task", 7, 1.0), HasSubstr("no episode 7"));
  EXPECT_THAT(start("a\nb", 0, 1.0), HasSubstr("control character"));
  for (const double time : {-1.0, std::nan(""), kForever, 1e300}) {
    EXPECT_THAT(start("task", 0, time), HasSubstr("cannot start")) << time;
  }
  store_.StartEpisode("task", Episode::Label::kReal, 0, 5.0);
  EXPECT_THAT(ErrorOf([&] { store_.FinishEpisode(1, "succeeded", 4.0); }), HasSubstr("4 s"));
  EXPECT_THAT(ErrorOf([&] { store_.FinishEpisode(1, "", 6.0); }), HasSubstr("outcome"));
  EXPECT_THAT(ErrorOf([&] { store_.FinishEpisode(2, "succeeded", 6.0); }), HasSubstr("episode 2"));
  store_.FinishEpisode(1, "succeeded", 6.0);
  EXPECT_THAT(ErrorOf([&] { store_.FinishEpisode(1, "failed", 7.0); }),
              HasSubstr("finished already"));
  EXPECT_THAT(ErrorOfAdd(PoseAt("pose1", 1.0), At(7.0, 1)), HasSubstr("finished at 6 s"));
}

TEST_F(StoreTest, ImaginedFluentsDoNotMixWithRealOnes) {
  const std::int64_t imagined =
      store_.StartEpisode("imagine", Episode::Label::kImagined, 0, 1.0).id;
  store_.Add({PoseAt("pose1", 1.0)}, At(1.0));
  EXPECT_EQ(store_.Add({PoseAt("pose1", 7.0)}, At(2.0, imagined)).at(0).kind, Change::Kind::kAdded);
  EXPECT_EQ(store_.ChangesSince(1, 1).at(0).label, Episode::Label::kImagined);
  EXPECT_EQ(store_.Find("pose1")->properties, PoseAt("", 1.0).properties);
  for (FluentQuery query : {FluentQuery(), Ever(), HoldsAt(3.0)}) {
    ASSERT_THAT(QueryAll(store_, query), SizeIs(1));
    EXPECT_EQ(QueryAll(store_, query)[0].properties, PoseAt("", 1.0).properties);
    query.episode = imagined;
    ASSERT_THAT(QueryAll(store_, query), SizeIs(1));
    EXPECT_EQ(QueryAll(store_, query)[0].properties, PoseAt("", 7.0).properties);
    query.episode.reset();
    query.label = Episode::Label::kImagined;
    EXPECT_THAT(QueryAll(store_, query), SizeIs(1));
    query.label.reset();
    EXPECT_THAT(QueryAll(store_, query), SizeIs(2));
  }
  EXPECT_THAT(ErrorOf([&] { store_.Remove({"pose2"}, At(3.0, imagined)); }),
              HasSubstr("imagined episode"));
  store_.Remove({"pose1"}, At(3.0, imagined));
  EXPECT_TRUE(store_.Find("pose1").has_value());
}

}  // namespace
}  // namespace hires::knowledge::store_test
