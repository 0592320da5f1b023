#include "knowledge/query/query_conditions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "knowledge/support/store_world.h"
#include "support/messages.h"

namespace hires::knowledge::query_conditions_test {
namespace {

using temporal::Allen;
using temporal::kForever;
using test_support::ConfigErrorOf;
using test_support::MakeFluent;
using test_support::SmallOntology;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using TimeFilter = FluentQuery::TimeFilter;

TEST(ConceptSetTest, ContainsWhatWasPutIn) {
  ConceptSet concepts;
  EXPECT_TRUE(concepts.empty());
  for (const std::int64_t number : {7, 2, 7}) concepts.Insert(number);
  EXPECT_TRUE(concepts.Contains(7));
  EXPECT_FALSE(concepts.Contains(3));
  EXPECT_FALSE(concepts.Contains(1000));
  EXPECT_THAT(concepts.Numbers(), ElementsAre(2, 7));
}

TEST(WorldRangeTest, IsAllOrSomeOrOne) {
  EXPECT_TRUE(WorldRange().Contains(0));
  EXPECT_FALSE((WorldRange{1, 5}).Contains(0));
  EXPECT_FALSE((WorldRange{1, 5}).IsOne());
  EXPECT_TRUE((WorldRange{3, 3}).IsOne());
}

TimeFilter ToInterval(double start, double finish, const std::vector<Allen>& relations) {
  TimeFilter time;
  time.kind = TimeFilter::Kind::kAllen;
  time.interval = {start, finish};
  time.relations = relations;
  return time;
}

void ExpectReach(const TimeFilter& time, double earliest_finish, double latest_start) {
  const TimeReach reach = ReachOf(time);
  EXPECT_EQ(reach.earliest_finish, earliest_finish);
  EXPECT_EQ(reach.latest_start, latest_start);
}

TEST(TimeReachTest, IsAllTimeOrAMomentOrWhatTheRelationsLeave) {
  TimeFilter at;
  ExpectReach(at, -kForever, kForever);
  at.kind = TimeFilter::Kind::kAt;
  at.at = 4.0;
  ExpectReach(at, 4.0, 4.0);
  ExpectReach(ToInterval(10.0, 20.0, {Allen::kDuring}), 10.0, 20.0);
  ExpectReach(ToInterval(10.0, 20.0, {Allen::kMeets}), std::nextafter(10.0, 0.0), 20.0);
  ExpectReach(ToInterval(10.0, 20.0, {Allen::kMeets, Allen::kBefore}), -kForever, 20.0);
  ExpectReach(ToInterval(10.0, 20.0, {Allen::kAfter}), 10.0, kForever);
}

TEST(TimeReachTest, RefusesATimeThatIsNone) {
  TimeFilter at;
  at.kind = TimeFilter::Kind::kAt;
  at.at = std::nan("");
  EXPECT_THAT(ConfigErrorOf([&] { ReachOf(at); }), HasSubstr("NaN"));
  EXPECT_THAT(ConfigErrorOf([&] { ReachOf(ToInterval(2.0, 2.0, {Allen::kDuring})); }),
              HasSubstr("a start before the finish"));
  EXPECT_THAT(ConfigErrorOf([&] { ReachOf(ToInterval(1.0, 2.0, {})); }),
              HasSubstr("name at least one"));
}

class QueryConditionsTest : public ::testing::Test {
 protected:
  QueryConditions Conditions(std::int64_t as_of = 10) {
    return QueryConditions(query_, as_of, *SmallOntology(), &parts_);
  }
  std::int64_t Word(const std::string& word) { return parts_.words.Intern(word); }

  StoreFile file_{":memory:", StoreOptions()};
  StoreParts parts_{&file_};
  FluentQuery query_;
};

TEST_F(QueryConditionsTest, WorldsComeFromTheEpisodeOrElseTheLabel) {
  const std::int64_t real = parts_.episodes.Start("serve", Episode::Label::kReal, 0, 1.0).id;
  const std::int64_t imagined =
      parts_.episodes.Start("imagine", Episode::Label::kImagined, 0, 2.0).id;
  EXPECT_EQ(Conditions().worlds().first, 0);
  EXPECT_TRUE(Conditions().worlds().IsOne());
  query_.label = Episode::Label::kImagined;
  EXPECT_EQ(Conditions().worlds().first, 1);
  query_.episode = real;
  EXPECT_EQ(Conditions().worlds().last, 0);
  query_.label.reset();
  query_.episode = imagined;
  EXPECT_EQ(Conditions().worlds().first, imagined);
  EXPECT_EQ(Conditions().worlds().last, imagined);
  query_.episode.reset();
  EXPECT_FALSE(Conditions().worlds().IsOne());
}

TEST_F(QueryConditionsTest, AConceptOfWhichNothingWasSaidIsImpossible) {
  EXPECT_FALSE(Conditions().IsImpossible());
  query_.concepts = {{"Object"}};
  EXPECT_TRUE(Conditions().IsImpossible());
  Word("Vase");
  EXPECT_FALSE(Conditions().IsImpossible());
}

TEST_F(QueryConditionsTest, AnIndexTellsWhatCannotFit) {
  const std::int64_t mug = Word("Mug"), pose = Word("Pose");
  query_.concepts = {{"Object"}};
  query_.time.kind = TimeFilter::Kind::kAt;
  query_.time.at = 5.0;
  const QueryConditions conditions = Conditions(10);
  EXPECT_TRUE(conditions.MayFit({10, 1, 0, mug, 5.0}));
  EXPECT_FALSE(conditions.MayFit({11, 1, 0, mug, 5.0})) << "written later";
  EXPECT_FALSE(conditions.MayFit({10, 1, 2, mug, 5.0})) << "of another world";
  EXPECT_FALSE(conditions.MayFit({10, 1, 0, pose, 5.0})) << "of another concept";
  EXPECT_FALSE(conditions.MayFit({10, 1, 0, mug, 5.1})) << "begins later";
}

TEST_F(QueryConditionsTest, WhatWasEndedLaterStillFits) {
  Validity validity;
  validity.id = 3;
  validity.concept_id = Word("Mug");
  validity.closed = 8;
  EXPECT_TRUE(Conditions(7).Fits(validity));
  EXPECT_FALSE(Conditions(8).Fits(validity));
}

TEST_F(QueryConditionsTest, EachPropertyOrOneOfThemFits) {
  const Fluent mug = MakeFluent("Mug", "mug1", {{"hasCount", "xsd:int", std::int64_t{3}}});
  query_.properties = {{"hasCount", Filler(3.0)}, {"hasColour", {}}};
  EXPECT_FALSE(Conditions().FitsProperties(mug));
  query_.all_properties = false;
  EXPECT_TRUE(Conditions().FitsProperties(mug));
  query_.properties.clear();
  EXPECT_TRUE(Conditions().FitsProperties(mug));
}

}  // namespace
}  // namespace hires::knowledge::query_conditions_test
