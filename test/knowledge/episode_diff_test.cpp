#include "hires/knowledge/episode_diff.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/knowledge/episode_diff_report.h"
#include "knowledge/support/store_world.h"
#include "support/property.h"

namespace hires::knowledge::episode_diff_test {
namespace {

using test_support::At;
using test_support::MakeFluent;
using test_support::PoseAt;
using test_support::SmallOntology;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::ThrowsMessage;
using Verdict = InstanceDiff::Verdict;

constexpr test_support::PropertyCases kPropertyCases{200, 30};

Fluent Mug(const std::string& instance, const std::string& colour) {
  return MakeFluent("Mug", instance, {{"hasColour", "xsd:string", colour}});
}

Fluent OnArea(const std::string& area) {
  return MakeFluent("On", "onMug1", {{"hasObject", "Mug", "mug1"}, {"hasArea", "Area", area}});
}

const InstanceDiff& Of(const EpisodeDiff& diff, const std::string& instance) {
  const auto found = std::find_if(diff.instances.begin(), diff.instances.end(),
                                  [&](const auto& one) { return one.instance == instance; });
  if (found == diff.instances.end()) throw std::runtime_error(instance + " is not in the diff");
  return *found;
}

/// A real episode from 100 s on and an imagined child of it from 200 s on.
class EpisodeDiffTest : public ::testing::Test {
 protected:
  EpisodeDiff Diff(const EpisodeDiffOptions& options = {}) const {
    return Compare(store_, real_, dream_, options);
  }
  void Real(const Fluent& fluent, double after) {
    store_.Add({fluent}, At(100.0 + after, real_.id));
  }
  void Dreamt(const Fluent& fluent, double after) {
    store_.Add({fluent}, At(200.0 + after, dream_.id));
  }

  Store store_{":memory:", SmallOntology()};
  Episode real_ = store_.StartEpisode("serve", Episode::Label::kReal, 0, 100.0);
  Episode dream_ = store_.StartEpisode("serve", Episode::Label::kImagined, real_.id, 200.0);
};

TEST_F(EpisodeDiffTest, EmptyEpisodesAreTheSame) {
  const EpisodeDiff diff = Diff();
  EXPECT_THAT(diff.instances, IsEmpty());
  EXPECT_TRUE(diff.Same());
  EXPECT_EQ(diff.a.id, real_.id);
  EXPECT_EQ(diff.b.id, dream_.id);
}

TEST_F(EpisodeDiffTest, WhatCameTrueAtTheSameTimesIsTheSame) {
  for (const double after : {1.0, 2.5}) {
    Real(PoseAt("pose1", after), after);
    Dreamt(PoseAt("pose1", after), after);
  }
  const EpisodeDiff diff = Diff();
  EXPECT_TRUE(diff.Same());
  ASSERT_EQ(Of(diff, "pose1").changes.size(), 2u);
  EXPECT_EQ(Of(diff, "pose1").changes[1].a->time, 2.5) << "since the episode's own start";
  EXPECT_EQ(Of(diff, "pose1").changes[1].b->time, 2.5);
}

TEST_F(EpisodeDiffTest, TellsWhatIsInOneOfThemOnly) {
  Real(Mug("broken", "red"), 1.0);
  Dreamt(Mug("served", "red"), 1.0);
  const EpisodeDiff diff = Diff();
  EXPECT_EQ(Of(diff, "broken").verdict, Verdict::kOnlyInA);
  EXPECT_EQ(Of(diff, "served").verdict, Verdict::kOnlyInB);
  EXPECT_FALSE(diff.Same());
  EXPECT_EQ(diff.Count(Verdict::kOnlyInA), 1u);
  EXPECT_EQ(diff.Count(Verdict::kSame), 0u);
}

TEST_F(EpisodeDiffTest, OtherEpisodesAndWhatIsOutsideOfAnyDoNotCount) {
  const Episode other = store_.StartEpisode("clear", Episode::Label::kReal, 0, 100.0);
  store_.Add({Mug("m1", "red")}, At(101.0, other.id));
  store_.Add({Mug("m2", "red")}, At(101.0));
  EXPECT_THAT(Diff().instances, IsEmpty());
}

TEST_F(EpisodeDiffTest, NamesThePropertiesThatDiffer) {
  Real(MakeFluent("Mug", "mug1",
                  {{"hasCount", "xsd:int", std::int64_t{2}}, {"hasColour", "xsd:string", "red"}}),
       1.0);
  Dreamt(MakeFluent("Mug", "mug1",
                    {{"isClean", "xsd:boolean", true},
                     {"hasColour", "xsd:string", "Red"},
                     {"hasCount", "xsd:int", std::int64_t{2}}}),
         1.0);
  const InstanceDiff mug = Of(Diff(), "mug1");
  EXPECT_EQ(mug.verdict, Verdict::kDiffering);
  ASSERT_EQ(mug.changes.size(), 1u);
  const auto& differences = mug.changes[0].differences;
  ASSERT_EQ(differences.size(), 2u) << "by role; the order of roles does not count";
  EXPECT_EQ(differences[0].role, "hasColour");
  EXPECT_THAT(differences[0].a, ElementsAre(Filler(std::string("red"))));
  EXPECT_THAT(differences[0].b, ElementsAre(Filler(std::string("Red")))) << "text is exact";
  EXPECT_EQ(differences[1].role, "isClean");
  EXPECT_THAT(differences[1].a, IsEmpty());
}

TEST_F(EpisodeDiffTest, LinksCompareByNameAndConceptsCount) {
  Real(MakeFluent("On", "on1", {{"hasObject", "Mug", "mug1"}}), 1.0);
  Dreamt(MakeFluent("On", "on1", {{"hasObject", "Object", "MUG1"}}), 1.0);
  Real(Mug("thing", "red"), 1.0);
  Dreamt(MakeFluent("Vase", "thing", {{"hasColour", "xsd:string", "red"}}), 1.0);
  const EpisodeDiff diff = Diff();
  EXPECT_EQ(Of(diff, "on1").verdict, Verdict::kSame);
  EXPECT_EQ(Of(diff, "thing").verdict, Verdict::kDiffering);
  EXPECT_TRUE(Of(diff, "thing").changes.at(0).other_concept);
}

TEST_F(EpisodeDiffTest, NumbersHaveATolerancePerRole) {
  const auto pose = [](double x, double y) {
    return MakeFluent("Pose", "pose1", {{"hasX", "xsd:float", x}, {"hasY", "xsd:float", y}});
  };
  Real(pose(1.0, 2.0), 1.0);
  Dreamt(pose(1.25, 2.25), 1.0);
  EpisodeDiffOptions options;
  EXPECT_EQ(Of(Diff(options), "pose1").changes.at(0).differences.size(), 2u);
  options.tolerances["hasX"] = 0.25;
  const auto differences = Of(Diff(options), "pose1").changes.at(0).differences;
  ASSERT_EQ(differences.size(), 1u);
  EXPECT_EQ(differences[0].role, "hasY");
  options.tolerance = 0.2;
  EXPECT_EQ(Of(Diff(options), "pose1").verdict, Verdict::kDiffering);
  options.tolerance = 0.25;
  EXPECT_EQ(Of(Diff(options), "pose1").verdict, Verdict::kSame);
}

TEST_F(EpisodeDiffTest, AWholeTurnIsNoDifferenceOfAngles) {
  Real(PoseAt("pose1", 3.14), 1.0);
  Dreamt(PoseAt("pose1", -3.14), 1.0);
  EpisodeDiffOptions options;
  options.tolerances["hasX"] = 0.01;  // 2 pi - 6.28 = 0.0032
  EXPECT_EQ(Of(Diff(options), "pose1").verdict, Verdict::kDiffering);
  options.angles = {"hasX"};
  EXPECT_EQ(Of(Diff(options), "pose1").verdict, Verdict::kSame);
}

TEST_F(EpisodeDiffTest, ToleratesNoNonsense) {
  EpisodeDiffOptions options;
  options.tolerances["hasX"] = -0.1;
  EXPECT_THAT([&] { Diff(options); },
              ThrowsMessage<base::ConfigError>(HasSubstr("tolerance of hasX is -0.1")));
  options = {};
  options.time_tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { Diff(options); },
              ThrowsMessage<base::ConfigError>(HasSubstr("wanted 0 or more")));
}

TEST_F(EpisodeDiffTest, TellsHowMuchLaterAChangeCame) {
  Real(Mug("mug1", "red"), 4.0);
  Dreamt(Mug("mug1", "red"), 2.5);
  EpisodeDiffOptions options;
  const EpisodeDiff diff = Diff(options);
  EXPECT_EQ(Of(diff, "mug1").changes.at(0).delay, -1.5);
  EXPECT_EQ(Of(diff, "mug1").verdict, Verdict::kSame) << "times are told apart from content";
  EXPECT_EQ(diff.num_late(), 1u);
  EXPECT_FALSE(diff.Same());
  options.time_tolerance = 1.5;
  EXPECT_EQ(Diff(options).num_late(), 0u);
}

TEST_F(EpisodeDiffTest, KnowledgeSinceEverIsOnTime) {
  constexpr double kSinceEver = -std::numeric_limits<double>::infinity();
  store_.Add({Mug("mug1", "red")}, {Source::kKnowledge, real_.id, kSinceEver});
  store_.Add({Mug("mug1", "red")}, {Source::kKnowledge, dream_.id, kSinceEver});
  EXPECT_TRUE(Diff().Same());
  EXPECT_EQ(Of(Diff(), "mug1").changes.at(0).delay, 0.0);
}

TEST_F(EpisodeDiffTest, TheEndOfWhatHeldBeforeTheEpisodeIsSeen) {
  store_.Add({OnArea("counter")}, At(50.0));
  store_.Remove({"onMug1"}, At(107.0, real_.id));
  Dreamt(OnArea("counter"), 0.0);  // an imagined world knows nothing from before
  store_.Remove({"onMug1"}, At(205.0, dream_.id));
  const EpisodeDiff diff = Diff();
  const InstanceDiff& on = Of(diff, "onMug1");
  ASSERT_EQ(on.changes.size(), 2u);
  EXPECT_FALSE(on.changes[0].a) << "what was told to the imagined world to begin with";
  EXPECT_TRUE(on.changes[1].SameContent());
  EXPECT_EQ(on.changes[1].delay, -2.0);
}

TEST_F(EpisodeDiffTest, LinesUpChangesSoThatFewDiffer) {
  for (const double x : {1.0, 2.0, 3.0, 4.0}) Real(PoseAt("pose1", x), x);
  for (const double x : {1.0, 3.0, 4.0, 5.0}) Dreamt(PoseAt("pose1", x), x);
  const InstanceDiff pose = Of(Diff(), "pose1");
  ASSERT_EQ(pose.changes.size(), 5u);
  EXPECT_FALSE(pose.changes[1].b) << "2 m is only real";
  EXPECT_TRUE(pose.changes[2].SameContent());
  EXPECT_FALSE(pose.changes[4].a) << "5 m is only imagined";
}

TEST_F(EpisodeDiffTest, AddedAndUpdatedAreOneKindAndRemovedIsAnother) {
  store_.Add({Mug("mug1", "red"), Mug("mug2", "red")}, At(50.0));
  Real(Mug("mug1", "blue"), 1.0);  // an update of what was known
  Dreamt(Mug("mug1", "blue"), 1.0);
  store_.Remove({"mug2"}, At(101.0, real_.id));
  Dreamt(Mug("mug2", "red"), 1.0);
  const EpisodeDiff diff = Diff();
  EXPECT_EQ(Of(diff, "mug1").verdict, Verdict::kSame);
  EXPECT_EQ(Of(diff, "mug1").changes.at(0).a->kind, Change::Kind::kUpdated);
  EXPECT_EQ(Of(diff, "mug2").verdict, Verdict::kDiffering);
  EXPECT_EQ(Of(diff, "mug2").changes.size(), 2u);
}

TEST_F(EpisodeDiffTest, FindsTheFewestChangesThatCameInAnotherOrder) {
  const std::vector<std::string> names = {"a", "b", "c", "d"};
  const std::vector<std::string> dreamt = {"d", "a", "b", "c"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    Real(Mug(names[i], "red"), 1.0 * static_cast<double>(i));
    Dreamt(Mug(dreamt[i], "red"), 1.0 * static_cast<double>(i));
  }
  const EpisodeDiff diff = Diff();
  EXPECT_EQ(diff.num_out_of_order(), 1u);
  EXPECT_TRUE(Of(diff, "d").changes.at(0).out_of_order);
  EXPECT_EQ(Of(diff, "d").changes.at(0).a->moment, 4u);
  EXPECT_EQ(Of(diff, "d").changes.at(0).b->moment, 1u);
}

TEST_F(EpisodeDiffTest, ChangesOfOneMomentHaveNoOrder) {
  store_.Add({Mug("a", "red"), Mug("b", "red")}, At(101.0, real_.id));
  Dreamt(Mug("b", "red"), 1.0);
  Dreamt(Mug("a", "red"), 2.0);
  EXPECT_EQ(Diff().num_out_of_order(), 0u);
  EXPECT_EQ(Compare(store_, dream_, real_).num_out_of_order(), 0u);
}

TEST_F(EpisodeDiffTest, LongHistoriesPairByNumber) {
  std::vector<Change> a, b;
  for (int i = 0; i < 1200; ++i) {
    Change change;
    change.fluent = PoseAt("pose1", i);
    change.time = 100.0 + i;
    a.push_back(change);
    change.fluent = PoseAt("pose1", i + 1);  // the last 1199 of a are the first of b
    change.time = 200.0 + i;
    b.push_back(change);
  }
  const EpisodeDiff diff = Compare(real_, a, dream_, b);
  EXPECT_EQ(Of(diff, "pose1").changes.size(), 1200u);
  a.resize(900);
  b.resize(900);
  EXPECT_EQ(Of(Compare(real_, a, dream_, b), "pose1").changes.size(), 901u) << "short: lined up";
}

// Text --------------------------------------------------------------------------------------------

class EpisodeDiffTextTest : public EpisodeDiffTest {
 protected:
  void SetUp() override {
    Real(PoseAt("pose1", 1.0), 0.0);
    Real(OnArea("table1"), 12.5);
    Real(Mug("mug9", "red"), 13.0);
    Dreamt(PoseAt("pose1", 1.0), 0.0);
    Dreamt(OnArea("trayArea1"), 10.0);
    real_ = store_.FinishEpisode(real_.id, "failed", 120.0);
  }
};

TEST_F(EpisodeDiffTextTest, TableShowsWhatIsNotAsItWasPredicted) {
  EXPECT_EQ(ToTable(Diff()),
            "a: episode 1 (1970-01-01T00:01:40), real, task 'serve', outcome 'failed' after "
            "20.000 s\n"
            "b: episode 2 (1970-01-01T00:03:20), imagined, task 'serve', running\n"
            "instance  change  time a  time b   delay  a | b\n"
            "mug9      added   13.000       -       -  only in a\n"
            "onMug1    added   12.500  10.000  -2.500  hasArea table1 | trayArea1; earlier in b\n"
            "instances: 1 same, 1 differing, 1 only in a, 0 only in b; changes: 1 late, 0 out of "
            "order\n");
  EXPECT_THAT(ToTable(Diff(), true), HasSubstr("pose1     added    0.000   0.000  +0.000  same\n"));
}

TEST_F(EpisodeDiffTextTest, JsonHoldsAllOfIt) {
  const auto json = nlohmann::json::parse(ToJson(Diff()));
  EXPECT_EQ(json["a"]["outcome"], "failed");
  EXPECT_EQ(json["b"]["label"], "imagined");
  EXPECT_EQ(json["b"]["parent"], real_.id);
  EXPECT_TRUE(json["b"]["finish"].is_null()) << "it runs";
  EXPECT_EQ(json["summary"]["differing"], 1);
  ASSERT_EQ(json["instances"].size(), 3u);
  EXPECT_EQ(json["instances"][0]["verdict"], "only_in_a");
  EXPECT_TRUE(json["instances"][0]["changes"][0]["b"].is_null());
  const auto on = json["instances"][1]["changes"][0];
  EXPECT_EQ(on["a"]["time"], 12.5);
  EXPECT_EQ(on["delay"], -2.5);
  EXPECT_EQ(on["differences"],
            nlohmann::json::parse(R"([{"role": "hasArea", "a": ["table1"], "b": ["trayArea1"]}])"));
}

// Properties --------------------------------------------------------------------------------------

/// Changes of a few instances at times that may coincide.
std::vector<Change> AnyChanges() {
  const auto change = rc::gen::map(rc::gen::tuple(rc::gen::inRange(0, 3), rc::gen::inRange(0, 3),
                                                  rc::gen::inRange(0, 9), rc::gen::inRange(0, 4)),
                                   [](const std::tuple<int, int, int, int>& numbers) {
                                     Change one;
                                     const auto [name, x, time, kind] = numbers;
                                     one.fluent = PoseAt("pose" + std::to_string(name), x);
                                     one.time = time;
                                     if (kind == 0) one.kind = Change::Kind::kRemoved;
                                     return one;
                                   });
  return *rc::gen::container<std::vector<Change>>(change);
}

HIRES_PROPERTY(EpisodeDiffProperty, AnEpisodeIsTheSameAsItself, ()) {
  const std::vector<Change> changes = AnyChanges();
  RC_ASSERT(Compare({}, changes, {}, changes).Same());
}

HIRES_PROPERTY(EpisodeDiffProperty, EveryChangeIsToldOnceAndInItsOrder, ()) {
  const std::vector<Change> a = AnyChanges(), b = AnyChanges();
  const EpisodeDiff diff = Compare({}, a, {}, b);
  for (const InstanceDiff& instance : diff.instances) {
    std::vector<Fluent> told_a, told_b, all_a, all_b;
    for (const ComparedChange& change : instance.changes) {
      RC_ASSERT(change.a || change.b);
      if (change.a) told_a.push_back(change.a->fluent);
      if (change.b) told_b.push_back(change.b->fluent);
    }
    for (const Change& change : a) {
      if (change.fluent.instance == instance.instance) all_a.push_back(change.fluent);
    }
    for (const Change& change : b) {
      if (change.fluent.instance == instance.instance) all_b.push_back(change.fluent);
    }
    RC_ASSERT(told_a == all_a);
    RC_ASSERT(told_b == all_b);
  }
}

HIRES_PROPERTY(EpisodeDiffProperty, TheOtherWayRoundFindsAsMuch, ()) {
  const std::vector<Change> a = AnyChanges(), b = AnyChanges();
  const auto cost = [](const EpisodeDiff& diff) {
    std::size_t changes = 0;
    for (const InstanceDiff& instance : diff.instances) {
      for (const ComparedChange& change : instance.changes) changes += change.SameContent() ? 0 : 1;
    }
    return changes;
  };
  const EpisodeDiff there = Compare({}, a, {}, b), back = Compare({}, b, {}, a);
  RC_ASSERT(cost(there) == cost(back));
  RC_ASSERT(there.Count(Verdict::kOnlyInA) == back.Count(Verdict::kOnlyInB));
  RC_ASSERT(there.Count(Verdict::kSame) == back.Count(Verdict::kSame));
}

HIRES_PROPERTY(EpisodeDiffProperty, WhatIsInOrderRisesInBothEpisodes, ()) {
  const EpisodeDiff diff = Compare({}, AnyChanges(), {}, AnyChanges());
  std::vector<std::pair<std::size_t, std::size_t>> moments;
  for (const InstanceDiff& instance : diff.instances) {
    for (const ComparedChange& change : instance.changes) {
      if (!change.InBoth() || change.out_of_order) continue;
      moments.emplace_back(change.a->moment, change.b->moment);
    }
  }
  std::sort(moments.begin(), moments.end());
  RC_ASSERT(std::is_sorted(moments.begin(), moments.end(), [](const auto& one, const auto& other) {
    return one.second < other.second;
  }));
}

}  // namespace
}  // namespace hires::knowledge::episode_diff_test
