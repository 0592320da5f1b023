#include "hires/knowledge/state_view.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/live_view.h"
#include "hires/knowledge/store.h"
#include "knowledge/support/store_world.h"
#include "support/property.h"

namespace hires::knowledge::state_view_test {
namespace {

using base::Atom;
using test_support::MakeFluent;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSubsetOf;
using ::testing::Not;
using ::testing::ThrowsMessage;
using ::testing::UnorderedElementsAre;

constexpr test_support::PropertyCases kPropertyCases{200, 40};

const std::string kRoot = HIRES_SOURCE_DIR;
using Texts = std::vector<std::string>;

std::shared_ptr<const Ontology> TheOntology() {
  static const auto ontology = std::make_shared<const Ontology>(Ontology::FromFiles(
      {kRoot + "/config/ontology/upper.ttl", kRoot + "/config/ontology/race.ttl"}));
  return ontology;
}

/// What holds when just these fluents were told.
LiveView ViewOf(const std::vector<Fluent>& fluents) {
  Store store(":memory:", TheOntology());
  store.Add(fluents, {Source::kKnowledge, 0, -temporal::kForever});
  return LiveView(store);
}

const LiveView& Restaurant() {
  static const LiveView view =
      ViewOf(LoadKnowledge(kRoot + "/config/knowledge/restaurant.yaml").fluents);
  return view;
}

Texts ToTexts(const std::vector<Atom>& atoms) {
  Texts texts;
  for (const Atom& atom : atoms) texts.push_back(base::ToString(atom));
  return texts;
}

Texts Said(const FluentView& view) { return ToTexts(StateAtoms(view, *TheOntology())); }

Fluent OnFluent(const std::string& object, const std::string& area) {
  return MakeFluent(
      "On", "on_" + object,
      {{"hasPhysicalEntity", "PassiveObject", object}, {"hasArea", "PlacingArea", area}});
}

/// Facts `(Predicate word word)` of a text of Lisp, as atoms in text.
std::set<std::string> FactsIn(const std::string& lisp) {
  const std::string code = std::regex_replace(lisp, std::regex(";[^\n]*"), "");
  const std::regex fact("\\(([A-Za-z_]+)((?:\\s+[a-z0-9_]+)+)\\)");
  std::set<std::string> facts;
  for (auto it = std::sregex_iterator(code.begin(), code.end(), fact); it != std::sregex_iterator();
       ++it) {
    std::istringstream words((*it)[2]);
    facts.insert(
        base::ToString(Atom{(*it)[1], Texts(std::istream_iterator<std::string>(words), {})}));
  }
  return facts;
}

std::set<std::string> StateOfProblem(const std::string& problem) {
  const std::string text =
      base::ReadTextFile(kRoot + "/config/domains/problems/" + problem + ".lisp");
  return FactsIn(text.substr(0, text.rfind("((")));  // without the tasks
}

/// Facts that hold in every state: the last part of the domain.
std::set<std::string> FactsOfDomain() {
  const std::string text = base::ReadTextFile(kRoot + "/config/domains/restaurant.lisp");
  return FactsIn(text.substr(text.find(";;; 4. The restaurant")));
}

// Atoms of each kind ------------------------------------------------------------------------------

TEST(StateAtomsTest, NothingHoldsInAnEmptyView) { EXPECT_THAT(Said(ViewOf({})), IsEmpty()); }

TEST(StateAtomsTest, StatesOfTheRobot) {
  EXPECT_THAT(
      Said(ViewOf(
          {MakeFluent("RobotAt", "robotAtPR21",
                      {{"hasRobot", "Robot", "PR21"}, {"hasArea", "FloorArea", "floorA1"}}),
           MakeFluent("ArmToSidePosture", "postureLeftArm1", {{"hasArm", "Arm", "leftArm1"}}),
           MakeFluent("TorsoUpPosture", "postureTorso1", {{"hasTorso", "Torso", "torso1"}}),
           MakeFluent("Holding", "holdingLeftArm1",
                      {{"hasArm", "Arm", "leftArm1"}, {"hasPassiveObject", "NoObject", "nothing"}}),
           MakeFluent("NoObject", "nothing")})),
      ElementsAre("HasArmPosture(leftarm1, armtosideposture)", "HasTorsoPosture(torsoupposture)",
                  "Holding(leftarm1, nothing)", "RobotAt(floora1)"));
}

TEST(StateAtomsTest, ObjectsTheirConceptsAndContents) {
  EXPECT_THAT(
      Said(ViewOf({OnFluent("Mug1", "placingArea1"),
                   MakeFluent("Mug", "Mug1", {{"hasContent", "Coffee", "coffee1"}})})),
      ElementsAre("On(mug1, placingarea1)", "Type(coffee, mug1)", "Type(kitchenware, mug1)",
                  "Type(mug, mug1)", "Type(passiveobject, mug1)", "Type(tabletopobject, mug1)"));
}

TEST(StateAtomsTest, WhatIsKnownOfAContentCountsMoreThanTheTypeOfTheLink) {
  const Fluent mug = MakeFluent("Mug", "mug1", {{"hasContent", "Substance", "inMug1"}});
  EXPECT_THAT(Said(ViewOf({mug})), Contains("Type(substance, mug1)"));
  const Texts said = Said(ViewOf({mug, MakeFluent("Milk", "inMug1")}));
  EXPECT_THAT(said, Contains("Type(milk, mug1)"));
  EXPECT_THAT(said, Not(Contains("Type(substance, mug1)")));
}

TEST(StateAtomsTest, AreasOfFurnitureHaveTheRankOfTheirPlace) {
  EXPECT_THAT(
      Said(ViewOf({MakeFluent("Table", "table1",
                              {{"hasPlacingArea", "PlacingArea", "areaB"},
                               {"hasPlacingArea", "PlacingArea", "areaA"}}),
                   MakeFluent("SittingArea", "seat1",
                              {{"hasPlacingAreaLeft", "PlacingArea", "areaA"},
                               {"hasPlacingAreaRight", "PlacingArea", "areaB"}})})),
      ElementsAre("Type(furniture, table1)", "Type(passiveobject, table1)", "Type(table, table1)",
                  "hasPlacingArea(table1, areaa, 2)", "hasPlacingArea(table1, areab, 1)",
                  "hasPlacingAreaLeft(seat1, areaa)", "hasPlacingAreaRight(seat1, areab)"));
}

TEST(StateAtomsTest, GuestsAndWays) {
  EXPECT_THAT(Said(ViewOf({MakeFluent("At", "atGuest1",
                                      {{"hasArea", "SittingArea", "seat1"},
                                       {"hasPhysicalEntity", "Guest", "guest1"}}),
                           MakeFluent("Connected", "connected1",
                                      {{"hasPreManipulationArea", "PreManipulationArea", "c"},
                                       {"hasManipulationArea", "ManipulationArea", "b"},
                                       {"hasPlacingArea", "PlacingArea", "a"}})})),
              ElementsAre("At(guest1, seat1)", "Connected(a, b, c)"));
}

TEST(StateAtomsTest, TemperaturesAreNumbersInCelsius) {
  EXPECT_THAT(Said(ViewOf({MakeFluent(
                  "HasTemperature", "hasTemperatureMug1",
                  {{"hasPhysicalEntity", "Mug", "mug1"}, {"hasDegrees", "xsd:float", 62.5}})})),
              ElementsAre("HasTemperature(mug1, 62.5)", "TemperatureKnown(mug1)"));
}

TEST(StateAtomsTest, WishesAndFailuresThatWereImagined) {
  EXPECT_THAT(
      Said(ViewOf({MakeFluent("ImagineWish", "w1", {{"hasAction", "xsd:string", "place_object"}}),
                   MakeFluent("ObserveWish", "w2", {{"hasAction", "xsd:string", "pick_up_object"}}),
                   MakeFluent("ImaginedFailure", "f1",
                              {{"hasAction", "xsd:string", "move_base_param"},
                               {"hasArgument", "xsd:string", "Area1"},
                               {"hasArgument", "xsd:string", "fast"}})})),
      ElementsAre("imagine(place_object)", "imagined_failure(move_base_param, area1, fast)",
                  "observe(pick_up_object)"));
}

TEST(StateAtomsTest, AFluentThatLacksARoleSaysNothing) {
  EXPECT_THAT(Said(ViewOf({MakeFluent("On", "on1", {{"hasPhysicalEntity", "Mug", "mug1"}}),
                           MakeFluent("RobotAt", "robotAt1"), MakeFluent("Table", "nothing1")})),
              ElementsAre("Type(furniture, nothing1)", "Type(passiveobject, nothing1)",
                          "Type(table, nothing1)"));
}

TEST(StateAtomsTest, AnOntologyWithoutTheConceptsHasNoStates) {
  Store store(":memory:", test_support::SmallOntology());
  store.Add({MakeFluent("Mug", "mug1")}, test_support::At(1.0));
  EXPECT_THAT(StateAtoms(LiveView(store), *test_support::SmallOntology()), IsEmpty());
}

// The planner's problem ---------------------------------------------------------------------------

TEST(RestaurantStateTest, HoldsAllThatTheProblemAndTheDomainSay) {
  const Texts said = Said(Restaurant());
  EXPECT_EQ(StateOfProblem("serve_coffee").size(), 15u);
  EXPECT_EQ(FactsOfDomain().size(), 29u);
  EXPECT_THAT(StateOfProblem("serve_coffee"), IsSubsetOf(said));
  EXPECT_THAT(FactsOfDomain(), IsSubsetOf(said));
}

TEST(RestaurantStateTest, HoldsNothingElseButTheOtherObjectsAndWiderConcepts) {
  std::set<std::string> expected = StateOfProblem("serve_coffee");
  expected.merge(FactsOfDomain());
  expected.insert("On(peppermill1, placingareaeastrightcounter1)");
  Texts others;
  for (const std::string& atom : Said(Restaurant())) {
    if (expected.count(atom) == 0) others.push_back(atom);
  }
  const auto is_type = [](const std::string& atom) { return atom.rfind("Type(", 0) == 0; };
  EXPECT_TRUE(std::all_of(others.begin(), others.end(), is_type)) << base::Join(others, "\n");
  EXPECT_THAT(others, Contains("Type(mug, mug3)").Times(1));
  EXPECT_THAT(others, Not(Contains(HasSubstr("nothing"))));
  std::set<std::string> types;  // of what the problem leaves out, and wider ones of all
  for (const std::string& atom : others) types.insert(atom.substr(5, atom.find(',') - 5));
  EXPECT_THAT(types,
              IsSubsetOf(Texts{"passiveobject", "tabletopobject", "kitchenware", "furniture", "mug",
                               "coffeejug", "milkpot", "sugarpot", "peppermill", "chair", "board",
                               "building", "wall", "horizontaltable", "table"}));
}

TEST(StateAtomsTest, WantedPredicatesAreThoseOfTheWholeStateInItsOrder) {
  const auto is_wanted = [](const std::string& predicate) {
    return predicate == "On" || predicate == "RobotAt" || predicate == "Type";
  };
  std::vector<Atom> expected;
  for (const Atom& atom : StateAtoms(Restaurant(), *TheOntology())) {
    if (is_wanted(atom.predicate)) expected.push_back(atom);
  }
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(ToTexts(StateAtoms(Restaurant(), *TheOntology(), is_wanted)), ToTexts(expected));
}

TEST(RestaurantStateTest, IsSortedWithoutRepetitions) {
  std::vector<std::pair<std::string, Texts>> atoms;
  for (const Atom& atom : StateAtoms(Restaurant(), *TheOntology())) {
    atoms.emplace_back(atom.predicate, atom.arguments);
  }
  EXPECT_TRUE(std::is_sorted(atoms.begin(), atoms.end()));
  EXPECT_EQ(std::adjacent_find(atoms.begin(), atoms.end()), atoms.end());
}

// Effects -----------------------------------------------------------------------------------------

class ProjectedViewTest : public ::testing::Test {
 protected:
  ProjectedView view_{&Restaurant(), TheOntology().get()};
  const Texts before_ = Said(Restaurant());

  Texts New() const {
    Texts atoms = Said(view_), only;
    std::set_difference(atoms.begin(), atoms.end(), before_.begin(), before_.end(),
                        std::back_inserter(only));
    return only;
  }
  Texts Gone() const {
    Texts atoms = Said(view_), only;
    std::set_difference(before_.begin(), before_.end(), atoms.begin(), atoms.end(),
                        std::back_inserter(only));
    return only;
  }
};

TEST_F(ProjectedViewTest, WithoutEffectsIsTheViewBelow) { EXPECT_EQ(Said(view_), before_); }

TEST_F(ProjectedViewTest, PicksUpAsTheOperatorDoes) {
  view_.Delete({"On", {"mug1", "placingareaeastrightcounter1"}});
  view_.Delete({"Holding", {"rightarm1", "nothing"}});
  view_.Add({"Holding", {"rightarm1", "mug1"}});
  EXPECT_THAT(Gone(),
              ElementsAre("Holding(rightarm1, nothing)", "On(mug1, placingareaeastrightcounter1)"));
  EXPECT_THAT(New(), ElementsAre("Holding(rightarm1, mug1)"));
  EXPECT_EQ(view_.Find("onMug1"), nullptr);
  EXPECT_EQ(*view_.Find("holdingRightArm1"),
            MakeFluent("Holding", "holdingRightArm1",
                       {{"hasArm", "Arm", "rightArm1"}, {"hasPassiveObject", "Mug", "mug1"}}));
  EXPECT_EQ(Said(Restaurant()), before_) << "the view below stays as it is";
}

TEST_F(ProjectedViewTest, StateVariablesReplaceTheirValueAndKeepTheirInstance) {
  view_.Add({"RobotAt", {"premanipulationareaeastcounter1"}});
  view_.Add({"HasTorsoPosture", {"torsoupposture"}});
  view_.Add({"HasArmPosture", {"leftarm1", "armtuckedposture"}});
  view_.Add({"On", {"mug2", "trayarea1"}});
  view_.Add({"At", {"guest1", "sittingareanorthtable2"}});
  EXPECT_THAT(New(), ElementsAre("At(guest1, sittingareanorthtable2)",
                                 "HasArmPosture(leftarm1, armtuckedposture)",
                                 "HasTorsoPosture(torsoupposture)", "On(mug2, trayarea1)",
                                 "RobotAt(premanipulationareaeastcounter1)"));
  EXPECT_EQ(Gone().size(), 5u);
  EXPECT_EQ(view_.Find("postureLeftArm1")->concept_name, "ArmTuckedPosture");
  EXPECT_EQ(view_.Find("postureTorso1")->concept_name, "TorsoUpPosture");
  EXPECT_EQ(*view_.Find("robotAtPR21"),
            MakeFluent("RobotAt", "robotAtPR21",
                       {{"hasRobot", "Robot", "PR21"},
                        {"hasArea", "PreManipulationArea", "preManipulationAreaEastCounter1"}}));
}

TEST_F(ProjectedViewTest, NamesAndPredicatesAreReadWithoutRegardToCase) {
  view_.Delete({"ON", {"Mug1", "PlacingAreaEastRightCounter1"}});
  view_.Add({"robotat", {"PreManipulationAreaEastCounter1"}});
  EXPECT_THAT(Gone(), Contains("On(mug1, placingareaeastrightcounter1)"));
  EXPECT_THAT(New(), ElementsAre("RobotAt(premanipulationareaeastcounter1)"));
}

TEST_F(ProjectedViewTest, NewStatesAreNamedAfterWhatTheyAreAbout) {
  view_.Add({"On", {"mug3", "placingareawestlefttable1"}});
  view_.Add({"imagine", {"place_object"}});
  view_.Add({"imagined_failure", {"place_object", "mug1", "leftarm1"}});
  view_.Add({"imagined_failure", {"place_object", "mug2", "leftarm1"}});
  EXPECT_EQ(*view_.Find("onMug3"),
            MakeFluent("On", "onMug3",
                       {{"hasPhysicalEntity", "Mug", "mug3"},
                        {"hasArea", "PlacingArea", "placingAreaWestLeftTable1"}}));
  EXPECT_EQ(view_.Find("imaginePlaceObject")->concept_name, "ImagineWish");
  EXPECT_EQ(view_.Find("imaginedFailurePlaceObject_2")->properties.at(1).filler,
            Filler(std::string("mug2")));
  EXPECT_EQ(New().size(), 4u);
}

TEST_F(ProjectedViewTest, SpeaksOfThingsThatNobodyKnows) {
  view_.Add({"On", {"spoon9", "nowhere"}});
  EXPECT_THAT(New(), ElementsAre("On(spoon9, nowhere)"));
  EXPECT_EQ(view_.Find("onSpoon9")->properties.front().type, "PhysicalEntity");
}

TEST_F(ProjectedViewTest, AnEmptyViewGetsStatesToo) {
  const LiveView nothing = ViewOf({});
  ProjectedView view(&nothing, TheOntology().get());
  view.Add({"RobotAt", {"area1"}});
  view.Add({"HasTorsoPosture", {"torsodownposture"}});
  view.Add({"RobotAt", {"area2"}});
  EXPECT_THAT(Said(view), ElementsAre("HasTorsoPosture(torsodownposture)", "RobotAt(area2)"));
}

TEST_F(ProjectedViewTest, DeletingWhatDoesNotHoldHasNoEffect) {
  view_.Delete({"On", {"mug1", "trayarea1"}});
  view_.Delete({"RobotAt", {"elsewhere"}});
  view_.Delete({"RobotAt", {}});
  view_.Delete({"Type", {"table", "mug1"}});
  view_.Delete({"unheard_of", {"mug1"}});
  EXPECT_EQ(Said(view_), before_);
}

TEST_F(ProjectedViewTest, WhatFollowsFromKnowledgeIsNotChanged) {
  view_.Add({"Type", {"mug", "mug1"}});
  view_.Add({"Type", {"coffee", "mug1"}});
  EXPECT_EQ(Said(view_), before_);
  EXPECT_THAT(
      [&] {
        view_.Add({"Type", {"coffee", "mug2"}});
      },
      ThrowsMessage<base::ConfigError>(AllOf(HasSubstr("Type(coffee, mug2)"),
                                             HasSubstr("effects cannot change"),
                                             HasSubstr("RobotAt, On, Holding"))));
  EXPECT_THAT(
      [&] {
        view_.Delete({"hasPlacingArea", {"table1", "placingareawestlefttable1", "1"}});
      },
      ThrowsMessage<base::ConfigError>(HasSubstr("hasPlacingArea(table1")));
  EXPECT_EQ(Said(view_), before_);
}

TEST_F(ProjectedViewTest, BadEffectsAreRefusedAndChangeNothing) {
  EXPECT_THAT(
      [&] {
        view_.Add({"RobotAts", {"area1"}});
      },
      ThrowsMessage<base::ConfigError>(
          AllOf(HasSubstr("RobotAts(area1)"), HasSubstr("did you mean 'RobotAt'"))));
  EXPECT_THAT(
      [&] {
        view_.Add({"On", {"mug1"}});
      },
      ThrowsMessage<base::ConfigError>(
          AllOf(HasSubstr("On(mug1)"), HasSubstr("has 1 arguments, On takes 2"))));
  EXPECT_THAT(
      [&] {
        view_.Add({"imagined_failure", {}});
      },
      ThrowsMessage<base::ConfigError>(HasSubstr("takes 1 or more")));
  EXPECT_THAT(
      [&] {
        view_.Add({"HasArmPosture", {"leftarm1", "armtukedposture"}});
      },
      ThrowsMessage<base::ConfigError>(HasSubstr("'ArmTuckedPosture'")));
  EXPECT_EQ(Said(view_), before_);
}

// Property ----------------------------------------------------------------------------------------

struct Effect {
  bool add{true};
  Atom atom;
};

void showValue(const Effect& effect, std::ostream& out) {
  out << (effect.add ? "+ " : "- ") << base::ToString(effect.atom) << '\n';
}

rc::Gen<std::string> OneOf(Texts words) { return rc::gen::elementOf(std::move(words)); }

rc::Gen<Atom> Of(const std::string& predicate, std::vector<rc::Gen<std::string>> arguments) {
  return rc::gen::exec([predicate, arguments] {
    Atom atom{predicate, {}};
    for (const auto& argument : arguments) atom.arguments.push_back(*argument);
    return atom;
  });
}

rc::Gen<Effect> AnyEffect() {
  const auto area = OneOf({"placingareaeastrightcounter1", "trayarea1", "Area9"});
  const auto object = OneOf({"mug1", "mug2", "peppermill1", "Spoon9", "nothing"});
  const auto arm = OneOf({"leftarm1", "RightArm1"});
  const auto atom = rc::gen::oneOf(
      Of("RobotAt", {area}), Of("On", {object, area}), Of("Holding", {arm, object}),
      Of("HasArmPosture", {arm, OneOf({"armtuckedposture", "ArmToSidePosture", "armposture"})}),
      Of("HasTorsoPosture", {OneOf({"torsoupposture", "torsodownposture"})}),
      Of("At", {OneOf({"guest1", "guest9"}), area}), Of("Connected", {area, area, object}),
      Of("imagine", {OneOf({"place_object", "move_base"})}), Of("observe", {object}),
      Of("imagined_failure", {object, area}), Of("imagined_failure", {object, area, arm}));
  return rc::gen::map(rc::gen::pair(rc::gen::arbitrary<bool>(), atom),
                      [](const std::pair<bool, Atom>& effect) {
                        return Effect{effect.first, effect.second};
                      });
}

/// A set of atoms to which the same is done in the most obvious way.
class Model {
 public:
  explicit Model(const std::vector<Atom>& atoms) : atoms_(atoms) {}

  void Apply(const Effect& effect) {
    static const std::map<std::string, std::size_t> num_keys = {
        {"RobotAt", 0}, {"HasTorsoPosture", 0}, {"On", 1},
        {"Holding", 1}, {"HasArmPosture", 1},   {"At", 1}};
    Atom atom = effect.atom;
    for (std::string& argument : atom.arguments) argument = base::ToLower(argument);
    const auto found = num_keys.find(atom.predicate);
    const bool is_variable = effect.add && found != num_keys.end();
    const auto same = [&](const Atom& other) {
      if (atom.predicate != other.predicate) return false;
      if (!is_variable) return atom.arguments == other.arguments;
      return std::equal(atom.arguments.begin(),
                        atom.arguments.begin() + static_cast<std::ptrdiff_t>(found->second),
                        other.arguments.begin());
    };
    atoms_.erase(std::remove_if(atoms_.begin(), atoms_.end(), same), atoms_.end());
    if (effect.add) atoms_.push_back(atom);
  }

  std::multiset<std::string> texts() const {
    const Texts texts = ToTexts(atoms_);
    return {texts.begin(), texts.end()};
  }

 private:
  std::vector<Atom> atoms_;
};

HIRES_PROPERTY(ProjectedViewProperty, SaysWhatTheViewBelowSaysWithoutDeletesAndWithAdds, ()) {
  ProjectedView view(&Restaurant(), TheOntology().get());
  Model model(StateAtoms(Restaurant(), *TheOntology()));
  for (const Effect& effect : *rc::gen::container<std::vector<Effect>>(AnyEffect())) {
    effect.add ? view.Add(effect.atom) : view.Delete(effect.atom);
    model.Apply(effect);
  }
  const Texts said = Said(view);
  RC_ASSERT(std::multiset<std::string>(said.begin(), said.end()) == model.texts());
}

/// Everything that is visited, by instance in lower case.
std::map<std::string, Fluent> Everything(const FluentView& view) {
  std::map<std::string, Fluent> fluents;
  std::string last;
  view.All([&](const Fluent& fluent) {
    const std::string name = base::ToLower(fluent.instance);
    RC_ASSERT(last < name);
    last = name;
    fluents.emplace(name, fluent);
    return true;
  });
  return fluents;
}

HIRES_PROPERTY(ProjectedViewProperty, AllWaysToLookAtItAgree, ()) {
  ProjectedView view(&Restaurant(), TheOntology().get());
  for (const Effect& effect : *rc::gen::container<std::vector<Effect>>(AnyEffect())) {
    effect.add ? view.Add(effect.atom) : view.Delete(effect.atom);
  }
  const std::map<std::string, Fluent> all = Everything(view);
  std::vector<Fluent> on, of_mug1;
  for (const auto& [name, fluent] : all) {
    RC_ASSERT(*view.Find(name) == fluent);
    if (fluent.concept_name == "On") on.push_back(fluent);
    const auto& properties = fluent.properties;
    const bool about_mug1 = std::any_of(properties.begin(), properties.end(), [](const auto& one) {
      return one.role == "hasPhysicalEntity" && one.filler == Filler(std::string("mug1"));
    });
    if (about_mug1) of_mug1.push_back(fluent);
  }
  std::vector<Fluent> seen;
  const auto collect = [&](const Fluent& fluent) {
    seen.push_back(fluent);
    return true;
  };
  view.OfConcept("On", collect);
  RC_ASSERT(seen == on);
  seen.clear();
  view.WithFiller("hasPhysicalEntity", std::string("MUG1"), collect);
  RC_ASSERT(seen == of_mug1);
  Restaurant().All([&](const Fluent& fluent) {
    const bool there = all.count(base::ToLower(fluent.instance)) > 0;
    RC_ASSERT((view.Find(fluent.instance) != nullptr) == there);
    return true;
  });
}

TEST_F(ProjectedViewTest, VisitsStopWhenToldAmongAddedOnes) {
  view_.Add({"On", {"aaa", "trayarea1"}});
  view_.Add({"On", {"zzz", "trayarea1"}});
  Texts seen;
  view_.OfConcept("On", [&](const Fluent& fluent) {
    seen.push_back(fluent.instance);
    return seen.size() < 2;
  });
  EXPECT_THAT(seen, ElementsAre("onAaa", "onMug1"));
}

}  // namespace
}  // namespace hires::knowledge::state_view_test
