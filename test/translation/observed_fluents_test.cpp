#include "hires/translation/observed_fluents.h"

#include <gmock/gmock.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/knowledge/state_view.h"
#include "hires/knowledge/store.h"
#include "support/restaurant_translation.h"

namespace hires::translation::observed_fluents_test {
namespace {

using test_support::RestaurantContext;
using test_support::Texts;
using testing::Contains;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// A Blackboard that believes every word.
class ObservedFluentsTest : public testing::Test {
 protected:
  ObservedFluentsTest() : store_(":memory:", RestaurantContext().ontology) {
    store_.Add(test_support::RestaurantFluents(),
               {knowledge::Source::kKnowledge, 0, -temporal::kForever});
    observed_.state.robot.X_MB = {12.5, 11.8, 3.14};
    observed_.state.robot.joints = RestaurantContext().robot->profile.joints;
  }

  FluentUpdate Changes() const {
    return ChangesFrom(RestaurantContext(), knowledge::LiveView(store_), observed_);
  }

  /// Says what is new; what remains to be said after that must be nothing.
  FluentUpdate Tell() {
    const FluentUpdate update = Changes();
    const knowledge::Assertion by{knowledge::Source::kObservation, 0, ++time_};
    if (!update.added.empty()) store_.Add(update.added, by);
    if (!update.updated.empty()) store_.Update(update.updated, by);
    if (!update.removed.empty()) store_.Remove(update.removed, by);
    EXPECT_TRUE(Changes().empty()) << "observed the same and had something to say";
    return update;
  }

  std::vector<std::string> State() const {
    return Texts(knowledge::StateAtoms(knowledge::LiveView(store_), *RestaurantContext().ontology));
  }

  world::ObjectState* See(const std::string& name, double x, double y, double z,
                          const std::string& model = "coffee_cup") {
    world::ObjectState* known = observed_.state.world.Find(name);
    if (known == nullptr) {
      observed_.state.world.objects.emplace_back();
      known = &observed_.state.world.objects.back();
    }
    known->name = name;
    known->model = model;
    known->X_MO.translation = {x, y, z};
    return known;
  }

  static std::vector<std::string> Names(const std::vector<knowledge::Fluent>& fluents) {
    std::vector<std::string> names;
    for (const auto& fluent : fluents) names.push_back(fluent.instance);
    return names;
  }

  knowledge::Store store_;
  ObservedWorld observed_;
  double time_{100.0};
};

TEST_F(ObservedFluentsTest, PlaceAndPosturesOfTheRobotAreCorrected) {
  const FluentUpdate update = Tell();
  EXPECT_THAT(Names(update.added), Contains("robotAtPR21"));
  EXPECT_THAT(Names(update.added), Not(Contains("posePR21"))) << "it stands where it is known";
  EXPECT_THAT(State(), Contains("RobotAt(nearstartarea1)"));
  EXPECT_THAT(State(), Not(Contains("RobotAt(floorareatamsrestaurant1)")));
}

TEST_F(ObservedFluentsTest, WhatIsKnownAlreadyIsNotSaidAgain) {
  Tell();
  See("mug1", 5.375, 10.262, 0.751);  // 0.006 m from where it is believed
  EXPECT_TRUE(Changes().empty());
  See("mug1", 5.40, 10.26, 0.75);
  const FluentUpdate update = Tell();
  EXPECT_THAT(Names(update.added), testing::ElementsAre("poseMug1"));
  EXPECT_TRUE(update.updated.empty());
  EXPECT_TRUE(update.removed.empty());
}

TEST_F(ObservedFluentsTest, AThingOfUnknownKindIsToldWithItsBoxAndReadBack) {
  See("unknown1", 5.40, 10.26, 0.75, "unknown_0.120x0.080x0.200");
  Tell();
  const knowledge::LiveView view(store_);
  ASSERT_NE(view.Find("unknown1"), nullptr);
  EXPECT_EQ(view.Find("unknown1")->concept_name, "UnknownObject");
  EXPECT_THAT(State(), Contains(StartsWith("On(unknown1, ")));
  const TranslatorContext known = WithKnowledge(RestaurantContext(), view);
  EXPECT_EQ(known.ModelOf("unknown1"), "unknown_0.120x0.080x0.200");
  EXPECT_EQ(known.FindModel("unknown2"), "") << "what is unknown is like nothing else";
}

TEST_F(ObservedFluentsTest, ANewThingIsNoMoreThanAllModelsOfItsFormAre) {
  See("mug7", 7.48, 11.28, 0.73, "coffee_cup");
  See("mill7", 7.48, 11.08, 0.73, "peppermill_repository");
  See("mill8", 7.48, 10.88, 0.73, "peppermill_appendix");
  See("knife7", 7.28, 11.08, 0.73, "knife");
  See("fork7", 7.28, 10.88, 0.73, "fork");
  See("block7", 7.28, 11.28, 0.73, "block");
  Tell();
  const knowledge::LiveView view(store_);
  EXPECT_EQ(view.Find("mug7")->concept_name, "Mug") << "hot ones look so, and are mugs";
  EXPECT_EQ(view.Find("mill7")->concept_name, "Peppermill") << "as the one of the thesis";
  EXPECT_EQ(view.Find("mill8")->concept_name, "Kitchenware") << "the vase looks so";
  EXPECT_EQ(view.Find("knife7")->concept_name, "Kitchenware") << "the spoon looks so";
  EXPECT_EQ(view.Find("fork7")->concept_name, "Fork");
  EXPECT_EQ(view.Find("block7")->concept_name, "TabletopObject") << "no concept of the ontology";
}

TEST(ConceptsTest, ABlockOfConceptsIsRefusedWithItsNewHome) {
  const auto in = base::ParamReader::FromString("concepts: {coffee_cup: Mug}", "tracker.yaml");
  try {
    RefuseConcepts(in);
    FAIL() << "was taken";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("worlds/objects.yaml"));
  }
}

TEST_F(ObservedFluentsTest, ABoxThatIsMeasuredAnewIsToldAnew) {
  See("unknown1", 5.40, 10.26, 0.75, "unknown_0.120x0.080x0.200");
  Tell();
  EXPECT_TRUE(Changes().empty());
  See("unknown1", 5.40, 10.26, 0.75, "unknown_0.160x0.080x0.200");
  Tell();
  EXPECT_TRUE(Changes().empty());
  const TranslatorContext known = WithKnowledge(RestaurantContext(), knowledge::LiveView(store_));
  EXPECT_EQ(known.ModelOf("unknown1"), "unknown_0.160x0.080x0.200");
}

TEST_F(ObservedFluentsTest, ABoxThatCannotBeIsRefusedWithTheThingsName) {
  See("unknown1", 5.40, 10.26, 0.75, "unknown_0.120x0.080x0.000");
  try {
    Changes();
    FAIL();
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("object 'unknown1'"));
  }
}

TEST_F(ObservedFluentsTest, NoiseAtABorderDoesNotFlap) {
  Tell();
  See("mug1", 5.644, 10.26, 0.75);  // the area ends at 5.645
  Tell();
  EXPECT_THAT(State(), Contains("On(mug1, placingareaeastrightcounter1)"));
  base::Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    observed_.state.world.Find("mug1")->X_MO.translation.x() = 5.645 + rng.Uniform(-0.009, 0.009);
    for (const std::string& name : Names(Tell().added)) EXPECT_EQ(name, "poseMug1");
  }
  EXPECT_THAT(State(), Contains("On(mug1, placingareaeastrightcounter1)"));
}

TEST_F(ObservedFluentsTest, ANewObjectIsIntroducedWithConceptPoseAndBox) {
  See("book1", 7.48, 11.28, 0.73, "book");
  See("mug9", 7.89, 11.28, 0.73);
  const FluentUpdate update = Tell();
  EXPECT_THAT(Names(update.added), testing::IsSupersetOf({"book1", "poseBook1", "boundingBoxBook1",
                                                          "onBook1", "mug9", "onMug9"}));
  EXPECT_THAT(State(), Contains("On(book1, placingareawestrighttable1)"));
  EXPECT_THAT(State(), Contains("Type(book, book1)"));
  EXPECT_THAT(State(), Contains("Type(mug, mug9)"));
  const auto on = store_.Find("onBook1");
  ASSERT_TRUE(on);
  EXPECT_EQ(on->properties[0].type, "Book");
  EXPECT_EQ(std::get<std::string>(on->properties[1].filler), "placingAreaWestRightTable1");
}

TEST_F(ObservedFluentsTest, AnObjectWithoutAPlaceGetsOne) {
  See("mug3", 7.48, 11.28, 0.73);
  const FluentUpdate update = Tell();
  EXPECT_THAT(Names(update.updated), testing::ElementsAre("mug3"));
  EXPECT_THAT(State(), Contains("On(mug3, placingareawestrighttable1)"));
  EXPECT_THAT(State(), Contains("Type(mug, mug3)"));
}

TEST_F(ObservedFluentsTest, WhatTheObjectIsOtherwiseStays) {
  See("mug1", 5.40, 10.26, 0.75);
  Tell();
  EXPECT_THAT(State(), Contains("Type(coffee, mug1)"));
}

TEST_F(ObservedFluentsTest, AGraspedObjectLeavesItsPlaceAndTravelsWithTheHand) {
  observed_.state.robot.X_MB = {5.9, 10.11, 3.14};
  world::ObjectState* mug = See("mug1", 5.4, 10.2, 0.9);
  mug->attached_to = "r_gripper_palm_link";
  Tell();
  EXPECT_THAT(State(), Contains("Holding(rightarm1, mug1)"));
  EXPECT_THAT(State(), Not(Contains("Holding(rightarm1, nothing)")));
  EXPECT_THAT(State(), Not(Contains(StartsWith("On(mug1"))));
  const auto pose = store_.Find("poseMug1");
  ASSERT_TRUE(pose);
  EXPECT_EQ(std::get<std::string>(pose->properties.back().filler), "r_gripper_palm_link");
  // The base drives a little, and the mug goes with it: nothing new.
  observed_.state.robot.X_MB.x += 0.05;
  mug->X_MO.translation.x() += 0.05;
  EXPECT_TRUE(Changes().empty());
  // Put down on the table.
  mug->attached_to.clear();
  mug->X_MO.translation = {7.48, 11.62, 0.73};
  Tell();
  EXPECT_THAT(State(), Contains("Holding(rightarm1, nothing)"));
  EXPECT_THAT(State(), Contains("On(mug1, placingareawestlefttable1)"));
  EXPECT_EQ(store_.Find("poseMug1")->properties.size(), 4u) << "in the map again";
}

TEST_F(ObservedFluentsTest, WhatStandsOnTheTrayIsThereInTheBasesFrame) {
  const auto put = [&](const geometry::Pose2& X_MB) {
    observed_.state.robot.X_MB = X_MB;
    const Eigen::Vector3d p_M = geometry::Lift(X_MB) * Eigen::Vector3d(0.28, 0.0, 0.3462);
    world::ObjectState* mill = See("peppermill1", p_M.x(), p_M.y(), p_M.z(), "peppermill_thesis");
    mill->X_MO.rotation = geometry::Lift(X_MB).rotation;
  };
  put({6.8, 10.1, 3.14});
  Tell();
  EXPECT_THAT(State(), Contains("On(peppermill1, trayarea1)"));
  put({7.3, 10.3, 1.5});
  for (const std::string& name : Names(Changes().added)) {
    EXPECT_THAT((std::vector<std::string>{"posePR21", "robotAtPR21"}), Contains(name));
  }
}

TEST_F(ObservedFluentsTest, AnObjectThatFellIsOnNothingButKeepsItsPose) {
  world::ObjectState* mug = See("mug1", 5.4, 10.2, 0.79);
  mug->X_MO.rotation = geometry::RotationFromRpy(1.57, 0.0, 0.4);
  Tell();
  EXPECT_THAT(State(), Not(Contains(StartsWith("On(mug1"))));
  ASSERT_TRUE(store_.Find("poseMug1"));
}

TEST_F(ObservedFluentsTest, AVanishedObjectHasNeitherPlaceNorPose) {
  observed_.vanished = {"mug1"};
  const FluentUpdate update = Tell();
  EXPECT_THAT(update.removed, testing::UnorderedElementsAre("poseMug1", "onMug1"));
  EXPECT_THAT(State(), Contains("Type(mug, mug1)")) << "it is known, and nobody knows where";
  EXPECT_THAT(State(), Contains("On(mug2, placingareaeastrightcounter1)"));
  observed_.vanished.clear();
  See("mug1", 7.48, 11.62, 0.73);
  Tell();
  EXPECT_THAT(State(), Contains("On(mug1, placingareawestlefttable1)"));
  EXPECT_TRUE(store_.Find("poseMug1"));
}

TEST_F(ObservedFluentsTest, ObjectsOfWhichNothingWasSeenStayAsTheyAreBelieved) {
  Tell();
  EXPECT_THAT(State(), Contains("On(mug2, placingareaeastrightcounter1)"));
  EXPECT_TRUE(Changes().removed.empty());
}

TEST_F(ObservedFluentsTest, WhatIsSaidStandsForTheAtomsOfWhatWasObserved) {
  base::Rng rng(17);
  for (int i = 0; i < 60; ++i) {
    observed_.state.robot.X_MB = {rng.Uniform(5.0, 13.0), rng.Uniform(9.5, 13.0),
                                  rng.Uniform(-3.0, 3.0)};
    observed_.state.robot.joints["torso_lift_joint"] = rng.Uniform(0.0115, 0.3);
    for (const char* name : {"mug1", "mug2", "mug5"}) {
      See(name, rng.Uniform(5.2, 8.2), rng.Uniform(9.8, 11.8), 0.74);
    }
    Tell();
    std::vector<base::Atom> said;
    const knowledge::LiveView view(store_);
    for (const auto& atom : knowledge::StateAtoms(view, *RestaurantContext().ontology)) {
      if (atom.predicate == "On" && atom.arguments[0] == "peppermill1") continue;  // not observed
      if (IsObservable(atom)) said.push_back(atom);
    }
    // What was said before counts at borders, so compare with it.
    EXPECT_EQ(Texts(said), Texts(AtomsOf(RestaurantContext(), observed_.state, &said)));
  }
}

TEST_F(ObservedFluentsTest, TemperaturesAreSaidOfWhatIsKnownAndAgainWhereTheyChange) {
  Tell();
  observed_.temperatures = {{"mug2", 62.54}, {"unheard_of", 30.0}};
  EXPECT_THAT(Names(Tell().added), testing::ElementsAre("hasTemperatureMug2"));
  EXPECT_THAT(State(), Contains("HasTemperature(mug2, 62.5)"));
  observed_.temperatures["mug2"] = 61.6;  // less than 1 K
  EXPECT_TRUE(Changes().empty());
  observed_.temperatures["mug2"] = 61.2;
  Tell();
  EXPECT_THAT(State(), Contains("HasTemperature(mug2, 61.2)"));
  EXPECT_THAT(State(), Not(Contains("HasTemperature(mug2, 62.5)")));
}

TEST_F(ObservedFluentsTest, ATemperatureIsSaidOfAThingThatIsSeenForTheFirstTime) {
  See("book1", 7.48, 11.28, 0.73, "book");
  observed_.temperatures = {{"book1", 19.0}};
  EXPECT_THAT(Names(Tell().added), Contains("hasTemperatureBook1"));
  EXPECT_THAT(State(), Contains("HasTemperature(book1, 19)"));
}

TEST_F(ObservedFluentsTest, PosesThatAreNoNumbersAndUnknownModelsAreErrors) {
  See("mug1", std::nan(""), 0.0, 0.0);
  EXPECT_THROW(Changes(), base::ConfigError);
  observed_.state.world.objects.clear();
  See("teapot1", 7.0, 11.0, 0.7, "teapot");
  EXPECT_THROW(Changes(), base::ConfigError);
}

}  // namespace
}  // namespace hires::translation::observed_fluents_test
