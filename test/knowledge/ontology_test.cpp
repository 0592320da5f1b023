#include "hires/knowledge/ontology.h"

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "support/log_catcher.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::ontology_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::ThrowsMessage;

const std::string kPrefixes =  // four lines
    "@prefix race: <urn:test:race#> .\n"
    "@prefix owl: <http://www.w3.org/2002/07/owl#> .\n"
    "@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n"
    "@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n";

const std::string kKitchen =
    "race:Thingy a owl:Class .\n"
    "race:Kitchenware a owl:Class ; rdfs:subClassOf race:Thingy .\n"
    "race:Fragile a owl:Class ; rdfs:subClassOf race:Thingy .\n"
    "race:Mug a owl:Class ; rdfs:subClassOf race:Kitchenware , race:Fragile .\n"
    "race:Pose a owl:Class .\n"
    "race:hasPose a owl:ObjectProperty , owl:FunctionalProperty ;\n"
    "  rdfs:domain race:Thingy ; rdfs:range race:Pose .\n"
    "race:hasX a owl:DatatypeProperty ; rdfs:domain race:Pose ; rdfs:range xsd:float .\n";

Ontology Read(const std::string& body) { return Ontology::FromText(kPrefixes + body, "t.ttl"); }

std::vector<std::string> NamesOf(const Ontology& ontology,
                                 const std::vector<Ontology::ConceptId>& ids) {
  std::vector<std::string> names;
  for (const Ontology::ConceptId id : ids) names.push_back(ontology.Name(id));
  return names;
}

bool IsA(const Ontology& ontology, const std::string& below, const std::string& above) {
  return ontology.IsA(ontology.Require(below), ontology.Require(above));
}

/// The ontology that the package comes with.
const Ontology& Shipped() {
  static const Ontology ontology =
      Ontology::FromFiles({HIRES_SOURCE_DIR "/config/ontology/upper.ttl",
                           HIRES_SOURCE_DIR "/config/ontology/race.ttl"});
  return ontology;
}

TEST(OntologyTest, ConceptsAreNumberedInTheOrderOfTheirNames) {
  const Ontology ontology = Read(kKitchen);
  EXPECT_THAT(ontology.ConceptNames(),
              ElementsAre("Fragile", "Kitchenware", "Mug", "Pose", "Thing", "Thingy"));
  ASSERT_EQ(ontology.num_concepts(), 6u);
  for (Ontology::ConceptId id = 0; id < 6; ++id) {
    EXPECT_EQ(ontology.Name(id), ontology.ConceptNames()[id]);
    EXPECT_EQ(ontology.Find(ontology.Name(id)), id);
  }
}

TEST(OntologyTest, ClosuresAreReflexiveAndTransitiveAndGoThroughBothParents) {
  const Ontology ontology = Read(kKitchen);
  EXPECT_THAT(NamesOf(ontology, ontology.Above(ontology.Require("Mug"))),
              ElementsAre("Fragile", "Kitchenware", "Mug", "Thing", "Thingy"));
  EXPECT_THAT(NamesOf(ontology, ontology.Below(ontology.Require("Thingy"))),
              ElementsAre("Fragile", "Kitchenware", "Mug", "Thingy"));
  EXPECT_TRUE(IsA(ontology, "Mug", "Thingy"));
  EXPECT_TRUE(IsA(ontology, "Mug", "Mug"));
  EXPECT_FALSE(IsA(ontology, "Thingy", "Mug"));
  EXPECT_FALSE(IsA(ontology, "Fragile", "Kitchenware"));
}

TEST(OntologyTest, EverythingIsAThing) {
  const Ontology ontology = Read(kKitchen);
  EXPECT_EQ(ontology.Below(ontology.Require("Thing")).size(), ontology.num_concepts());
  EXPECT_EQ(ontology.Qualified("Thing"), "owl:Thing");
  EXPECT_TRUE(IsA(Read("race:A a owl:Class ; rdfs:subClassOf owl:Thing ."), "A", "Thing"));
}

TEST(OntologyTest, RelationsHaveDomainRangeAndCount) {
  const Ontology ontology = Read(kKitchen);
  EXPECT_THAT(ontology.RelationNames(), ElementsAre("hasPose", "hasX"));
  const Ontology::Relation& has_pose = *ontology.FindRelation("hasPose");
  EXPECT_EQ(has_pose.name, "hasPose");
  EXPECT_THAT(has_pose.domain, ElementsAre(ontology.Require("Thingy")));
  EXPECT_EQ(has_pose.range, "Pose");
  EXPECT_TRUE(has_pose.functional);
  EXPECT_EQ(ontology.FindRelation("hasX")->range, "xsd:float");
  EXPECT_FALSE(ontology.FindRelation("hasX")->functional);
  EXPECT_EQ(ontology.FindRelation("hasY"), nullptr);
}

TEST(OntologyTest, ADomainMayBeAUnionOrMissing) {
  const Ontology ontology = Read(
      kKitchen +
      "race:hasArea a owl:ObjectProperty ; rdfs:range owl:Thing ;\n"
      "  rdfs:domain [ a owl:Class ; owl:unionOf ( race:Pose race:Mug race:Pose ) ] .\n"
      "race:hasNote a owl:DatatypeProperty ; rdfs:range xsd:string .\n"
      "race:hasAny a owl:DatatypeProperty ; rdfs:range xsd:string ; rdfs:domain owl:Thing .\n");
  EXPECT_THAT(ontology.FindRelation("hasArea")->domain,
              ElementsAre(ontology.Require("Mug"), ontology.Require("Pose")));
  EXPECT_EQ(ontology.FindRelation("hasArea")->range, "Thing");
  EXPECT_THAT(ontology.FindRelation("hasNote")->domain, IsEmpty());
  EXPECT_THAT(ontology.FindRelation("hasAny")->domain, IsEmpty());
}

TEST(OntologyTest, QualifiedNamesCarryThePrefixOfTheirFile) {
  const Ontology ontology = Read("@prefix : <urn:test:race#> .\n" + kKitchen);
  EXPECT_EQ(ontology.Qualified("Mug"), "race:Mug") << "the empty prefix says less";
  EXPECT_EQ(ontology.Qualified("hasPose"), "race:hasPose");
  EXPECT_THAT([&] { ontology.Qualified("hasPoes"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("did you mean 'hasPose'")));
}

TEST(OntologyTest, AnUnknownConceptIsAnErrorWithTheNearestNames) {
  const Ontology ontology = Read(kKitchen);
  EXPECT_EQ(ontology.Find("mug"), Ontology::kUnknown) << "names compare exactly";
  EXPECT_THAT(
      [&] { ontology.Require("mug"); },
      ThrowsMessage<base::ConfigError>(HasSubstr("concept 'mug' is unknown; did you mean 'Mug'")));
}

TEST(OntologyTest, AHugeUnknownNameGivesAShortMessage) {
  const Ontology ontology = Read(kKitchen);
  const std::string huge(10'000'000, 'x');
  try {
    ontology.Require(huge);
    FAIL() << "a name of ten million letters was found";
  } catch (const base::ConfigError& error) {
    EXPECT_LT(std::string(error.what()).size(), 300u);
  }
}

TEST(OntologyTest, NumbersThatWereNeverGivenAreRefused) {
  const Ontology ontology = Read(kKitchen);
  EXPECT_THROW(ontology.Name(6), std::logic_error);
  EXPECT_THROW(ontology.IsA(0, Ontology::kUnknown), std::logic_error);
  EXPECT_THROW(ontology.Below(Ontology::kUnknown), std::logic_error);
}

TEST(OntologyTest, FilesBuildOnEachOtherInAnyOrder) {
  const test_support::TemporaryFolder folder;
  const std::string upper = folder.Write("upper.ttl", kPrefixes + kKitchen);
  const std::string lower = folder.Write(
      "lower.ttl",
      "@prefix my: <urn:test:mine#> .\n" + kPrefixes +
          "my:Espresso a owl:Class ; rdfs:subClassOf race:Mug .\nrace:Mug a owl:Class .\n");
  const Ontology one = Ontology::FromFiles({upper, lower});
  const Ontology other = Ontology::FromFiles({lower, upper});
  EXPECT_TRUE(IsA(one, "Espresso", "Fragile"));
  EXPECT_EQ(one.Qualified("Espresso"), "my:Espresso");
  EXPECT_EQ(one.hash(), other.hash());
  EXPECT_NE(one.hash(), Read(kKitchen).hash());
}

TEST(OntologyTest, TheHashTellsWhatMatters) {
  const auto hash = Read(kKitchen).hash();
  EXPECT_EQ(Read(kKitchen + "race:Mug rdfs:label \"mug\"@en .\n").hash(), hash);
  EXPECT_NE(Read(kKitchen + "race:Pose rdfs:subClassOf race:Thingy .\n").hash(), hash);
  EXPECT_NE(Read(kKitchen + "race:hasX a owl:FunctionalProperty .\n").hash(), hash);
}

TEST(OntologyTest, HeadersAndRemarksArePassedOver) {
  const Ontology ontology = Read(
      "<urn:test:race> a owl:Ontology ; owl:imports <urn:test:upper> ; owl:versionInfo \"1\" .\n"
      "race:Mug a owl:Class ; rdfs:label \"mug\"@en , \"Tasse\"@de ; rdfs:comment \"\"\"of\n"
      "coffee [[[((( or tea\"\"\" ; rdfs:seeAlso <http://example.org/mug> .\n");
  EXPECT_THAT(ontology.ConceptNames(), ElementsAre("Mug", "Thing"));
}

struct BeyondTheSubset {
  std::string body;  // behind the four lines of kPrefixes and the eight of kKitchen
  std::string kind;
  int line;
};

TEST(OntologyTest, WhatIsBeyondTheSubsetIsPassedOverWithOneWarning) {
  const std::vector<BeyondTheSubset> cases{
      {"race:Mug rdfs:subClassOf [ a owl:Restriction ; owl:onProperty race:hasPose ] .\n",
       "owl:Restriction (1)", 13},
      {"race:Cup a owl:Class ; owl:equivalentClass race:Mug .\n", "owl:equivalentClass (1)", 13},
      {"race:Mug owl:disjointWith race:Pose .\nrace:Pose owl:disjointWith race:Mug .\n",
       "owl:disjointWith (2)", 13},
      {"[] a owl:AllDisjointClasses ; owl:members ( race:Mug race:Pose ) .\n",
       "owl:AllDisjointClasses (1)", 13},
      {"race:hasPose a owl:TransitiveProperty ; rdfs:subPropertyOf race:hasPose .\n",
       "owl:TransitiveProperty (1), rdfs:subPropertyOf (1)", 13},
      {"\nrace:mug1 a race:Mug , owl:NamedIndividual ; race:hasPose race:p1 .\n"
       "race:p1 a race:Pose .\n",
       "individuals (1), owl:NamedIndividual (1), statements about individuals (1)", 14},
      {"race:Mug <urn:skos#note> race:Pose .\n", "statements by what is no word of OWL (1)", 13},
      {"[] race:likes owl:Thing .\n", "nodes without a name (1)", 13},
      {"<urn:test:race#a%20b> a owl:Class ; rdfs:subClassOf race:Mug .\n", "is no name", 13},
      {"race:Mug rdfs:subClassOf <urn:dul#Artifact> .\n<urn:dul#A> rdfs:subClassOf race:Mug .\n",
       "statements about what no file declares (1), superclasses that no file declares (1: "
       "Artifact)",
       13},
      {"race:at a owl:DatatypeProperty ; rdfs:range xsd:dateTime .\n",
       "relations to values of xsd:dateTime (1)", 13},
      {"race:at a owl:DatatypeProperty .\n", "relations to values without rdfs:range (1)", 13},
      {"race:at a owl:FunctionalProperty .\n", "owl:FunctionalProperty alone (1)", 13},
      {"race:at a <http://www.w3.org/1999/02/22-rdf-syntax-ns#Property> ; rdfs:domain race:Mug .\n",
       "rdf:Property (1), statements about what is passed over (1)", 13}};
  const std::vector<std::string> names = Read(kKitchen).ConceptNames();
  for (const BeyondTheSubset& beyond : cases) {
    SCOPED_TRACE(beyond.body);
    const test_support::LogCatcher log;
    EXPECT_THAT(Read(kKitchen + beyond.body).ConceptNames(), IsSupersetOf(names));
    EXPECT_THAT(log.lines, ElementsAre(AllOf(HasSubstr("t.ttl"), HasSubstr(beyond.kind),
                                             HasSubstr("line " + std::to_string(beyond.line)))));
  }
}

TEST(OntologyTest, RelationsThatSayLessThanIsReadTakeAnything) {
  const test_support::LogCatcher log;
  const Ontology ontology =
      Read(kKitchen +
           "race:near a owl:ObjectProperty .\n"
           "race:touches a owl:SymmetricProperty ; rdfs:range <urn:dul#Object> ;\n"
           "  rdfs:domain [ a owl:Class ; owl:intersectionOf ( race:Mug race:Pose ) ] .\n"
           "race:beside a owl:ObjectProperty ; rdfs:domain <urn:dul#Object> ;\n"
           "  rdfs:range [ a owl:Class ; owl:unionOf ( race:Mug race:Pose ) ] .\n"
           "race:within a owl:FunctionalProperty ; rdfs:range race:Pose .\n");
  for (const char* name : {"near", "touches", "beside"}) {
    ASSERT_NE(ontology.FindRelation(name), nullptr) << name;
    EXPECT_EQ(ontology.FindRelation(name)->range, "Thing") << name;
    EXPECT_THAT(ontology.FindRelation(name)->domain, IsEmpty()) << name;
  }
  EXPECT_EQ(ontology.FindRelation("within")->range, "Pose");
  EXPECT_TRUE(ontology.FindRelation("within")->functional);
  EXPECT_THAT(log.lines, ElementsAre(AllOf(HasSubstr("any is taken"),
                                           HasSubstr("owl:SymmetricProperty (1)"))));
}

TEST(OntologyTest, WhatHasNoPrefixGetsOneInWhateverOrderTheFilesCome) {
  const test_support::TemporaryFolder folder;
  const auto file = [&](const std::string& name, const std::string& body) {
    return folder.Write(name, kPrefixes + "@prefix : <urn:test:" + name + "#> .\n" + body);
  };
  const std::vector<std::string> files{
      file("a", ":Cup a owl:Class .\n"),
      file("b", ":Jug a owl:Class .\n<urn:0#Pot> a owl:Class .\nrace:Mug a owl:Class .\n")};
  const test_support::LogCatcher log;
  const Ontology one = Ontology::FromFiles({files[0], files[1]});
  EXPECT_EQ(one.Qualified("Pot"), "ns1:Pot");
  EXPECT_EQ(one.Qualified("Cup"), "ns2:Cup");
  EXPECT_EQ(one.Qualified("Jug"), "ns3:Jug");
  EXPECT_EQ(one.Qualified("Mug"), "race:Mug");
  EXPECT_EQ(Ontology::FromFiles({files[1], files[0]}).hash(), one.hash());
  EXPECT_THAT(log.lines[0], HasSubstr("ns1: for <urn:0#>, ns2: for <urn:test:a#>"));
}

TEST(OntologyTest, NamesOfAFileThatIsImportedAndNotGivenArePassedOver) {
  const std::string body =
      "<urn:test:mine> a owl:Ontology ; owl:imports <urn:test:race> .\n"
      "race:Cup a owl:Class ; rdfs:subClassOf race:Mug .\n";
  const test_support::LogCatcher log;
  EXPECT_THAT(Read(body).ConceptNames(), ElementsAre("Cup", "Thing"));
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("superclasses that no file declares (1: Mug)")));
  EXPECT_THAT([&] { Read("<urn:test:race> a owl:Ontology .\n" + body); },
              ThrowsMessage<base::ConfigError>(HasSubstr("concept 'Mug' is unknown")));
}

TEST(OntologyTest, AClassBelowItselfAsReasonersWriteItIsOne) {
  EXPECT_THAT(Read("race:A a owl:Class ; rdfs:subClassOf race:A .\n").ConceptNames(),
              ElementsAre("A", "Thing"));
}

TEST(OntologyTest, AllFaultsOfAKindOfStatementComeAtOnce) {
  const auto read = [] {
    Read(
        "race:A a owl:Class ; rdfs:subClassOf race:B .\n"
        "race:r a owl:ObjectProperty ; rdfs:range race:C ; rdfs:domain race:A , race:A .\n");
  };
  EXPECT_THAT(read, ThrowsMessage<base::ConfigError>(
                        AllOf(HasSubstr("concept 'B' is unknown"), HasSubstr("line 5"),
                              HasSubstr("\nt.ttl: concept 'C' is unknown"),
                              HasSubstr("\nt.ttl: relation race:r has two domains"))));
}

TEST(OntologyTest, AnnotationsThatTheFileDeclaresArePassedOver) {
  const test_support::LogCatcher log;
  Read(kKitchen + "race:author a owl:AnnotationProperty ; rdfs:range xsd:string .\n" +
       "race:Mug race:author \"me\" .\n");
  EXPECT_THAT(log.lines, IsEmpty());
}

TEST(OntologyTest, NothingAtAllIsAnOntologyOfThings) {
  EXPECT_THAT(Ontology::FromText("", "t.ttl").ConceptNames(), ElementsAre("Thing"));
  EXPECT_THAT([] { Ontology::FromFiles({}); },
              ThrowsMessage<base::ConfigError>(HasSubstr("no ontology is given")));
  EXPECT_THAT([] { Ontology::FromFiles({"/nonexistent/a.ttl"}); },
              ThrowsMessage<base::ConfigError>(HasSubstr("/nonexistent/a.ttl")));
}

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

struct Malformed {
  std::string name;
  std::string body;                // behind the four lines of kPrefixes
  std::vector<std::string> parts;  // that the message must have
};

class MalformedOntologyTest : public ::testing::TestWithParam<Malformed> {};

TEST_P(MalformedOntologyTest, GivesAnErrorWithFileAndLine) {
  for (const std::string& part : GetParam().parts) {
    EXPECT_THAT([&] { Read(GetParam().body); },
                ThrowsMessage<base::ConfigError>(AllOf(HasSubstr("t.ttl"), HasSubstr(part))));
  }
}

const std::vector<Malformed> kMalformed{
    {"NoTurtle", "this is prose\n", {"this is no Turtle", "line 5"}},
    {"NoFullStop", "race:A a owl:Class\nrace:B a owl:Class .\n", {"this is no Turtle", "line 6"}},
    {"EndInTheMiddle", "race:A a owl:Class ;", {"this is no Turtle", "line 5"}},
    {"UnknownPrefix",
     "\nupper:A a owl:Class .\n",
     {"prefix 'upper:' is not declared; add @prefix upper: <...> .", "line 6"}},
    {"OpenString", "race:A rdfs:label \"mug .\n", {"this is no Turtle"}},
    {"LineAfterALongString",
     "race:A a owl:Class ; rdfs:comment \"\"\"a\nb\\\"\"\"\nc\"\"\" .\nrace:A a race:B .\n",
     {"concept 'B' is unknown", "line 8"}},
    {"OtherMeaningOfAPrefix",
     "@prefix race: <urn:other#> .\n",
     {"prefix 'race:' is <urn:other#>", "<urn:test:race#> before", "line 5"}},
    {"NulByte", std::string("race:A a owl:Class \0 .\n", 22), {"NUL", "line 5"}},
    {"DeepBrackets",
     "race:A rdfs:label " + std::string(100'000, '['),
     {"nested more than 100 deep", "line 5"}},
    {"LongIri", "<urn:" + std::string(200, 'a') + "> a owl:Class .\n", {"an IRI is 205", "line 5"}},
    {"LongText",
     "race:A rdfs:label \"" + std::string(65536, 'a') + "\" .\n",
     {"a text is 65537 bytes long, at most 65536", "line 5"}},
    {"ManyBases", Repeated("@base <a/> .\n", 11), {"more than 10 bases", "line 15"}},
    {"DeepLists", "race:A rdfs:label " + std::string(101, '('), {"nested more than 100 deep"}},
    {"Cycle",
     "race:A a owl:Class ; rdfs:subClassOf race:B .\n"
     "race:B a owl:Class ; rdfs:subClassOf race:C .\n"
     "race:C a owl:Class ; rdfs:subClassOf race:B .\n",
     {"a concept is below itself: B -> C -> B", "line 7"}},
    {"ThingBelow",
     "race:A a owl:Class .\nowl:Thing rdfs:subClassOf race:A .\n",
     {"owl:Thing stands above every concept", "line 6"}},
    {"UnknownSuperclass",
     "race:Mug a owl:Class .\nrace:Cup a owl:Class ; rdfs:subClassOf race:Mugg .\n",
     {"concept 'Mugg' is unknown; did you mean 'Mug'", "owl:Class", "line 6"}},
    {"UndeclaredSubclass",
     "race:Mug a owl:Class .\nrace:Cup rdfs:subClassOf race:Mug .\n",
     {"concept 'Cup' is unknown", "owl:Class", "line 6"}},
    {"SameNameTwice",
     "race:Mug a owl:Class .\n@prefix upper: <urn:test:upper#> .\nupper:Mug a owl:Class .\n",
     {"upper:Mug and race:Mug (t.ttl, line 5) share a name", "line 7"}},
    {"ConceptAndRelation",
     "race:on a owl:Class .\n@prefix u: <urn:u#> .\nu:on a owl:ObjectProperty .\n",
     {"u:on and race:on (t.ttl, line 5) share a name", "line 7"}},
    {"OwnThing", "race:Thing a owl:Class .\n", {"race:Thing and owl:Thing (of OWL itself)"}},
    {"OfUnknownType",
     "race:A a owl:Class .\nrace:a1 a race:B .\n",
     {"concept 'B' is unknown; did you mean one of 'A', 'Thing'", "owl:Class", "line 6"}},
    {"TwoRanges",
     "race:r a owl:DatatypeProperty ; rdfs:range xsd:float , xsd:int .\n",
     {"race:r has two ranges", "line 5"}},
    {"TwoDomains",
     "race:A a owl:Class .\nrace:r a owl:DatatypeProperty ; rdfs:domain race:A , race:A .\n",
     {"race:r has two domains", "owl:unionOf", "line 6"}},
    {"UnknownRange",
     "race:Pose a owl:Class .\nrace:r a owl:ObjectProperty ; rdfs:range race:Posse .\n",
     {"concept 'Posse' is unknown; did you mean 'Pose'", "line 6"}},
    {"UnknownDomain",
     "race:r a owl:ObjectProperty ; rdfs:domain race:Posse ; rdfs:range owl:Thing .\n",
     {"concept 'Posse' is unknown", "line 5"}},
    {"DomainOfText",
     "race:r a owl:ObjectProperty ; rdfs:domain \"Pose\" ; rdfs:range owl:Thing .\n",
     {"'Pose'", "beyond what is read of OWL", "line 5"}},
    {"LinkToValues",
     "race:r a owl:ObjectProperty ; rdfs:range xsd:float .\n",
     {"race:r is an owl:ObjectProperty", "xsd:float", "wanted a concept", "line 5"}},
    {"ValuesOfConcept",
     "race:A a owl:Class .\nrace:r a owl:DatatypeProperty ; rdfs:range race:A .\n",
     {"race:r is an owl:DatatypeProperty", "xsd:float", "line 6"}},
    {"LinkAndValue",
     "race:r a owl:ObjectProperty , owl:DatatypeProperty ; rdfs:range owl:Thing .\n",
     {"race:r is an owl:ObjectProperty and an owl:DatatypeProperty", "line 5"}},
    {"SlipInAClass",
     "race:A a owl:Clas .\nrace:B a owl:Class ; rdfs:subClassOf race:A .\n",
     {"'owl:Clas' is no word of OWL; did you mean 'owl:Class", "line 5"}},
    {"SlipInAPredicate",
     "race:A a owl:Class .\nrace:B a owl:Class ; rdfs:subclasOf race:A .\n",
     {"'rdfs:subclasOf' is no word of OWL; did you mean 'rdfs:subClassOf'", "line 6"}},
    {"OwnPredicate",
     "race:A a owl:Class .\nrace:B a owl:Class ; race:subClassOf race:A .\n",
     {"relation 'subClassOf' is unknown", "line 6"}},
    {"TwoDomainsOneUnknown",
     "race:A a owl:Class .\nrace:r a owl:ObjectProperty ; rdfs:domain <urn:z#Q> , race:A .\n",
     {"race:r has two domains", "line 6"}},
    {"RangeOfNobody",
     "race:A a owl:Class .\nrace:r rdfs:range xsd:float .\n",
     {"relation 'r' is unknown", "owl:ObjectProperty", "line 6"}},
    {"EmptyUnion",
     "race:r a owl:ObjectProperty ; rdfs:range owl:Thing ;\n"
     "  rdfs:domain [ a owl:Class ; owl:unionOf ( ) ] .\n",
     {"owl:unionOf has no list of concepts", "line 6"}},
    {"UnionInCircles",
     "race:r a owl:ObjectProperty ; rdfs:range owl:Thing ; rdfs:domain _:u .\n"
     "_:u a owl:Class ; owl:unionOf _:l .\n"
     "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .\n"
     "_:l rdf:first owl:Thing ; rdf:rest _:l .\n",
     {"owl:unionOf has no list of concepts", "line 5"}},
    {"UnionOfUnknown",
     "race:A a owl:Class .\nrace:r a owl:ObjectProperty ; rdfs:range owl:Thing ;\n"
     "  rdfs:domain [ a owl:Class ; owl:unionOf ( race:A race:B ) ] .\n",
     {"concept 'B' is unknown", "line 7"}},
};

INSTANTIATE_TEST_SUITE_P(All, MalformedOntologyTest, ::testing::ValuesIn(kMalformed),
                         [](const auto& info) { return info.param.name; });

TEST(OntologyLimitsTest, SizesAreBounded) {
  EXPECT_THAT([] { Ontology::FromText(std::string((4u << 20) + 1, ' '), "big.ttl"); },
              ThrowsMessage<base::ConfigError>(AllOf(HasSubstr("big.ttl"), HasSubstr("4194304"))));
  std::string many = kPrefixes;
  for (int i = 0; i < 5001; ++i) many += "race:C" + std::to_string(i) + " a owl:Class .\n";
  EXPECT_THAT([&] { Ontology::FromText(many, "many.ttl"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("more than 5000 concepts")));
  const std::string ten = "race:C rdfs:label '',''" + Repeated(",''", 8) + ".\n";
  const std::string statements = kPrefixes + Repeated(ten, 20'001);
  EXPECT_THAT([&] { Ontology::FromText(statements, "long.ttl"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("more than 200000 statements")));
}

TEST(OntologyLimitsTest, ALongChainIsNoProblem) {
  std::string chain = kPrefixes + "race:C0 a owl:Class .\n";
  for (int i = 1; i < 2000; ++i) {
    chain += "race:C" + std::to_string(i) + " a owl:Class ; rdfs:subClassOf race:C" +
             std::to_string(i - 1) + " .\n";
  }
  const Ontology ontology = Ontology::FromText(chain, "chain.ttl");
  EXPECT_TRUE(IsA(ontology, "C1999", "C0"));
  EXPECT_EQ(ontology.Above(ontology.Require("C1999")).size(), 2001u);  // with Thing
}

/// The slow, obvious way: walk up from `below`.
bool Reaches(const std::vector<std::vector<int>>& parents, int below, int above) {
  if (below == above) return true;
  return std::any_of(parents[below].begin(), parents[below].end(),
                     [&](int parent) { return Reaches(parents, parent, above); });
}

TEST(OntologyPropertyTest, IsAAgreesWithWalkingUpOnRandomHierarchies) {
  const base::Rng rng(41);
  for (int round = 0; round < 30; ++round) {
    base::Rng chance = rng.Fork(round);
    const int size = 2 + chance.Index(70);  // rows of one and of two words
    std::vector<std::vector<int>> parents(size);
    std::string text = kPrefixes;
    for (int i = size - 1; i >= 0; --i) {  // superclasses come later in the file
      text += "race:C" + std::to_string(i) + " a owl:Class .\n";
      for (int p = 0; i > 0 && p < chance.Index(4); ++p) {
        parents[i].push_back(chance.Index(i));
        text += "race:C" + std::to_string(i) + " rdfs:subClassOf race:C" +
                std::to_string(parents[i].back()) + " .\n";
      }
    }
    const Ontology ontology = Ontology::FromText(text, "random.ttl");
    for (int below = 0; below < size; ++below) {
      for (int above = 0; above < size; ++above) {
        const auto b = ontology.Require("C" + std::to_string(below));
        const auto a = ontology.Require("C" + std::to_string(above));
        const bool is_a = Reaches(parents, below, above);
        ASSERT_EQ(ontology.IsA(b, a), is_a) << "round " << round << ": " << below << ", " << above;
        const auto& over = ontology.Above(b);
        const auto& under = ontology.Below(a);
        ASSERT_EQ(std::binary_search(over.begin(), over.end(), a), is_a);
        ASSERT_EQ(std::binary_search(under.begin(), under.end(), b), is_a);
      }
    }
  }
}

/// Of 400 texts in which up to four letters are others, how many are refused; each refusal names
/// the file. @param letters  twenty
int CountRefusals(const std::string& text, const std::string& source, const char* letters,
                  const base::Rng& rng) {
  int errors = 0;
  for (int round = 0; round < 400; ++round) {
    base::Rng chance = rng.Fork(round);
    std::string damaged = text;
    for (int i = 0; i < 1 + chance.Index(4); ++i) {
      damaged[chance.Index(static_cast<int>(damaged.size()))] = letters[chance.Index(20)];
    }
    try {
      Ontology::FromText(damaged, source);
    } catch (const base::ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(source));
      ++errors;
    }
  }
  return errors;
}

TEST(OntologyPropertyTest, DamagedFilesGiveAnOntologyOrAnError) {
  const char* letters = "<>[]()\"'.;,:#@\\ \nA\xff\xc3";
  EXPECT_GT(CountRefusals(kPrefixes + kKitchen, "damaged.ttl", letters, base::Rng(43)), 100);
}

// RDF/XML -----------------------------------------------------------------------------------------

const std::string kXmlHead =
    "<?xml version=\"1.0\"?>\n<!DOCTYPE rdf:RDF [\n"
    "  <!ENTITY owl \"http://www.w3.org/2002/07/owl#\" >\n"
    "  <!ENTITY race \"urn:test:race#\" >\n]>\n"
    "<rdf:RDF xmlns=\"urn:test:race#\" xmlns:race=\"urn:test:race#\" xml:base=\"urn:test:race\"\n"
    "  xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"\n"
    "  xmlns:rdfs=\"http://www.w3.org/2000/01/rdf-schema#\" xmlns:owl=\"&owl;\">\n";

const std::string kKitchenInXml =
    kXmlHead +
    "<owl:Ontology rdf:about=\"urn:test:race\"/>\n"
    "<!-- what stands in kKitchen, in the ways that editors have -->\n"
    "<owl:Class rdf:about=\"&race;Thingy\"/>\n"
    "<owl:Class rdf:ID=\"Kitchenware\"><rdfs:subClassOf rdf:resource=\"#Thingy\"/></owl:Class>\n"
    "<owl:Class rdf:about=\"#Fragile\"><rdfs:subClassOf "
    "rdf:resource=\"&race;Thingy\"/></owl:Class>\n"
    "<owl:Class rdf:about=\"#Mug\">\n"
    "  <rdfs:subClassOf rdf:resource=\"#Kitchenware\"/><rdfs:subClassOf "
    "rdf:resource=\"#Fragile\"/>\n"
    "  <rdfs:label xml:lang=\"de\">Tasse &gt; Becher</rdfs:label>\n</owl:Class>\n"
    "<rdf:Description rdf:about=\"#Pose\"><rdf:type "
    "rdf:resource=\"&owl;Class\"/></rdf:Description>\n"
    "<owl:ObjectProperty rdf:about=\"#hasPose\">\n"
    "  <rdf:type rdf:resource=\"&owl;FunctionalProperty\"/>\n"
    "  <rdfs:domain rdf:resource=\"#Thingy\"/><rdfs:range rdf:resource=\"#Pose\"/>\n"
    "</owl:ObjectProperty>\n"
    "<owl:DatatypeProperty rdf:about=\"#hasX\"><rdfs:domain rdf:resource=\"#Pose\"/>\n"
    "  <rdfs:range rdf:resource=\"http://www.w3.org/2001/XMLSchema#float\"/>\n"
    "</owl:DatatypeProperty>\n</rdf:RDF>\n";

TEST(RdfXmlTest, SaysWhatTheSameTurtleSays) {
  const auto hash = Read(kKitchen).hash();
  EXPECT_EQ(Ontology::FromText(kKitchenInXml, "t.owl").hash(), hash);
  const test_support::TemporaryFolder folder;
  const std::string marked = folder.Write("t.owl", "\xEF\xBB\xBF" + kKitchenInXml);
  EXPECT_EQ(Ontology::FromFiles({marked}).hash(), hash);
  EXPECT_EQ(Ontology::FromText("\n\n" + kKitchenInXml, "t.owl").hash(), hash);
}

TEST(RdfXmlTest, FaultsHaveTheirLines) {
  const auto error_of = [](const std::string& text) {
    try {
      Ontology::FromText(text, "t.owl");
    } catch (const base::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string below = "<owl:Class rdf:about=\"#A\"><rdfs:subClassOf rdf:resource=\"#B\"/>\n";
  for (const std::string before : {"", "\n\n"}) {
    const std::string line = "line " + std::to_string(9 + before.size());
    EXPECT_THAT(error_of(before + kXmlHead + below + "</owl:Class></rdf:RDF>"),
                AllOf(HasSubstr("concept 'B' is unknown"), HasSubstr(line)));
    EXPECT_THAT(error_of(before + kXmlHead + below + "</owl:Clas></rdf:RDF>"),
                AllOf(HasSubstr("t.owl: this is no RDF/XML"), HasSubstr("line 1")));
  }
  EXPECT_THAT(error_of(kXmlHead + "<foaf:Person/></rdf:RDF>"),
              AllOf(HasSubstr("prefix 'foaf:' is not declared; add xmlns:foaf=\"...\""),
                    HasSubstr("line 9")));
}

TEST(RdfXmlTest, OtherNotationsOfOwlAreNamedWithWhatConvertsThem) {
  for (const auto& [text, name] : std::vector<std::pair<std::string, std::string>>{
           {"Prefix(:=<urn:a#>)\nOntology(<urn:a>)\n", "OWL in functional syntax"},
           {"Prefix: : <urn:a#>\nOntology: <urn:a>\n", "OWL in Manchester syntax"},
           {"{\"@context\": {}}", "JSON"},
           {"<?xml version=\"1.0\"?>\n<Ontology xmlns=\"http://www.w3.org/2002/07/owl#\"/>",
            "OWL/XML"},
           {"<!DOCTYPE html>\n<html></html>", "XML whose root is <html>"}}) {
    const auto read = [written = text] { Ontology::FromText(written, "o.owl"); };
    EXPECT_THAT(read, ThrowsMessage<base::ConfigError>(AllOf(
                          HasSubstr("o.owl: is " + name + ", wanted Turtle or RDF/XML; convert it"),
                          HasSubstr("robot convert"))));
  }
}

TEST(RdfXmlTest, DocumentTypesAreAsEditorsWriteThem) {
  for (const std::string within :
       {"<!-- [see 1] > -->", "<!ENTITY x \"a]>b\">", "<!ENTITY y 'it &#39;s'>", "<?pi [ ?>"}) {
    std::string text = kKitchenInXml;
    text.insert(text.find("[\n") + 2, within);
    EXPECT_EQ(Ontology::FromText(text, "t.owl").hash(), Read(kKitchen).hash()) << within;
  }
}

TEST(RdfXmlTest, WhatRaptorWouldTakeWithoutEndIsRefused) {
  const auto refused = [](const std::string& text, const std::string& what) {
    EXPECT_THAT([&] { Ontology::FromText(text, "t.owl"); },
                ThrowsMessage<base::ConfigError>(AllOf(HasSubstr("t.owl"), HasSubstr(what))));
  };
  const std::string ends = "<!DOCTYPE rdf:RDF [<!ENTITY a \"]" + Repeated("</x>", 200) + "\">]>";
  const std::string root = kXmlHead.substr(kXmlHead.find("<rdf:RDF"));
  refused(ends + root + Repeated("<a>", 200), "nested more than 100 deep");
  std::string attributes;
  for (int i = 0; i < 600; ++i) attributes += " a" + std::to_string(i) + "=\"1\"";
  refused(kXmlHead + "<a" + attributes + "/></rdf:RDF>", "more than 500 attributes");
  const std::string entity =
      "<!DOCTYPE rdf:RDF [<!ENTITY a \"" + std::string(100'000, 'a') + "\">]>";
  refused(entity + root + "<rdfs:label>" + Repeated("&a;", 5000) + "</rdfs:label></rdf:RDF>",
          "what its entities stand for");
  refused(std::string("\xFF\xFE<\0r\0d\0f\0", 10), "UTF-16");
}

TEST(RdfXmlTest, DepthAndEntitiesAreBounded) {
  EXPECT_THAT([] { Ontology::FromText(kXmlHead + Repeated("<a>", 200'000), "deep.owl"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("nested more than 100 deep")));
  std::string laughs = "<?xml version=\"1.0\"?>\n<!DOCTYPE rdf:RDF [\n<!ENTITY a0 \"ha\">\n";
  for (int i = 1; i < 40; ++i) {
    const std::string before = "&a" + std::to_string(i - 1) + ";";
    laughs += "<!ENTITY a" + std::to_string(i) + " \"" + Repeated(before, 10) + "\">\n";
  }
  laughs +=
      "]>\n<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\" "
      "xmlns:rdfs=\"http://www.w3.org/2000/01/rdf-schema#\">"
      "<rdf:Description rdf:about=\"urn:a\"><rdfs:label>&a39;</rdfs:label>"
      "</rdf:Description></rdf:RDF>\n";
  EXPECT_THAT([&] { Ontology::FromText(laughs, "laughs.owl"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("laughs.owl")));
}

TEST(RdfXmlTest, DamagedFilesGiveAnOntologyOrAnError) {
  const char* letters = "<>[]()\"'.;,:#&/ \nA\xff\xc3";
  EXPECT_GT(CountRefusals(kKitchenInXml, "damaged.owl", letters, base::Rng(47)), 100);
}

// The package's own ontology ----------------------------------------------------------------------

TEST(ShippedOntologyTest, HasEveryNameOfTheOriginalsTopicsUnderItsPrefix) {
  for (const char* name : {"upper:Point",
                           "upper:On",
                           "upper:At",
                           "upper:RobotAt",
                           "upper:Holding",
                           "upper:Area",
                           "upper:Task",
                           "upper:PrimitiveTask",
                           "upper:CompoundTask",
                           "upper:RobotActivity",
                           "upper:ElementaryRobotActivity",
                           "upper:PassiveObject",
                           "upper:RobotPosture",
                           "upper:InstructorDialogMove",
                           "upper:Experience",
                           "race:Mug",
                           "race:Table",
                           "race:Arm",
                           "race:ArmPosture",
                           "race:Torso",
                           "race:TorsoPosture",
                           "race:Gripper",
                           "race:GripperHoldingPosture",
                           "race:BlockedState",
                           "race:Kitchenware",
                           "race:PersonalItem",
                           "race:Furniture",
                           "race:MoveBaseActivity",
                           "race:MoveBaseBlindActivity",
                           "upper:hasBoundingBox",
                           "upper:hasPose",
                           "upper:hasZ",
                           "upper:hasPhysicalEntity",
                           "race:hasArmPosture"}) {
    const std::string local = std::string(name).substr(std::string(name).find(':') + 1);
    EXPECT_EQ(Shipped().Qualified(local), name);
  }
  EXPECT_THAT(Shipped().ConceptNames(),
              IsSupersetOf({"MonitoredFailure", "GripperPosture", "ArtificialBodyPart", "Intent",
                            "InstructorAbort", "InstructorAchieve", "InstructorTeach",
                            "InstructorCancelAffordance", "BeginEpisode", "EndEpisode", "Plan",
                            "Robot", "Pose", "HorizontalTable", "Board", "Chair", "BoundingBox"}));
  EXPECT_THAT(Shipped().RelationNames(),
              IsSupersetOf({"hasX", "hasY", "hasYaw", "hasResult", "hasArea"}));
}

TEST(ShippedOntologyTest, WhatTheMonitorMaySayIsApartFromTheStateOfTheWorld) {
  for (const char* record : {"RobotActivity", "MoveBaseParamActivity", "PickUpObjectActivity",
                             "Plan", "Task", "PlaceObjectTask", "MonitoredFailure", "Prediction",
                             "ImaginedFailure", "Intent", "BeginEpisode"}) {
    EXPECT_TRUE(IsA(Shipped(), record, "ExecutionRecord")) << record;
    EXPECT_FALSE(IsA(Shipped(), record, "State")) << record;
  }
  for (const char* state : {"On", "At", "RobotAt", "Holding", "Connected", "ArmTuckedPosture",
                            "TorsoUpPosture", "GripperOpened", "AreaBlocked"}) {
    EXPECT_TRUE(IsA(Shipped(), state, "State")) << state;
  }
}

TEST(ShippedOntologyTest, NothingIsARecordAndSomethingElse) {
  const Ontology& ontology = Shipped();
  for (const Ontology::ConceptId record : ontology.Below(ontology.Require("ExecutionRecord"))) {
    for (const char* other :
         {"State", "PhysicalEntity", "SpatialEntity", "Communication", "Experience", "MotionSet"}) {
      EXPECT_FALSE(ontology.IsA(record, ontology.Require(other))) << ontology.Name(record);
    }
  }
}

TEST(ShippedOntologyTest, HierarchyOfTheFacts) {
  for (const auto& [below, above] : std::vector<std::pair<const char*, const char*>>{
           {"Mug", "Kitchenware"},
           {"Peppermill", "Kitchenware"},
           {"CoffeeJug", "Kitchenware"},
           {"MilkPot", "Kitchenware"},
           {"SugarPot", "Kitchenware"},
           {"Book", "PersonalItem"},
           {"Kitchenware", "PassiveObject"},
           {"HorizontalTable", "Table"},
           {"Table", "Furniture"},
           {"Counter", "Furniture"},
           {"Guest", "Person"},
           {"ArmTuckedPosture", "ArmPosture"},
           {"ArmUnTuckedPosture", "ArmPosture"},
           {"ArmToSidePosture", "ArmPosture"},
           {"ArmCarryPosture", "ArmPosture"},
           {"ArmUnnamedPosture", "ArmPosture"},
           {"TorsoUpPosture", "TorsoPosture"},
           {"TorsoMiddlePosture", "TorsoPosture"},
           {"TorsoDownPosture", "TorsoPosture"},
           {"GripperOpened", "GripperPosture"},
           {"GripperClosed", "GripperPosture"},
           {"GripperHolding", "GripperHoldingPosture"},
           {"TrayArea", "PlacingArea"},
           {"PreManipulationArea", "Area"},
           {"ManipulationArea", "Area"},
           {"SittingArea", "Area"},
           {"FloorArea", "Area"},
           {"MoveBaseBlindActivity", "ElementaryRobotActivity"}}) {
    EXPECT_TRUE(IsA(Shipped(), below, above)) << below << " is no " << above;
  }
}

/// "MoveBaseBlind" of "move_base_blind".
std::string CamelCase(const std::string& words) {
  std::string camel;
  bool starts = true;
  for (const char c : words) {
    if (c != '_') camel += starts ? static_cast<char>(std::toupper(c)) : c;
    starts = c == '_';
  }
  return camel;
}

TEST(ShippedOntologyTest, EveryOperatorOfThePlannerHasItsActivityAndTask) {
  const YAML::Node operators =
      YAML::LoadFile(HIRES_SOURCE_DIR "/config/domains/restaurant.yaml")["operators"];
  ASSERT_GE(operators.size(), 13u);
  for (const auto& entry : operators) {
    const std::string name = CamelCase(entry.first.as<std::string>());
    EXPECT_TRUE(IsA(Shipped(), name + "Activity", "ElementaryRobotActivity"));
    EXPECT_TRUE(IsA(Shipped(), name + "Task", "PrimitiveTask"));
  }
}

TEST(ShippedOntologyTest, RelationFluentsHaveTheRolesOfTheTable) {
  const Ontology& ontology = Shipped();
  for (const auto& [concept_name, role, range] :
       std::vector<std::tuple<const char*, const char*, const char*>>{
           {"RobotAt", "hasRobot", "Robot"},
           {"RobotAt", "hasArea", "Area"},
           {"On", "hasPhysicalEntity", "PhysicalEntity"},
           {"On", "hasArea", "Area"},
           {"Holding", "hasArm", "Arm"},
           {"Holding", "hasPassiveObject", "PassiveObject"},
           {"ArmTuckedPosture", "hasArm", "Arm"},
           {"TorsoUpPosture", "hasTorso", "Torso"},
           {"GripperHoldingPosture", "hasGripper", "Gripper"},
           {"At", "hasPhysicalEntity", "PhysicalEntity"},
           {"Connected", "hasPlacingArea", "PlacingArea"},
           {"Connected", "hasManipulationArea", "ManipulationArea"},
           {"Connected", "hasPreManipulationArea", "PreManipulationArea"},
           {"Mug", "hasContent", "Substance"},
           {"Mug", "hasPose", "Pose"},
           {"Table", "hasPlacingArea", "PlacingArea"},
           {"SittingArea", "hasPlacingAreaLeft", "PlacingArea"},
           {"SittingArea", "hasPlacingAreaRight", "PlacingArea"},
           {"ImagineWish", "hasAction", "xsd:string"},
           {"ImaginedFailure", "hasArgument", "xsd:string"},
           {"MoveBaseActivity", "hasResult", "xsd:string"}}) {
    const Ontology::Relation* relation = ontology.FindRelation(role);
    ASSERT_NE(relation, nullptr) << role;
    EXPECT_EQ(relation->range, range) << role;
    const Ontology::ConceptId id = ontology.Require(concept_name);
    EXPECT_THAT(relation->domain, Contains(::testing::Truly([&](Ontology::ConceptId domain) {
                  return ontology.IsA(id, domain);
                })))
        << concept_name << " may not have " << role;
  }
}

}  // namespace
}  // namespace hires::knowledge::ontology_test
