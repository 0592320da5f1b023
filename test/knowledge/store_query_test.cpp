#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <tuple>

#include "hires/base/error.h"
#include "hires/knowledge/store.h"
#include "knowledge/support/store_world.h"

namespace hires::knowledge::store_query_test {
namespace {

using temporal::Allen;
using temporal::kForever;
using test_support::At;
using test_support::Ever;
using test_support::HoldsAt;
using test_support::MakeFluent;
using test_support::Names;
using test_support::PoseAt;
using test_support::QueryAll;
using test_support::SmallOntology;
using Reach = FluentQuery::ConceptFilter::Reach;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

FluentQuery OfConcept(const std::string& name, Reach reach) {
  FluentQuery query;
  query.concepts = {{name, reach}};
  return query;
}

FluentQuery Standing(const temporal::Interval& interval, const std::vector<Allen>& relations) {
  FluentQuery query;
  query.time.kind = FluentQuery::TimeFilter::Kind::kAllen;
  query.time.interval = interval;
  query.time.relations = relations;
  return query;
}

class StoreQueryTest : public ::testing::Test {
 protected:
  StoreQueryTest() {
    store_.Add({MakeFluent("Mug", "mug1",
                           {{"hasColour", "xsd:string", std::string("blue")},
                            {"hasPose", "Pose", std::string("poseMug1")}}),
                MakeFluent("Mug", "Mug2", {{"hasColour", "xsd:string", std::string("red")}}),
                MakeFluent("Vase", "vase1", {{"hasCount", "xsd:int", std::int64_t{3}}}),
                MakeFluent("On", "on1",
                           {{"hasObject", "Mug", std::string("mug1")},
                            {"hasArea", "Area", std::string("area1")}}),
                PoseAt("poseMug1", 4.0)},
               At(10.0));
  }
  std::string ErrorOf(const FluentQuery& query) {
    try {
      store_.Query(query);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  Store store_{":memory:", SmallOntology()};
};

TEST_F(StoreQueryTest, AnEmptyQueryGivesAllByName) {
  EXPECT_THAT(Names(QueryAll(store_, FluentQuery())),
              ElementsAre("mug1", "Mug2", "on1", "poseMug1", "vase1"));
}

TEST_F(StoreQueryTest, ConceptsAreExactOrBelowOrAbove) {
  EXPECT_THAT(QueryAll(store_, OfConcept("Object", Reach::kExact)), IsEmpty());
  EXPECT_THAT(Names(QueryAll(store_, OfConcept("Mug", Reach::kExact))),
              ElementsAre("mug1", "Mug2"));
  EXPECT_THAT(Names(QueryAll(store_, OfConcept("Object", Reach::kBelow))),
              ElementsAre("mug1", "Mug2", "vase1"));
  EXPECT_THAT(Names(QueryAll(store_, OfConcept("Vase", Reach::kAbove))), ElementsAre("vase1"));
  FluentQuery two = OfConcept("Vase", Reach::kExact);
  two.concepts.push_back({"State", Reach::kBelow});
  EXPECT_THAT(Names(QueryAll(store_, two)), ElementsAre("on1", "vase1"));
  two.time.kind = FluentQuery::TimeFilter::Kind::kEver;
  EXPECT_THAT(Names(QueryAll(store_, two)), ElementsAre("on1", "vase1"));
}

TEST_F(StoreQueryTest, PropertiesByRoleAndFiller) {
  FluentQuery query;
  query.properties = {{"hasColour", {}}};
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("mug1", "Mug2"));
  query.properties = {{"hasColour", Filler(std::string("red"))}};
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("Mug2"));
  query.properties = {{"hasObject", Filler(std::string("MUG1"))}};
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("on1"));
  query.properties = {{"hasX", Filler(std::int64_t{4})}};
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("poseMug1"));
}

TEST_F(StoreQueryTest, AValueThatTheRelationCannotHaveIsRefusedWithWhatItWants) {
  const Filler text(std::string("abc")), truth(true), whole(std::int64_t{3}), real(2.5);
  const std::vector<std::tuple<std::string, std::vector<Filler>, std::vector<Filler>, std::string>>
      relations{{"hasX", {whole, real}, {text, truth}, "a number"},
                {"hasCount", {whole, Filler(3.0)}, {text, truth, real}, "a whole number"},
                {"hasColour", {text}, {truth, whole, real}, "a text, in quotes"},
                {"isClean", {truth}, {text, whole, real}, "true or false"},
                {"hasPose", {text}, {truth, whole, real}, "the name of a Pose"}};
  for (const auto& [role, good, bad, wanted] : relations) {
    FluentQuery query;
    for (const Filler& filler : good) {
      query.properties = {{role, filler}};
      EXPECT_NO_THROW(QueryAll(store_, query)) << role;
    }
    for (const Filler& filler : bad) {
      query.properties = {{role, filler}};
      EXPECT_THAT(ErrorOf(query),
                  AllOf(HasSubstr("'" + role + "'"), HasSubstr("wanted " + wanted)));
    }
  }
}

TEST_F(StoreQueryTest, AllPropertiesOrOneOfThem) {
  FluentQuery query;
  query.properties = {{"hasColour", {}}, {"hasPose", Filler(std::string("poseMug1"))}};
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("mug1"));
  query.all_properties = false;
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("mug1", "Mug2"));
}

TEST_F(StoreQueryTest, OneInstanceWithItsHistory) {
  store_.Add({PoseAt("poseMug1", 5.0)}, At(20.0));
  store_.Add({PoseAt("poseMug1", 6.0)}, At(30.0));
  FluentQuery query = Ever();
  query.instance = "POSEMUG1";
  const std::vector<Fluent> history = QueryAll(store_, query);
  ASSERT_THAT(history, SizeIs(3));
  EXPECT_EQ(history[0].start.earliest, 10.0);
  EXPECT_EQ(history[2].start.earliest, 30.0);
  query = HoldsAt(25.0);
  query.instance = "poseMug1";
  EXPECT_THAT(QueryAll(store_, query), ElementsAre(history[1]));
  query.instance = "nobody";
  EXPECT_THAT(QueryAll(store_, query), IsEmpty());
}

TEST_F(StoreQueryTest, OnlyWhatWasWrittenInAnEpisode) {
  const std::int64_t id = store_.StartEpisode("task", Episode::Label::kReal, 0, 15.0).id;
  store_.Add({PoseAt("poseMug1", 5.0), PoseAt("pose2", 5.0)}, At(20.0, id));
  store_.Add({PoseAt("pose2", 6.0)}, At(30.0));
  FluentQuery query = Ever();
  query.episode = id;
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("pose2", "poseMug1"));
  query.time.kind = FluentQuery::TimeFilter::Kind::kNow;
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("poseMug1"));
  query.episode = 0;
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("mug1", "Mug2", "on1", "pose2", "vase1"));
}

TEST_F(StoreQueryTest, IntervalsByAllensRelations) {
  Store store(":memory:", SmallOntology());
  const std::vector<std::pair<double, double>> stretches = {
      {1, 5},  {5, 10}, {5, 15},  {10, 15}, {12, 18}, {15, 20}, {10, 20},
      {5, 20}, {5, 25}, {10, 25}, {15, 25}, {20, 25}, {21, 25}};
  // Of the thirteen, in the order of the enumeration, to [10, 20).
  const std::vector<int> order = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (const int i : order) {
    const auto [start, finish] = stretches[static_cast<std::size_t>(i)];
    const std::string name = std::string(ToString(static_cast<Allen>(i)));
    store.Add({PoseAt(name, 0.0)}, At(start));
    if (i % 2 == 0) store.Remove({name}, At(finish));
    if (i % 2 != 0) store.Add({PoseAt(name, 1.0)}, At(finish));
  }
  for (const int i : order) {
    const auto relation = static_cast<Allen>(i);
    FluentQuery query = Standing({10.0, 20.0}, {relation});
    query.properties = {{"hasX", Filler(0.0)}};
    EXPECT_THAT(Names(QueryAll(store, query)), ElementsAre(std::string(ToString(relation))));
    query.instance = std::string(ToString(relation));  // by the other way through the file
    EXPECT_THAT(QueryAll(store, query), SizeIs(1)) << query.instance;
  }
}

TEST_F(StoreQueryTest, AnIntervalWithBoundsMayStandInSeveralRelations) {
  Fluent vague = PoseAt("vague", 1.0);
  vague.start = {0.0, 0.0};
  vague.finish = {8.0, 15.0};
  store_.Add({vague}, At(9.0));
  for (const Allen relation : {Allen::kBefore, Allen::kMeets, Allen::kOverlaps}) {
    EXPECT_THAT(Names(QueryAll(store_, Standing({10.0, 20.0}, {relation}))), ElementsAre("vague"));
  }
  EXPECT_THAT(QueryAll(store_, Standing({10.0, 20.0}, {Allen::kContains})), IsEmpty());
}

TEST_F(StoreQueryTest, PagesJoinToTheWhole) {
  for (int i = 0; i < 40; ++i) {
    store_.Add({PoseAt("pose" + std::to_string(i % 7), 0.5 * i)}, At(20.0 + i));
  }
  for (FluentQuery query : {FluentQuery(), Ever(), HoldsAt(45.0),
                            Standing({30.0, 50.0}, {Allen::kDuring, Allen::kOverlaps})}) {
    const std::vector<Fluent> whole = QueryAll(store_, query);
    ASSERT_GT(whole.size(), 3u);
    for (const std::size_t limit : {1u, 2u, 3u, 5u}) {
      query.limit = limit;
      EXPECT_EQ(QueryAll(store_, query), whole) << "limit " << limit;
    }
    query.limit = whole.size();
    EXPECT_EQ(store_.Query(query).next, "");
  }
}

TEST_F(StoreQueryTest, PagesShowTheStoreAsItWasAtTheFirst) {
  for (FluentQuery query : {FluentQuery(), Ever(), HoldsAt(15.0), HoldsAt(1000.0)}) {
    query.limit = 2;
    const std::vector<Fluent> whole = QueryAll(store_, query);
    std::vector<Fluent> paged;
    double time = store_.ChangesSince(store_.last_sequence() - 1, 1).at(0).time;
    for (FluentPage page = store_.Query(query);; page = store_.Query(query)) {
      paged.insert(paged.end(), page.fluents.begin(), page.fluents.end());
      time += 1.0;
      store_.Add({PoseAt("poseMug1", time), PoseAt("mugless" + std::to_string(time), 1.0)},
                 At(time));
      if (store_.Find("vase1")) store_.Remove({"vase1"}, At(time));
      if (page.next.empty()) break;
      query.cursor = page.next;
    }
    EXPECT_EQ(paged, whole);
    store_.Add({MakeFluent("Vase", "vase1")}, At(time + 1.0));
  }
}

TEST_F(StoreQueryTest, WhatEndedMeanwhileAndStillHeldThenIsToldOnce) {
  FluentQuery query = HoldsAt(15.0);
  query.limit = 3;
  const std::vector<Fluent> whole = QueryAll(store_, query);
  const FluentPage first = store_.Query(query);
  store_.Add({PoseAt("poseMug1", 5.0)}, At(20.0));  // it held at 15 s before and after this
  query.cursor = first.next;
  const std::vector<Fluent> rest = QueryAll(store_, query);
  EXPECT_EQ(rest, std::vector<Fluent>(whole.begin() + 3, whole.end()));
}

TEST_F(StoreQueryTest, WalkedInstancesShowTheFirstPagesMomentAsWell) {
  store_.Add({PoseAt("pose2", 1.0)}, At(10.0));
  FluentQuery query = HoldsAt(15.0);
  query.sparql = "prefix t: <http://example.org/test#> select ?p where { ?p rdf:type t:Pose }";
  query.limit = 1;
  const std::vector<Fluent> whole = QueryAll(store_, query);
  ASSERT_THAT(Names(whole), ElementsAre("pose2", "poseMug1"));
  query.cursor = store_.Query(query).next;
  store_.Add({PoseAt("poseMug1", 9.0)}, At(12.0));
  EXPECT_THAT(QueryAll(store_, query), ElementsAre(whole[1]));
}

TEST_F(StoreQueryTest, SparqlChoosesInstancesOfTheMomentAndWorld) {
  const std::int64_t imagined =
      store_.StartEpisode("imagine", Episode::Label::kImagined, 0, 12.0).id;
  store_.Add({MakeFluent("Vase", "vase2", {{"hasPose", "Pose", std::string("poseMug1")}}),
              PoseAt("poseMug1", 5.0)},
             At(12.0, imagined));
  store_.Remove({"mug1"}, At(20.0));
  FluentQuery query;
  query.sparql =
      "prefix t: <http://example.org/test#> "
      "select distinct ?o where { ?o t:hasPose ?p . ?p t:hasX ?x }";
  EXPECT_THAT(QueryAll(store_, query), IsEmpty());
  query.time.kind = FluentQuery::TimeFilter::Kind::kAt;
  query.time.at = 15.0;
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("mug1"));
  query.instance = "mug2";
  EXPECT_THAT(QueryAll(store_, query), IsEmpty());
  query.instance.clear();
  query.episode = imagined;
  EXPECT_THAT(Names(QueryAll(store_, query)), ElementsAre("vase2"));
  query.episode.reset();
  query.label.reset();
  EXPECT_THAT(ErrorOf(query), HasSubstr("one world"));
  query.label = Episode::Label::kReal;
  query.sparql = "select nothing";
  EXPECT_THAT(ErrorOf(query), ::testing::Not("no error"));
}

TEST_F(StoreQueryTest, ACursorMayHoldColons) {
  store_.Add({PoseAt("a:b:c", 1.0), PoseAt("a:b:d", 1.0)}, At(11.0));
  FluentQuery query;
  query.limit = 1;
  EXPECT_THAT(Names(QueryAll(store_, query)),
              ElementsAre("a:b:c", "a:b:d", "mug1", "Mug2", "on1", "poseMug1", "vase1"));
}

TEST_F(StoreQueryTest, BadQueriesSaySo) {
  EXPECT_THAT(ErrorOf(OfConcept("Mugg", Reach::kBelow)), HasSubstr("'Mug'"));
  FluentQuery query;
  query.properties = {{"hasColor", {}}};
  EXPECT_THAT(ErrorOf(query), HasSubstr("did you mean 'hasColour'"));
  EXPECT_THAT(ErrorOf(HoldsAt(std::nan(""))), HasSubstr("NaN"));
  EXPECT_THAT(ErrorOf(Standing({5.0, 5.0}, {Allen::kBefore})), HasSubstr("from 5 to 5"));
  EXPECT_THAT(ErrorOf(Standing({5.0, 6.0}, {})), HasSubstr("at least one"));
  query = FluentQuery();
  query.limit = 0;
  EXPECT_THAT(ErrorOf(query), HasSubstr("limit 0"));
  query.limit = 1;
  for (const char* cursor :
       {"x", "1:2:3", "1:0:zz:4:name", "-1:0:0:4:name", "1:0:7ff8000000000000:4:a"}) {
    query.cursor = cursor;
    EXPECT_THAT(ErrorOf(query), HasSubstr("cursor")) << cursor;
  }
  query = FluentQuery();
  query.episode = 9;
  EXPECT_THAT(ErrorOf(query), HasSubstr("no episode 9"));
}

// ------------------------------------------------------------------ the cost, in rows looked at

FluentQuery WithText(const std::string& role, const std::string& text) {
  FluentQuery query;
  query.properties = {{role, Filler(text)}};
  return query;
}

/// Blue mugs come and go, and on1 is said of mug1 anew, in the real world and in an imagined one.
void Repeat(int first, int last, std::int64_t imagined, Store* store) {
  for (int i = first; i < last; ++i) {
    const double time = 100.0 + i;
    const std::string passing = "passing" + std::to_string(i);
    const std::vector<Fluent> said = {
        MakeFluent("Mug", passing, {{"hasColour", "xsd:string", std::string("blue")}}),
        MakeFluent("On", "on1",
                   {{"hasObject", "Mug", std::string("mug1")},
                    {"hasArea", "Area", "area" + std::to_string(i % 2)}})};
    store->Add(said, At(time));
    store->Remove({passing}, At(time));
    store->Add(said, At(time, imagined));
  }
}

TEST_F(StoreQueryTest, WhatHoldsNowCostsTheSameAfterAnyNumberOfRepetitions) {
  FluentQuery blue_objects = WithText("hasColour", "blue");
  blue_objects.concepts = {{"Object"}};
  const std::vector<std::pair<FluentQuery, std::vector<std::string>>> cases = {
      {WithText("hasObject", "mug1"), {"on1"}},
      {WithText("hasColour", "Blue"), {"mug1"}},
      {WithText("hasArea", "area1"), {"on1"}},
      {OfConcept("Mug", Reach::kExact), {"mug1", "Mug2"}},
      {OfConcept("Object", Reach::kBelow), {"mug1", "Mug2", "vase1"}},
      {blue_objects, {"mug1"}}};
  const std::int64_t imagined =
      store_.StartEpisode("imagine", Episode::Label::kImagined, 0, 50.0).id;
  Repeat(0, 10, imagined, &store_);
  std::vector<std::uint64_t> cost;
  for (const auto& [query, names] : cases) cost.push_back(store_.Query(query).visited);
  Repeat(10, 1000, imagined, &store_);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const FluentPage page = store_.Query(cases[i].first);
    EXPECT_EQ(Names(page.fluents), cases[i].second);
    EXPECT_EQ(page.visited, cost[i]) << "case " << i;
    EXPECT_LE(page.visited, 2 * page.fluents.size() + 2) << "case " << i;
  }
}

TEST_F(StoreQueryTest, AFewAmongManyAreFoundByTheShortPath) {
  constexpr int kMany = 10'000;
  std::vector<Fluent> poses;
  std::vector<std::string> names;
  for (int i = 0; i < kMany; ++i) {
    poses.push_back(PoseAt("p" + std::to_string(i), i));
    names.push_back(poses.back().instance);
  }
  store_.Add(poses, At(20.0));
  // At 25 s hold many poses and few mugs; at 35 s what holds has ended now, but for a few poses.
  FluentQuery few = HoldsAt(25.0);
  few.concepts = {{"Mug"}};
  const FluentPage open = store_.Query(few);
  store_.Remove({"mug1", "Mug2"}, At(30.0));
  names.resize(kMany - 5);
  store_.Remove(names, At(30.0));
  const FluentPage closed = store_.Query(few);  // one by one, for all that holds then is much more
  FluentQuery last = HoldsAt(35.0);
  last.concepts = {{"Pose"}};
  const FluentPage rest = store_.Query(last);  // all that holds, for the poses of ever are many
  EXPECT_THAT(Names(open.fluents), ElementsAre("mug1", "Mug2"));
  EXPECT_THAT(Names(closed.fluents), ElementsAre("mug1", "Mug2"));
  EXPECT_THAT(Names(rest.fluents),
              ElementsAre("p9995", "p9996", "p9997", "p9998", "p9999", "poseMug1"));
  EXPECT_LE(open.visited, 10u);
  EXPECT_LE(rest.visited, 20u);
  EXPECT_LE(closed.visited, kMany / 2u);
}

TEST_F(StoreQueryTest, APageIsOfTheFirstOnesMomentAfterAnyNumberOfChanges) {
  double time = 10.0;
  for (FluentQuery query : {WithText("hasObject", "mug1"), OfConcept("On", Reach::kBelow)}) {
    time += 1.0;
    store_.Add({MakeFluent("On", "on2", {{"hasObject", "Mug", std::string("mug1")}}),
                MakeFluent("On", "on3", {{"hasObject", "Mug", std::string("mug1")}})},
               At(time));
    query.limit = 1;
    const std::vector<Fluent> whole = QueryAll(store_, query);
    ASSERT_THAT(Names(whole), ElementsAre("on1", "on2", "on3"));
    const std::vector<Fluent> rest(whole.begin() + 1, whole.end());
    query.cursor = store_.Query(query).next;
    time += 1.0;
    store_.Remove({"on2", "on3"}, At(time));
    EXPECT_EQ(QueryAll(store_, query), rest);
    std::vector<Fluent> poses;  // more changes than are looked through for what ended
    for (int i = 0; i < 20'500; ++i) poses.push_back(PoseAt("p" + std::to_string(i), time));
    ASSERT_THAT(store_.Add(poses, At(time)), SizeIs(poses.size()));
    EXPECT_EQ(QueryAll(store_, query), rest);
  }
}

TEST_F(StoreQueryTest, MoreThanFitsInMemoryIsWalkedThroughByName) {
  constexpr int kMany = 20'500;  // more candidates than are sorted
  std::vector<Fluent> fluents;
  for (int i = 0; i < kMany; ++i) fluents.push_back(PoseAt("p" + std::to_string(i), i % 10));
  store_.Add(fluents, At(20.0));
  std::vector<std::string> names;
  for (const Fluent& fluent : fluents) names.push_back(fluent.instance);
  std::sort(names.begin(), names.end());
  for (FluentQuery query :
       {FluentQuery(), HoldsAt(21.0), Ever(), Standing({15.0, 25.0}, {Allen::kOverlappedBy})}) {
    query.concepts = {{"Pose", Reach::kExact}};
    query.limit = 7000;
    std::vector<std::string> found = Names(QueryAll(store_, query));
    found.erase(std::remove(found.begin(), found.end(), "poseMug1"), found.end());
    EXPECT_EQ(found, names);
    query.properties = {{"hasX", Filler(3.0)}};
    EXPECT_THAT(QueryAll(store_, query), SizeIs(kMany / 10));
  }
}

}  // namespace
}  // namespace hires::knowledge::store_query_test
