#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/store.h"
#include "knowledge/support/store_world.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::store_reasons_test {
namespace {

using test_support::At;
using test_support::Names;
using test_support::QueryAll;
using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

const std::string kOntology = HIRES_SOURCE_DIR "/config/ontology/";

std::shared_ptr<const Ontology> OwnOntology() {
  static const auto ontology = std::make_shared<const Ontology>(
      Ontology::FromFiles({kOntology + "upper.ttl", kOntology + "race.ttl"}));
  return ontology;
}

/// A store of schema 3, written by the programs of that time.
class StoreReasonsTest : public ::testing::Test {
 protected:
  StoreReasonsTest() {
    Run(base::ReadTextFile(HIRES_SOURCE_DIR "/test/knowledge/data/store_v3.sql"));
  }
  void Run(const std::string& sql) {
    SQLite::Database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec(sql);
  }
  int Number(const std::string& query) {
    return SQLite::Database(path_).execAndGet(query).getInt();
  }
  Store Open(bool read_only = false) {
    StoreOptions options;
    options.read_only = read_only;
    return Store(path_, OwnOntology(), options);
  }

  const test_support::TemporaryFolder folder_;
  const std::string path_ = (folder_.path() / "blackboard.db").string();
};

/// What an instance's last validity says of why, in order.
std::vector<std::pair<std::string, std::string>> WhyOf(const Store& store,
                                                       const std::string& instance) {
  FluentQuery query = test_support::Ever();
  query.instance = instance;
  const std::vector<Fluent> fluents = QueryAll(store, query);
  std::vector<std::pair<std::string, std::string>> why;
  if (fluents.empty()) return why;
  for (const Property& property : fluents.back().properties) {
    if (property.role != "hasReason" && property.role != "hasFailure" &&
        property.role != "hasSubject" && property.role != "hasDetail") {
      continue;
    }
    EXPECT_EQ(property.type, "xsd:string");
    why.emplace_back(property.role, std::get<std::string>(property.filler));
  }
  return why;
}

FluentQuery That(const std::string& role, const std::string& text) {
  FluentQuery query = test_support::Ever();
  query.properties = {{role, Filler(text)}};
  return query;
}

TEST_F(StoreReasonsTest, RecordsOfFailuresGetCodesAndKeepTheirWords) {
  const Store store = Open();
  EXPECT_EQ(store.Stats().schema, 4);
  const std::string touches = "r_forearm_link touches table1";
  const auto no_path = ElementsAre(Pair("hasFailure", "no_path"), Pair("hasDetail", touches));
  EXPECT_THAT(WhyOf(store, "activity2"), no_path);
  EXPECT_THAT(WhyOf(store, "failure1"), no_path);
  EXPECT_THAT(WhyOf(store, "prediction2"),
              ElementsAre(Pair("hasFailure", "area_occupied"), Pair("hasDetail", "book1, book2")));
  EXPECT_THAT(WhyOf(store, "activity3"), ElementsAre(Pair("hasFailure", "did_not_stop")));
  EXPECT_THAT(WhyOf(store, "failure4"), ElementsAre(Pair("hasFailure", "timed_out")));
  EXPECT_THAT(WhyOf(store, "activity4"), ElementsAre(Pair("hasFailure", "preempted")));
}

TEST_F(StoreReasonsTest, AWordThatNobodyKnowsIsAnotherFailureWithItsWholeText) {
  EXPECT_THAT(WhyOf(Open(), "failure5"),
              ElementsAre(Pair("hasFailure", "other"), Pair("hasDetail", "the cup sang: badly")));
}

TEST_F(StoreReasonsTest, WhatIsNoRecordOfAnActionKeepsItsReason) {
  const Store store = Open();
  EXPECT_THAT(WhyOf(store, "plan1"), ElementsAre(Pair("hasReason", "failed: gave up")));
  EXPECT_THAT(WhyOf(store, "activity1"), ElementsAre());
  EXPECT_THAT(WhyOf(store, "prediction3"), ElementsAre());
}

TEST_F(StoreReasonsTest, NothingElseOfARecordChanges) {
  const Store store = Open();
  FluentQuery query = test_support::Ever();
  query.instance = "activity2";
  const Fluent record = QueryAll(store, query).back();
  EXPECT_EQ(record.concept_name, "PickUpObjectActivity");
  EXPECT_EQ(record.start.earliest, 3.0);
  EXPECT_EQ(record.finish.latest, 4.0);
  std::vector<std::string> roles;
  for (const Property& property : record.properties) roles.push_back(property.role);
  EXPECT_THAT(roles, ElementsAre("hasAction", "hasArgument", "hasArgument", "hasTask", "hasEpisode",
                                 "hasResult", "hasFailure", "hasDetail"));
}

TEST_F(StoreReasonsTest, RecordsAreFoundByTheirCodesAndByReasonsNoMore) {
  {
    Store store = Open();
    EXPECT_THAT(Names(QueryAll(store, That("hasFailure", "no_path"))),
                UnorderedElementsAre("activity2", "failure1"));
    const std::string old = "no_path: r_forearm_link touches table1";
    EXPECT_THAT(Names(QueryAll(store, That("hasReason", old))), ElementsAre());
    EXPECT_THAT(Names(QueryAll(store, That("hasReason", "failed: gave up"))), ElementsAre("plan1"));
    FluentQuery now = That("hasFailure", "no_path");
    now.time = FluentQuery().time;
    EXPECT_THAT(Names(QueryAll(store, now)), ElementsAre("failure1"));
    store.Remove({"failure1"}, At(20.0));
    EXPECT_THAT(Names(QueryAll(store, now)), ElementsAre());
  }
  const std::string wanted =
      "SELECT f.hash, v.world, v.id FROM filler AS f JOIN validity AS v ON v.id = f.validity "
      "WHERE v.closed = 9223372036854775807";
  const std::string kept = "SELECT hash, world, validity FROM open_filler";
  EXPECT_GE(Number("SELECT count(*) FROM (" + wanted + ")"), 8);
  EXPECT_EQ(Number("SELECT count(*) FROM (" + wanted + " EXCEPT " + kept + ")"), 0);
  EXPECT_EQ(Number("SELECT count(*) FROM (" + kept + " EXCEPT " + wanted + ")"), 0);
}

TEST_F(StoreReasonsTest, AnOldStoreIsNotReadBeforeItWasBroughtUp) {
  EXPECT_THROW(Open(true), base::ConfigError);
  Open();
  EXPECT_THAT(WhyOf(Open(true), "failure4"), ElementsAre(Pair("hasFailure", "timed_out")));
}

TEST_F(StoreReasonsTest, DamagedRecordsStayAndOthersAreBroughtUp) {
  Run("UPDATE validity SET properties = x'05010203' WHERE id = 9");  // failure1
  const Store store = Open();
  EXPECT_THROW(store.Find("failure1"), base::ConfigError);
  EXPECT_THAT(WhyOf(store, "failure4"), ElementsAre(Pair("hasFailure", "timed_out")));
}

TEST_F(StoreReasonsTest, AMigrationThatFailsChangesNothing) {
  Run("CREATE TRIGGER stop BEFORE UPDATE ON validity WHEN old.id = 13 "
      "BEGIN SELECT raise(ABORT, 'no'); END");
  const std::string sum = "SELECT sum(length(properties)) FROM validity";
  const int before = Number(sum);
  EXPECT_THROW(Open(), base::ConfigError);
  EXPECT_EQ(Number(sum), before);
  EXPECT_EQ(Number("PRAGMA user_version"), 3);
}

}  // namespace
}  // namespace hires::knowledge::store_reasons_test
