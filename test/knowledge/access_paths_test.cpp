#include "knowledge/query/access_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "knowledge/query/instance_walk.h"
#include "knowledge/query/page_builder.h"
#include "knowledge/store/store_writer.h"
#include "knowledge/support/store_world.h"

namespace hires::knowledge::access_paths_test {
namespace {

using test_support::At;
using test_support::Ever;
using test_support::HoldsAt;
using test_support::MakeFluent;
using test_support::Names;
using test_support::SmallOntology;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A red mug1, and twelve blue ones of which the first six are gone.
class AccessPathsTest : public ::testing::Test {
 protected:
  AccessPathsTest() {
    std::vector<Fluent> mugs{Mug(1, "red")};
    std::vector<std::string> gone;
    for (int i = 2; i < 14; ++i) mugs.push_back(Mug(i, "blue"));
    for (int i = 2; i < 8; ++i) gone.push_back(Mug(i, "").instance);
    writer_.Add(mugs, At(10.0), &last_);
    writer_.Remove(gone, At(20.0), &last_);
  }
  static Fluent Mug(int number, const std::string& colour) {
    return MakeFluent("Mug", "mug" + std::to_string(number), {{"hasColour", "xsd:string", colour}});
  }
  static FluentQuery Coloured(FluentQuery query, const std::string& colour) {
    query.properties = {{"hasColour", Filler(colour)}};
    return query;
  }
  std::int64_t last() const { return static_cast<std::int64_t>(last_); }
  QueryConditions Conditions(const FluentQuery& query) {
    return QueryConditions(query, last(), *SmallOntology(), &parts_);
  }
  std::optional<Found> Find(const FluentQuery& query) {
    const QueryConditions conditions = Conditions(query);
    return AccessPaths(conditions, {last(), {}}, last(), &parts_, &statements_).Find();
  }
  /// Of candidates.
  std::vector<std::string> NamesFound(const FluentQuery& query) {
    const auto found = Find(query);
    std::vector<std::string> names;
    for (const auto& each : std::get<std::vector<QueryPosition>>(found.value())) {
      names.push_back(each.name);
    }
    return names;
  }

  StoreFile file_{":memory:", StoreOptions()};
  StoreParts parts_{&file_};
  StoreWriter writer_{&parts_, SmallOntology()};
  QueryStatements statements_{&file_};
  std::uint64_t last_{0};
};

TEST_F(AccessPathsTest, WhatHoldsNowIsFoundInOrderOfNames) {
  EXPECT_THAT(NamesFound(FluentQuery()),
              ElementsAre("mug1", "mug10", "mug11", "mug12", "mug13", "mug8", "mug9"));
}

TEST_F(AccessPathsTest, ATextLeadsToThoseThatHaveIt) {
  EXPECT_THAT(NamesFound(Coloured(FluentQuery(), "Red")), ElementsAre("mug1"));
  EXPECT_THAT(NamesFound(Coloured(HoldsAt(15.0), "blue")), SizeIs(12));
  EXPECT_THAT(NamesFound(Coloured(Ever(), "blue")), SizeIs(12));
  EXPECT_THAT(NamesFound(Coloured(FluentQuery(), "green")), IsEmpty());
}

TEST_F(AccessPathsTest, AConceptOfAllTimesLeadsToInstances) {
  FluentQuery query = Ever();
  query.concepts = {{"Object"}};
  const auto found = Find(query);
  ASSERT_TRUE(found);
  EXPECT_THAT(std::get<NamedInstances>(*found), SizeIs(13));
}

TEST_F(AccessPathsTest, ThereIsNoneToAllThatEverWas) { EXPECT_FALSE(Find(Ever())); }

TEST_F(AccessPathsTest, ACollectorStopsWhereThePathHasCostWhatItMay) {
  const FluentQuery query;
  const QueryConditions conditions = Conditions(query);
  CandidateCollector collector(conditions, {}, &parts_.instances);
  collector.Begin(10);
  EXPECT_TRUE(collector.Spend(4));
  EXPECT_TRUE(collector.Spend(6));
  EXPECT_FALSE(collector.Spend(1));
  EXPECT_FALSE(collector.gave_up()) << "more patience may help";
  EXPECT_EQ(collector.visited(), 3u);
  EXPECT_FALSE(collector.GiveUp());
  EXPECT_TRUE(collector.gave_up());
  collector.Begin(10);
  EXPECT_FALSE(collector.gave_up());
}

TEST_F(AccessPathsTest, ACollectorLeavesOutWhatWasToldAndTellsTheRestOnce) {
  const FluentQuery query;
  const QueryConditions conditions = Conditions(query);
  const std::int64_t mug = *parts_.words.Find("Mug");
  const auto at = [&](const char* name) { return parts_.instances.Find(name)->id; };
  CandidateCollector collector(conditions, QueryPosition{"mug10", 0, 10.0, 5}, &parts_.instances);
  collector.Begin(100);
  for (const IndexEntry& entry :
       {IndexEntry{8, at("mug9"), 0, mug, 10.0}, IndexEntry{5, at("mug10"), 0, mug, 10.0},
        IndexEntry{6, at("mug11"), 0, mug, 10.0}, IndexEntry{8, at("mug9"), 0, mug, 10.0}}) {
    EXPECT_TRUE(collector.Add(entry));
  }
  const std::vector<QueryPosition> rest = collector.Take();
  ASSERT_THAT(rest, SizeIs(2));
  EXPECT_EQ(rest[0].name, "mug11");
  EXPECT_EQ(rest[1].name, "mug9");
}

TEST_F(AccessPathsTest, AWalkOffersTheSameAsThePathsLeadTo) {
  for (const FluentQuery& query : {FluentQuery(), HoldsAt(15.0), Coloured(HoldsAt(15.0), "blue")}) {
    const QueryConditions conditions = Conditions(query);
    PageBuilder walked(conditions, &parts_);
    InstanceWalk(conditions, {}, &statements_, &walked).ThroughAll();
    EXPECT_EQ(Names(walked.Take().fluents), NamesFound(query));
  }
}

TEST_F(AccessPathsTest, AFullPageSaysWhereToGoOn) {
  FluentQuery query;
  query.limit = 2;
  const QueryConditions conditions = Conditions(query);
  PageBuilder page(conditions, &parts_);
  InstanceWalk(conditions, {}, &statements_, &page).ThroughAll();
  const FluentPage first = page.Take();
  EXPECT_THAT(Names(first.fluents), ElementsAre("mug1", "mug10"));
  EXPECT_EQ(ReadCursor(first.next).last.name, "mug10");
  EXPECT_EQ(first.sequence, last_);
}

}  // namespace
}  // namespace hires::knowledge::access_paths_test
