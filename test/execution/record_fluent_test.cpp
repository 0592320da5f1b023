#include "hires/execution/record_fluent.h"

#include <gmock/gmock.h>

#include "hires/knowledge/store.h"

namespace hires::execution::record_fluent_test {
namespace {

using ::testing::ElementsAre;

const knowledge::Ontology& TheOntology() {
  static const knowledge::Ontology ontology =
      knowledge::Ontology::FromFiles({HIRES_SOURCE_DIR "/config/ontology/upper.ttl",
                                      HIRES_SOURCE_DIR "/config/ontology/race.ttl"});
  return ontology;
}

TEST(FluentOfTest, FillersHaveTheTypesOfTheOntology) {
  Record record;
  record.concept_name = "MoveBaseTask";
  record.instance = "task3";
  record.texts = {{"hasAction", "move_base"}};
  record.numbers = {{"hasIndex", 3.0}, {"hasConfidence", 0.5}};
  record.links = {{"hasPlan", "plan1"}};
  const knowledge::Fluent fluent = FluentOf(record, 12.5, TheOntology());
  EXPECT_EQ(fluent.concept_name, "MoveBaseTask");
  EXPECT_EQ(fluent.start.earliest, 12.5);
  EXPECT_THAT(fluent.properties,
              ElementsAre(knowledge::Property{"hasAction", "xsd:string", std::string("move_base")},
                          knowledge::Property{"hasIndex", "xsd:integer", std::int64_t{3}},
                          knowledge::Property{"hasConfidence", "xsd:float", 0.5},
                          knowledge::Property{"hasPlan", "Plan", std::string("plan1")}));
}

TEST(EpisodeOutcomeTest, TheStoreKeepsItHoweverLongTheReason) {
  EXPECT_EQ(EpisodeOutcome("succeeded", ""), "succeeded");
  const std::string reason = "at\nline 3, " + std::string(980, 'x') + "\xC3\xB6" + "rest";
  const std::string outcome = EpisodeOutcome("no_plan", reason);
  EXPECT_THAT(outcome, ::testing::StartsWith("no_plan: at line 3, xxx"));
  EXPECT_THAT(outcome, ::testing::EndsWith("x ..."));
  EXPECT_LE(outcome.size(), 1000u);
  knowledge::Store store(":memory:", std::make_shared<const knowledge::Ontology>(TheOntology()));
  const std::int64_t episode = store.StartEpisode("x", knowledge::Episode::Label::kReal, 0, 1.0).id;
  EXPECT_EQ(store.FinishEpisode(episode, outcome, 2.0).outcome, outcome);
}

TEST(FluentOfTest, TruthIsANumberThatIsNotZero) {
  Record record;
  record.concept_name = "Prediction";
  record.numbers = {{"hasRecommendation", 1.0}};
  EXPECT_THAT(FluentOf(record, 0.0, TheOntology()).properties,
              ElementsAre(knowledge::Property{"hasRecommendation", "xsd:boolean", true}));
}

TEST(FluentOfTest, AConceptThatTheOntologyLacksGivesWayToTheGeneralOne) {
  Record record;
  record.concept_name = "JuggleTask";
  record.general_concept = "PrimitiveTask";
  EXPECT_EQ(FluentOf(record, 0.0, TheOntology()).concept_name, "PrimitiveTask");
  record.general_concept.clear();
  EXPECT_EQ(FluentOf(record, 0.0, TheOntology()).concept_name, "JuggleTask");
}

Record RecordOf(Record::Kind kind) {
  Record record;
  record.kind = kind;
  record.concept_name = "MoveBaseTask";
  record.instance = "Task3";
  return record;
}

TEST(EpisodeRecordsTest, WhatBeganSaysInWhichEpisodeAndWhenAndEndsOnce) {
  using Kind = Record::Kind;
  EpisodeRecords records;
  records.Begin("episode7");
  const RecordWrites begun = records.WritesOf(RecordOf(Kind::kBegin), 2.0, TheOntology());
  ASSERT_TRUE(begun.added);
  EXPECT_THAT(begun.added->properties, ElementsAre(knowledge::Property{"hasEpisode", "xsd:string",
                                                                       std::string("episode7")}));
  EXPECT_FALSE(begun.updated || begun.ended);
  Record last = RecordOf(Kind::kEnd);
  last.texts = {{"hasAction", "move_base"}};
  for (int i = 0; i < 2; ++i) {  // the Blackboard was away the first time
    const RecordWrites ended = records.WritesOf(last, 5.0, TheOntology());
    ASSERT_TRUE(ended.updated);
    EXPECT_EQ(ended.updated->start.earliest, 2.0);
    EXPECT_EQ(ended.ended, "Task3");
  }
  records.Forget("task3");
  EXPECT_EQ(records.WritesOf(last, 6.0, TheOntology()).updated->start.earliest, 6.0);
  EXPECT_FALSE(records.WritesOf(RecordOf(Kind::kUpdate), 6.0, TheOntology()).updated)
      << "it says nothing";
}

}  // namespace
}  // namespace hires::execution::record_fluent_test
