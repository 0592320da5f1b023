#include "hires/knowledge/sparql.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/knowledge/fluent_yaml.h"
#include "knowledge/support/memory_view.h"
#include "knowledge/support/restaurant_world.h"

namespace hires::knowledge::sparql_test {
namespace {

using test_support::MakeFluent;
using test_support::MemoryView;
using test_support::RestaurantOntology;
using test_support::SmallRestaurant;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Names = std::vector<std::string>;

Sparql Query(const std::string& text) { return Sparql(text, RestaurantOntology()); }

/// What the query selects in the small restaurant.
Names Select(const std::string& text) {
  return Query(text).Instances(MemoryView(SmallRestaurant()));
}

/// What is wrong with the query, or "" if nothing is.
std::string ErrorOf(const std::string& text) {
  try {
    Query(text);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

// The shapes of the original's topics, answers worked by hand ------------------------------------

TEST(SparqlTest, NestedUnionsGiveStatesMugsAndPosturesBelowAConcept) {
  EXPECT_THAT(
      Select("select distinct ?instance where {{{?instance rdf:type upper:On} union "
             "{?instance rdf:type upper:RobotAt} union {?instance rdf:type upper:Holding} "
             "union {?instance rdf:type race:Mug} } union { ?instance rdf:type ?subclass . "
             "{ { ?subclass rdfs:subClassOf+ race:ArmPosture} union {?subclass "
             "rdfs:subClassOf+ race:TorsoPosture} }}}"),
      ElementsAre("mug1", "mug2", "onMug1", "postureLeftArm1", "postureTorso1", "robotAt1"));
}

TEST(SparqlTest, UnionOfThreeTypesTakesTheConceptAsStated) {
  EXPECT_THAT(Select("select distinct ?instance where {{?instance rdf:type upper:On} union "
                     "{?instance rdf:type upper:Holding} union {?instance rdf:type "
                     "race:GripperHoldingPosture}}"),
              ElementsAre("onMug1"));
  EXPECT_THAT(Select("select ?instance where {?instance rdf:type race:ArmPosture}"), IsEmpty());
}

TEST(SparqlTest, SubclassPlusFindsWhatIsProperlyBelow) {
  EXPECT_THAT(Select("select distinct ?instance where { ?instance rdf:type ?subclass . ?subclass "
                     "rdfs:subClassOf+ upper:ElementaryRobotActivity}"),
              ElementsAre("moveBase1", "moveTorso1"));
  EXPECT_THAT(Select("select distinct ?instance where { ?instance rdf:type ?subclass . ?subclass "
                     "rdfs:subClassOf+ race:Mug}"),
              IsEmpty());
}

TEST(SparqlTest, SubclassStarIncludesTheConceptItself) {
  EXPECT_THAT(Select("select distinct ?instance where { ?instance rdf:type ?subclass . ?subclass "
                     "rdfs:subClassOf* race:Mug}"),
              ElementsAre("mug1", "mug2"));
}

TEST(SparqlTest, SubclassPlainIsTheNextConceptAlone) {
  EXPECT_THAT(Select("select ?i where {?i a ?c . ?c rdfs:subClassOf race:Kitchenware}"),
              ElementsAre("mug1", "mug2"));
  EXPECT_THAT(Select("select ?i where {?i a ?c . ?c rdfs:subClassOf race:TabletopObject}"),
              IsEmpty());
}

TEST(SparqlTest, APropertyWithAnyFillerCounts) {
  EXPECT_THAT(
      Select("select distinct ?instance where {?instance upper:hasBoundingBox ?any}"),
      ElementsAre("book1", "floorArea1", "manipulationArea1", "mug1", "placingArea1", "table1"));
}

TEST(SparqlTest, PropertyTypeAndUnionInCapitalsJoin) {
  EXPECT_THAT(Select("select distinct ?instance where {?instance upper:hasBoundingBox ?any . "
                     "?instance a ?subclass . {{?subclass rdfs:subClassOf+ race:Kitchenware} UNION "
                     "{?subclass rdfs:subClassOf+ race:PersonalItem}}}"),
              ElementsAre("book1", "mug1"));
}

TEST(SparqlTest, FurnitureIsFoundWithADotRightBehindTheVariable) {
  EXPECT_THAT(Select("select distinct ?instance where {?instance a ?subclass. ?subclass "
                     "rdfs:subClassOf+ race:Furniture}"),
              ElementsAre("table1"));
}

TEST(SparqlTest, FloorAreasJoinOverBoxAndPoseToAHeightOfZero) {
  // The table's box stands on the floor as well, but a table is no area; 0.75 m is no floor.
  EXPECT_THAT(Select("select distinct ?area where {?area rdf:type ?type . ?type rdfs:subClassOf* "
                     "upper:Area . ?area upper:hasBoundingBox ?bbox . ?bbox upper:hasPose ?pose . "
                     "?pose upper:hasZ \"0.0\"^^xsd:float}"),
              ElementsAre("floorArea1", "manipulationArea1"));
}

TEST(SparqlTest, ConceptsMayComeFirstAndTheVariableMayHaveAnyName) {
  EXPECT_THAT(Select("select ?instructions where {?any rdfs:subClassOf* upper:RobotActivity . "
                     "?instructions rdf:type ?any}"),
              ElementsAre("moveBase1", "moveTorso1"));
}

TEST(SparqlTest, AConstantSubjectIsFollowedToWhatItLinksTo) {
  EXPECT_THAT(
      Select("select distinct ?instance where {race:LEFTARM1 race:hasArmPosture ?instance}"),
      ElementsAre("postureLeftArm1"));
}

TEST(SparqlTest, EveryQueryOfTheOriginalsTopicsReads) {
  const std::string path = std::string(HIRES_SHARED_DATA) + "/bb_topics.yaml";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  int num_queries = 0;
  for (const DemandTopic& topic : LoadKnowledge(path).topics) {
    for (const std::string& text : topic.queries) {
      EXPECT_EQ(ErrorOf(text), "") << topic.name;
      ++num_queries;
    }
  }
  EXPECT_EQ(num_queries, 14);
}

// The language ------------------------------------------------------------------------------------

TEST(SparqlTest, SemicolonsAndCommasAbbreviate) {
  const std::string text =
      "SELECT ?on WHERE { ?on a upper:On ; upper:hasPhysicalEntity ?x ; upper:hasArea ?y ; . "
      "?x a race:Mug , ?c . }  # the end";
  EXPECT_THAT(Select(text), ElementsAre("onMug1"));
}

TEST(SparqlTest, FullIrisAndDeclaredPrefixesStandForTheSameNames) {
  EXPECT_THAT(Select("prefix r: <urn:x-hires:race#> select ?x { ?x "
                     "<http://www.w3.org/1999/02/22-rdf-syntax-ns#type> r:Mug }"),
              ElementsAre("mug1", "mug2"));
  EXPECT_THAT(Select("select ?x { ?x a <http://example.org/other#Mug> }"),
              ElementsAre("mug1", "mug2"));
}

TEST(SparqlTest, NumbersCompareByValue) {
  for (const char* zero : {"0", "0.0", "-0.0", "\"0\"^^xsd:int", "\"0e3\"^^xsd:double", "+0"}) {
    EXPECT_THAT(Select("select ?p {?p upper:hasZ " + std::string(zero) + "}"),
                ElementsAre("poseFloor1", "poseFloor2"))
        << zero;
  }
  EXPECT_THAT(Select("select ?p {?p upper:hasZ .75. }"), ElementsAre("poseTop"));
}

TEST(SparqlTest, IntegersBeyondTheReachOfDoublesAreNotRounded) {
  const MemoryView view({MakeFluent(
      "Prediction", "p1", {{"hasRollouts", "xsd:integer", std::int64_t{9007199254740993}}})});
  EXPECT_TRUE(Query("select ?p {?p upper:hasRollouts 9007199254740993}").Accepts(view, "p1"));
  EXPECT_FALSE(Query("select ?p {?p upper:hasRollouts 9007199254740992.0}").Accepts(view, "p1"));
}

TEST(SparqlTest, TextAndTruthValuesCompare) {
  EXPECT_THAT(Select("select ?a {?a upper:hasResult 'Succeeded'}"), ElementsAre("moveBase1"));
  EXPECT_THAT(Select("select ?a {?a upper:hasResult \"succeeded\"^^xsd:string}"),
              ElementsAre("moveBase1"));
  EXPECT_THAT(Select("select ?a {?a upper:hasResult \"suc\\\"ceeded\"}"), IsEmpty());
}

TEST(SparqlTest, RowsHoldNamesConceptsAndValuesSortedAndOnce) {
  const auto rows =
      Query("select ?c ?z {?p a ?c ; upper:hasZ ?z}").Select(MemoryView(SmallRestaurant()));
  EXPECT_THAT(rows, ElementsAre(Names{"Pose", "0"}, Names{"Pose", "0.75"}));
}

TEST(SparqlTest, AVariableThatAnAlternativeLeavesOpenIsEmpty) {
  const auto rows =
      Query("select ?x ?z {{?x a race:Book} union {?x upper:hasZ ?z; upper:hasZ 0.75}}")
          .Select(MemoryView(SmallRestaurant()));
  EXPECT_THAT(rows, ElementsAre(Names{"book1", ""}, Names{"poseTop", "0.75"}));
}

TEST(SparqlTest, AVariableTwiceInAPatternMeansTheSameInstance) {
  const MemoryView view(
      {MakeFluent("MoveBaseTask", "t1", {{"hasSubtask", "Task", std::string("T1")}}),
       MakeFluent("MoveBaseTask", "t2", {{"hasSubtask", "Task", std::string("t1")}})});
  EXPECT_THAT(Query("select ?t {?t upper:hasSubtask ?t}").Instances(view), ElementsAre("t1"));
}

TEST(SparqlTest, ALinkToWhatDoesNotHoldGoesNowhere) {
  const MemoryView view({test_support::WithBox("Mug", "mug1", "gone")});
  EXPECT_THAT(Query("select ?x {?x upper:hasBoundingBox ?b}").Instances(view), ElementsAre("mug1"));
  EXPECT_THAT(Query("select ?x {?x upper:hasBoundingBox ?b . ?b a ?c}").Instances(view), IsEmpty());
}

TEST(SparqlTest, AcceptsSaysOfEachInstanceWhatInstancesLists) {
  const MemoryView view(SmallRestaurant());
  const Sparql query = Query(
      "select ?area {?area a ?t . ?t rdfs:subClassOf* upper:Area . ?area upper:hasBoundingBox ?b . "
      "?b upper:hasPose ?p . ?p upper:hasZ 0}");
  Names accepted;
  view.All([&](const Fluent& fluent) {
    if (query.Accepts(view, fluent.instance)) accepted.push_back(fluent.instance);
    return true;
  });
  EXPECT_EQ(accepted, query.Instances(view));
  EXPECT_TRUE(query.Accepts(view, "FLOORAREA1"));
  EXPECT_FALSE(query.Accepts(view, "nobody"));
}

TEST(SparqlTest, VariablesAreThoseSelectedInTheirOrder) {
  EXPECT_THAT(Query("select ?y $x {?x upper:hasPose ?y}").variables(), ElementsAre("?y", "?x"));
}

TEST(SparqlTest, JoinedRolesAreThoseThatLeadToOtherInstances) {
  EXPECT_THAT(Query("select ?i {?i upper:hasBoundingBox ?any ; a race:Mug}").joined_roles(),
              IsEmpty());
  EXPECT_THAT(
      Query("select ?a {?a upper:hasBoundingBox ?b . ?b upper:hasPose ?p . ?p upper:hasZ 0}")
          .joined_roles(),
      ElementsAre("hasBoundingBox", "hasPose", "hasZ"));
  EXPECT_THAT(Query("select ?i {?on upper:hasPhysicalEntity ?i}").joined_roles(),
              ElementsAre("hasPhysicalEntity"));
}

// What is refused ---------------------------------------------------------------------------------

struct Bad {
  std::string text, message;
};

TEST(SparqlTest, ErrorsNamePlaceWhatCameAndWhatWasWanted) {
  const std::vector<Bad> bad{
      {"", "query 1:1: came the end of the query, wanted select; understood are prefix, select"},
      {"ask {?x a race:Mug}", "query 1:1: came 'ask', wanted select"},
      {"construct {?x a race:Mug} where {}", "1:1: came 'construct'"},
      {"select {?x a race:Mug}", "1:8: came '{', wanted a variable to select"},
      {"select * {?x a race:Mug}", "1:8: came '*', wanted a variable to select"},
      {"select reduced ?x {?x a race:Mug}", "1:8: came 'reduced'"},
      {"select ?x where\n{ filter(?x) }", "query 2:3: came 'filter', wanted a variable, a name"},
      {"select ?x {?x a race:Mug optional {?x a race:Mug}}", "1:26: came 'optional'"},
      {"select ?x {?x a race:Mug . FILTER(?x > 1)}", "1:28: came 'FILTER'"},
      {"select ?x {?x a race:Mug} order by ?x", "1:27: came 'order', wanted the end of the query"},
      {"select ?x {?x a race:Mug} limit 5", "1:27: came 'limit'"},
      {"select ?x {?x a race:Mug", "1:25: came the end of the query, wanted '.', ';', ',' or '}'"},
      {"select ?x {?x ?p race:Mug}", "1:15: came '?p', wanted a relation by its name"},
      {"select ?x {?x rdf:type/rdfs:subClassOf* race:Mug}", "1:23: came '/', wanted an object"},
      {"select ?x {?x upper:hasPose+ ?y}", "1:28: came '+', wanted an object: of paths"},
      {"select ?x {?x a foo:Mug}", "1:17: came the prefix of 'foo:Mug', which nothing declares"},
      {"select ?x {?x a race:Mugg}", "1:17: concept 'Mugg' is unknown; did you mean 'Mug'"},
      {"select ?x {?x a upper:Mug}", "1:17: came 'upper:Mug', the ontology has race:Mug"},
      {"select ?x {?x race:hasZ 0}", "1:15: came 'race:hasZ', the ontology has upper:hasZ"},
      {"select ?x {?x upper:hasPos ?y}",
       "1:15: relation 'hasPos' is unknown; did you mean 'hasPose'"},
      {"select ?x {?x upper:hasPose \"here\"}",
       "1:29: came the text \"here\", wanted a variable or an "
       "instance: hasPose links to a Pose"},
      {"select ?x {?x upper:hasZ upper:Pose}",
       "1:26: came 'upper:Pose', wanted a variable or a value"},
      {"select ?x {?x upper:hasZ \"high\"}",
       "1:26: came the text \"high\" of another type, wanted a "
       "variable or a value: hasZ is of type xsd:float"},
      {"select ?x {?x upper:hasZ \"high\"^^xsd:float}",
       "1:26: came the text \"high\", wanted a finite"},
      {"select ?x {?x upper:hasZ \"inf\"^^xsd:float}", "wanted a finite number"},
      {"select ?x {?x upper:hasZ \"1.5\"^^xsd:int}", "wanted a whole number of 64 bits"},
      {"select ?x {?x upper:hasZ 1e999}", "wanted a finite number"},
      {"select ?x {?x upper:hasZ 1+2}", "1:26: came '1+2', wanted a whole number"},
      {"select ?x {?x upper:hasZ \"1970-01-01\"^^xsd:dateTime}",
       "1:40: came the type 'xsd:dateTime'"},
      {"select ?x {?x upper:hasResult \"a}", "1:31: came the text \"a}\" without an end"},
      {"select ?x {?x upper:hasResult \"\\q\"}", "came an unknown escape in a text"},
      {"select ?x {?x upper:hasResult \"a\"@en}", "1:34: came '@'"},
      {"select ?x {?x a <race}", "came '<race}>' without an end, wanted '>'"},
      {"select ?x {?x a <urn:a#>}", "wanted an IRI with a name behind its last '#' or '/'"},
      {"select ? {?x a race:Mug}", "1:8: came '?' alone"},
      {"select ?y {?x a race:Mug}", "1:8: selected variable '?y' is unknown; did you mean '?x'"},
      {"select ?x {}", "selected variable '?x' is unknown"},
      {"select ?x {{?x a race:Mug} union {?y a race:Mug}}",
       "1:8: came '?x', which some alternative"},
      {"select ?x {{?x a race:Mug} union ?x}", "1:34: came '?x', wanted '{' with the alternative"},
      {"select ?x {?x a ?c . ?c upper:hasZ 0}",
       "1:22: came '?c' for instances, it stands for concepts"},
      {"prefix race <urn:a#> select ?x {?x a race:Mug}", "1:8: came 'race', wanted a prefix"},
      {"prefix r: race:Mug select ?x {?x a r:Mug}", "1:11: came 'race:Mug', wanted an IRI"},
      {"select ?x {?x a race:Mug} }", "1:27: came '}', wanted the end of the query"},
      {"select ?x {?x a race: }", "concept '' is unknown"},
      {"select ?x {race: upper:hasPose ?x}", "1:12: came 'race:', wanted a name after the prefix"},
  };
  for (const Bad& query : bad) {
    EXPECT_THAT(ErrorOf(query.text), HasSubstr(query.message)) << query.text;
    EXPECT_THAT(ErrorOf(query.text), HasSubstr("query ")) << query.text;
  }
}

std::string Repeat(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(SparqlTest, TooMuchOfAnythingIsRefusedAndAsMuchAsAllowedIsNot) {
  const auto nested = [](int depth) {
    return "select ?x " + Repeat("{", depth) + "?x a race:Mug" + Repeat("}", depth);
  };
  EXPECT_EQ(ErrorOf(nested(100)), "");
  EXPECT_THAT(ErrorOf(nested(101)), HasSubstr("more than 100 nested groups"));
  const auto patterns = [](int number) {
    return "select ?x {" + Repeat("?x a race:Mug .", number) + "}";
  };
  EXPECT_EQ(ErrorOf(patterns(1000)), "");
  EXPECT_THAT(ErrorOf(patterns(1001)), HasSubstr("more than 1000 patterns"));
  EXPECT_THAT(ErrorOf("select ?x {?x a race:Mug}" + std::string(65'536, ' ')),
              HasSubstr("came 65561 bytes, wanted at most 65536"));
  std::string variables = "select ?v0 {";
  for (int i = 0; i < 65; ++i) variables += "?v" + std::to_string(i) + " a race:Mug .";
  EXPECT_THAT(ErrorOf(variables + "}"), HasSubstr("more than 64 variables"));
}

TEST(SparqlTest, AThousandPatternsAreWorkedThrough) {
  EXPECT_THAT(Select("select ?x {" + Repeat("?x a race:Mug .", 1000) + "}"),
              ElementsAre("mug1", "mug2"));
  EXPECT_THAT(Select("select ?x {" + Repeat("{?x a race:Book} union ", 998) + "{?x a race:Mug}}"),
              ElementsAre("book1", "mug1", "mug2"));
}

TEST(SparqlTest, AnAnswerOfTooManyRowsIsAnErrorNotAnEndlessSearch) {
  std::vector<Fluent> mugs;
  for (int i = 0; i < 101; ++i) mugs.push_back(MakeFluent("Mug", "mug" + std::to_string(i)));
  const MemoryView view(mugs);
  const Sparql query = Query("select ?a {?a a race:Mug. ?b a race:Mug. ?c a race:Mug}");
  try {
    query.Instances(view);
    FAIL() << "101^3 rows are more than a million";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("more than 1000000 intermediate rows"));
  }
  EXPECT_EQ(Query("select ?a {?a a race:Mug. ?b a race:Mug}").Instances(view).size(), 101u);
}

}  // namespace
}  // namespace hires::knowledge::sparql_test
