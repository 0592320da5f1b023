#include "hires/knowledge/demand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "knowledge/support/restaurant_world.h"

namespace hires::knowledge::demand_test {
namespace {

using test_support::At;
using test_support::BoxAt;
using test_support::MakeFluent;
using test_support::PoseOfHeight;
using test_support::RestaurantOntology;
using test_support::SmallRestaurant;
using test_support::WithBox;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Kind = Change::Kind;
using Told = std::vector<std::string>;

constexpr const char* kFloorAreas =
    "select distinct ?area where {?area rdf:type ?type . ?type rdfs:subClassOf* upper:Area . ?area "
    "upper:hasBoundingBox ?bbox . ?bbox upper:hasPose ?pose . ?pose upper:hasZ \"0.0\"^^xsd:float}";
constexpr const char* kOnSomething =
    "select distinct ?instance where { ?on a upper:On ; upper:hasPhysicalEntity ?instance }";

DemandTopic Topic(std::vector<std::string> queries = {}) {
  DemandTopic topic;
  topic.name = "wanted";
  topic.queries = std::move(queries);
  return topic;
}

DemandTopic Below(const std::string& concept_name) {
  DemandTopic topic = Topic();
  topic.below = {concept_name};
  return topic;
}

/// "+mug1 ~mug2 -mug3" for entered, changed, left.
Told ToldBy(const DemandUpdate& update) {
  static const std::map<Kind, std::string> kMarks{
      {Kind::kAdded, "+"}, {Kind::kUpdated, "~"}, {Kind::kRemoved, "-"}};
  Told told;
  for (const Change& change : update.changes) {
    told.push_back(kMarks.at(change.kind) + change.fluent.instance);
  }
  return told;
}

/// A store with the small restaurant, and one topic on it.
class DemandTest : public ::testing::Test {
 protected:
  DemandTest() : store_(":memory:", RestaurantOntology()) {
    store_.Add(SmallRestaurant(), By(0.0));
  }

  /// Knowledge may say anything, so that one test can speak of states and activities.
  static Assertion By(double time) { return At(time, 0, Source::kKnowledge); }
  void Watch(const DemandTopic& topic) { demand_.emplace(topic, RestaurantOntology()); }
  Told Snapshot() { return ToldBy(demand_->Snapshot(store_)); }
  /// What a topic lets through of all that holds.
  Told Matching(const DemandTopic& topic) {
    Watch(topic);
    return Snapshot();
  }
  DemandUpdate Apply(const std::vector<Change>& changes) { return demand_->Apply(changes, store_); }
  Told Add(const std::vector<Fluent>& fluents) {
    return ToldBy(Apply(store_.Add(fluents, By(++time_))));
  }
  Told Update(const std::vector<Fluent>& fluents) {
    return ToldBy(Apply(store_.Update(fluents, By(++time_))));
  }
  Told Remove(const std::vector<std::string>& instances) {
    return ToldBy(Apply(store_.Remove(instances, By(++time_))));
  }

  Store store_;
  std::optional<Demand> demand_;
  double time_{0.0};
};

std::string ErrorOf(const DemandTopic& topic) {
  try {
    Demand(topic, RestaurantOntology());
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

// Which fluents match -----------------------------------------------------------------------------

TEST_F(DemandTest, ClassFilterTakesTheConceptAlone) {
  DemandTopic topic = Topic();
  topic.exact = {"Area", "Mug"};
  EXPECT_THAT(Matching(topic), ElementsAre("+mug1", "+mug2"));
}

TEST_F(DemandTest, SubclassFilterTakesWhatIsBelow) {
  EXPECT_THAT(Matching(Below("Area")),
              ElementsAre("+floorArea1", "+manipulationArea1", "+placingArea1", "+sittingArea1"));
}

TEST_F(DemandTest, SuperclassFilterTakesWhatIsAbove) {
  store_.Add({MakeFluent("ArmPosture", "some"), MakeFluent("ArmToSidePosture", "side")}, By(1.0));
  DemandTopic topic = Topic();
  topic.above = {"ArmTuckedPosture"};
  EXPECT_THAT(Matching(topic), ElementsAre("+postureLeftArm1", "+some"));
}

TEST_F(DemandTest, AConceptNamedAsClassAndAsSubclassCountsOnce) {
  DemandTopic topic = Below("RobotActivity");
  topic.exact = {"RobotActivity"};
  EXPECT_THAT(Matching(topic), ElementsAre("+moveBase1", "+moveTorso1"));
}

TEST_F(DemandTest, PropertyFilterThinsOutWhatTheConceptLetsThrough) {
  DemandTopic topic = Below("RobotActivity");
  topic.properties = {"hasResult"};
  EXPECT_THAT(Matching(topic), ElementsAre("+moveBase1"));
}

TEST_F(DemandTest, PropertiesAreWantedOneOfThemOrEach) {
  DemandTopic topic = Topic();
  topic.properties = {"hasArea", "hasPhysicalEntity"};
  EXPECT_THAT(Matching(topic), ElementsAre("+onMug1", "+robotAt1"));
  topic.all_properties = true;
  EXPECT_THAT(Matching(topic), ElementsAre("+onMug1"));
}

TEST_F(DemandTest, AQueryAddsToWhatTheFiltersLetThrough) {
  DemandTopic topic = Below("Book");
  topic.queries = {"select ?x {?x a race:Table}", "select ?y {?y a race:Mug}"};
  EXPECT_THAT(Matching(topic), ElementsAre("+book1", "+mug1", "+mug2", "+table1"));
}

TEST_F(DemandTest, FloorAreasAreThoseWhoseBoxStandsOnTheFloor) {
  EXPECT_THAT(Matching(Topic({kFloorAreas})), ElementsAre("+floorArea1", "+manipulationArea1"));
}

TEST_F(DemandTest, WhatIsLinkedToButDoesNotHoldIsNotTold) {
  EXPECT_THAT(Matching(Topic({"select ?b {?x upper:hasBoundingBox ?b ; a race:Mug}"})), IsEmpty());
}

// What changes ------------------------------------------------------------------------------------

TEST_F(DemandTest, FluentsEnterChangeAndLeave) {
  Watch(Below("RobotActivity"));
  Snapshot();
  EXPECT_THAT(Add({MakeFluent("MoveBaseActivity", "drive")}), ElementsAre("+drive"));
  const Fluent done =
      MakeFluent("MoveBaseActivity", "drive", {{"hasResult", "xsd:string", std::string("failed")}});
  EXPECT_THAT(Update({done}), ElementsAre("~drive"));
  EXPECT_THAT(Remove({"DRIVE"}), ElementsAre("-drive"));
  EXPECT_THAT(Add({MakeFluent("Mug", "mug3")}), IsEmpty());
  EXPECT_THAT(Remove({"mug3"}), IsEmpty());
}

TEST_F(DemandTest, AFluentEntersAndLeavesWithItsConcept) {
  Watch(Topic({"select ?p {?p a race:ArmTuckedPosture}"}));
  Snapshot();
  EXPECT_THAT(Update({MakeFluent("ArmToSidePosture", "postureLeftArm1")}),
              ElementsAre("-postureLeftArm1"));
  EXPECT_THAT(Update({MakeFluent("ArmTuckedPosture", "postureLeftArm1")}),
              ElementsAre("+postureLeftArm1"));
}

TEST_F(DemandTest, EveryChangeOfOneTransactionIsToldInItsOrder) {
  Watch(Below("TabletopObject"));
  Snapshot();
  EXPECT_THAT(Add({MakeFluent("Mug", "z"), MakeFluent("Mug", "b"), MakeFluent("Table", "z"),
                   MakeFluent("Book", "b")}),
              ElementsAre("+z", "+b", "-z", "~b"));
}

TEST_F(DemandTest, AnAreaLeavesWhenThePoseOfItsBoxRises) {
  Watch(Topic({kFloorAreas}));
  Snapshot();
  const std::vector<Change> changes = store_.Update({PoseOfHeight("poseFloor1", 0.1)}, By(1.0));
  const DemandUpdate update = Apply(changes);
  EXPECT_THAT(ToldBy(update), ElementsAre("-floorArea1"));
  EXPECT_EQ(update.changes[0].sequence, changes[0].sequence);
  EXPECT_EQ(update.changes[0].fluent.concept_name, "FloorArea");
  EXPECT_THAT(Update({PoseOfHeight("POSEFLOOR1", 0.0)}), ElementsAre("+floorArea1"));
}

TEST_F(DemandTest, AnAreaLeavesAndEntersWithEveryLinkOfTheChain) {
  Watch(Topic({kFloorAreas}));
  Snapshot();
  EXPECT_THAT(Update({BoxAt("boxFloorArea1", "poseTop")}), ElementsAre("-floorArea1"));
  EXPECT_THAT(Update({BoxAt("boxFloorArea1", "poseFloor2")}), ElementsAre("+floorArea1"));
  EXPECT_THAT(Remove({"boxFloorArea1"}), ElementsAre("-floorArea1"));
  EXPECT_THAT(Add({BoxAt("boxFloorArea1", "poseFloor1")}), ElementsAre("+floorArea1"));
  EXPECT_THAT(Update({WithBox("FloorArea", "floorArea1", "boxPlacingArea1")}),
              ElementsAre("-floorArea1"));
  EXPECT_THAT(Remove({"poseFloor2"}), ElementsAre("-manipulationArea1"));
}

TEST_F(DemandTest, WhatChangesAtTheEndOfAChainWithoutEffectIsNotTold) {
  Watch(Topic({kFloorAreas}));
  Snapshot();
  Fluent moved = PoseOfHeight("poseFloor1", 0.0);
  moved.properties[0].filler = 7.5;
  EXPECT_THAT(Update({moved}), IsEmpty());
  EXPECT_THAT(Update({PoseOfHeight("poseTop", 0.8)}), IsEmpty());
  EXPECT_THAT(Add({MakeFluent("Mug", "mug3")}), IsEmpty());
}

TEST_F(DemandTest, AnAreaThatComesWithBoxAndPoseIsToldOnceWithItsOwnChange) {
  Watch(Topic({kFloorAreas}));
  Snapshot();
  const std::vector<Change> changes = store_.Add(
      {WithBox("FloorArea", "fa2", "box2"), BoxAt("box2", "pose2"), PoseOfHeight("pose2", 0.0)},
      By(1.0));
  const DemandUpdate update = Apply(changes);
  EXPECT_THAT(ToldBy(update), ElementsAre("+fa2"));
  EXPECT_EQ(update.first_sequence, changes.front().sequence);
  EXPECT_EQ(update.last_sequence, changes.back().sequence);
}

TEST_F(DemandTest, AnObjectEntersAndLeavesWithTheStateThatLinksToIt) {
  Watch(Topic({kOnSomething}));
  EXPECT_THAT(Snapshot(), ElementsAre("+mug1"));
  const auto on = [](const std::string& object) {
    return MakeFluent("On", "onMug1", {{"hasPhysicalEntity", "PassiveObject", object}});
  };
  EXPECT_THAT(Update({on("book1")}), ElementsAre("+book1", "-mug1"));
  EXPECT_THAT(Update({on("mug2")}), ElementsAre("-book1", "+mug2"));
  EXPECT_THAT(Add({MakeFluent("Mug", "mug2", {{"hasPose", "Pose", std::string("p")}})}),
              ElementsAre("~mug2"));
  EXPECT_THAT(Remove({"onMug1"}), ElementsAre("-mug2"));
  EXPECT_THAT(Add({on("mug9")}), IsEmpty());
  EXPECT_THAT(Add({MakeFluent("Mug", "mug9")}), ElementsAre("+mug9"));
}

TEST_F(DemandTest, AConstantInTheQueryIsWatched) {
  Watch(Topic({"select ?i {race:leftArm1 race:hasArmPosture ?i}"}));
  EXPECT_THAT(Snapshot(), ElementsAre("+postureLeftArm1"));
  const auto arm = [](const std::string& posture) {
    return MakeFluent("Arm", "leftArm1", {{"hasArmPosture", "ArmPosture", posture}});
  };
  EXPECT_THAT(Update({arm("postureTorso1")}), ElementsAre("-postureLeftArm1", "+postureTorso1"));
  EXPECT_THAT(Remove({"leftArm1"}), ElementsAre("-postureTorso1"));
}

// Sequence numbers --------------------------------------------------------------------------------

TEST_F(DemandTest, EveryMessageNamesTheOneBeforeSoThatAGapShows) {
  Watch(Below("Mug"));
  const DemandUpdate snapshot = demand_->Snapshot(store_);
  EXPECT_TRUE(snapshot.snapshot);
  EXPECT_EQ(snapshot.last_sequence, store_.last_sequence());
  const DemandUpdate first = Apply(store_.Add({MakeFluent("Mug", "mug3")}, By(1.0)));
  EXPECT_EQ(first.previous, snapshot.last_sequence);
  EXPECT_TRUE(Apply(store_.Add({MakeFluent("Book", "book2")}, By(2.0))).changes.empty());
  const DemandUpdate second = Apply(store_.Remove({"mug3"}, By(3.0)));
  EXPECT_EQ(second.previous, first.last_sequence);  // nothing was told of the book
  EXPECT_EQ(second.first_sequence, store_.last_sequence());
  const DemandUpdate third = Apply(store_.Remove({"mug2"}, By(4.0)));
  EXPECT_NE(third.previous, first.last_sequence);  // who missed the second one, sees it
}

TEST_F(DemandTest, ALaterSnapshotJoinsOnToTheNextMessage) {
  Watch(Below("Mug"));
  Snapshot();
  const DemandUpdate told = Apply(store_.Add({MakeFluent("Mug", "mug3")}, By(1.0)));
  Apply(store_.Add({MakeFluent("Book", "book2")}, By(2.0)));
  const DemandUpdate snapshot = demand_->Snapshot(store_);
  EXPECT_THAT(ToldBy(snapshot), ElementsAre("+mug1", "+mug2", "+mug3"));
  EXPECT_EQ(snapshot.last_sequence, told.last_sequence);
  EXPECT_EQ(Apply(store_.Remove({"mug3"}, By(3.0))).previous, snapshot.last_sequence);
}

TEST_F(DemandTest, ChangesThatASnapshotKnewAreNotToldAgain) {
  Watch(Below("Mug"));
  Snapshot();
  const std::vector<Change> changes = store_.Add({MakeFluent("Mug", "mug3")}, By(1.0));
  const DemandUpdate snapshot = demand_->Snapshot(store_);
  EXPECT_THAT(ToldBy(snapshot), ElementsAre("+mug1", "+mug2", "+mug3"));
  EXPECT_THAT(Apply(changes).changes, IsEmpty());
  EXPECT_EQ(Apply(store_.Remove({"mug3"}, By(2.0))).previous, snapshot.last_sequence);
}

TEST_F(DemandTest, ImaginedChangesAreNotTold) {
  Watch(Below("Mug"));
  Snapshot();
  const auto episode = store_.StartEpisode("serve", Episode::Label::kImagined, 0, 1.0);
  const auto changes =
      store_.Add({MakeFluent("Mug", "dreamt")}, At(2.0, episode.id, Source::kKnowledge));
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_THAT(Apply(changes).changes, IsEmpty());
}

TEST_F(DemandTest, ApplyingBeforeTheFirstSnapshotIsAMistake) {
  Watch(Below("Mug"));
  EXPECT_THROW(Apply({}), std::logic_error);
}

// The topics as they are configured ---------------------------------------------------------------

TEST_F(DemandTest, TheOriginalsTopicsAllFindWhatTheyName) {
  const std::string path = std::string(HIRES_SHARED_DATA) + "/bb_topics.yaml";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  std::map<std::string, Told> found;
  for (const DemandTopic& topic : LoadKnowledge(path).topics) found[topic.name] = Matching(topic);
  EXPECT_EQ(found.size(), 24u);
  EXPECT_THAT(found["stefan_result"], ElementsAre("+moveBase1"));
  EXPECT_THAT(found["floor_areas"], ElementsAre("+floorArea1", "+manipulationArea1"));
  EXPECT_THAT(found["tabletop_objects"], ElementsAre("+book1", "+mug1"));
  EXPECT_THAT(found["passiveObjectTopic"], ElementsAre("+table1"));
  EXPECT_THAT(found["stefan_dispatcher_trace"],
              ElementsAre("+leftArm1", "+onMug1", "+postureLeftArm1", "+postureTorso1", "+robotAt1",
                          "+table1"));
  EXPECT_THAT(found["robot_activity"], ElementsAre("+moveBase1", "+moveTorso1"));
  EXPECT_THAT(found["stefan_blocked"], IsEmpty());
}

// What is refused ---------------------------------------------------------------------------------

TEST(DemandErrorTest, ErrorsNameTheTopicAndWhatIsWrong) {
  EXPECT_THAT(ErrorOf(Topic()), HasSubstr("topic 'wanted': no filter; wanted at least one of"));
  EXPECT_THAT(ErrorOf(Below("Mugg")), HasSubstr("topic 'wanted': concept 'Mugg' is unknown"));
  EXPECT_THAT(ErrorOf(Below("Mugg")), HasSubstr("did you mean 'Mug'"));
  EXPECT_THAT(ErrorOf(Topic({"select ?x {?x a race:Mugg}"})),
              HasSubstr("topic 'wanted': query 1:17: concept 'Mugg' is unknown"));
  EXPECT_THAT(ErrorOf(Topic({"select ?c {?x a ?c}"})),
              HasSubstr("came ?c as the first selected variable, which stands for concepts"));
  DemandTopic topic = Topic();
  topic.properties = {"hasPoses"};
  EXPECT_THAT(ErrorOf(topic), HasSubstr("topic 'wanted': relation 'hasPoses' is unknown"));
  topic.name.clear();
  EXPECT_THAT(ErrorOf(topic), HasSubstr("a topic without a name"));
}

TEST_F(DemandTest, AQueryThatGrowsTooLargeIsAnErrorThatNamesTheTopic) {
  std::vector<Fluent> mugs;
  for (int i = 0; i < 101; ++i) mugs.push_back(MakeFluent("Mug", "more" + std::to_string(i)));
  store_.Add(mugs, By(1.0));
  Watch(Topic({"select ?a {?a a race:Mug. ?b a race:Mug. ?c a race:Mug}"}));
  try {
    Snapshot();
    FAIL() << "103^3 rows are more than a million";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("topic 'wanted': query: came more than 1000000"));
  }
}

}  // namespace
}  // namespace hires::knowledge::demand_test
