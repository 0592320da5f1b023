#include "hires/knowledge/fluent_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/pose_moves.h"
#include "support/messages.h"

namespace hires::knowledge::fluent_yaml_test {
namespace {

using temporal::Bounds;
using temporal::kForever;
using test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kData = std::string(HIRES_SOURCE_DIR) + "/test/knowledge/data/";

std::string Document(const std::string& head, const std::string& properties) {
  return "!Fluent\nClass_Instance: " + head +
         "\nStartTime: [0, 0]\nFinishTime: [0, 0]\nProperties:" + properties + "\n";
}

std::string WithFiller(const std::string& type_and_filler) {
  return Document("[Mug, mug1]", "\n  - [hasThing, " + type_and_filler + "]");
}

Filler ReadFiller(const std::string& type_and_filler) {
  return ReadKnowledge(WithFiller(type_and_filler), "t").fluents.at(0).properties.at(0).filler;
}

std::string ErrorOf(const std::string& text) {
  return ConfigErrorOf([&] { ReadKnowledge(text, "kitchen.yaml"); });
}

Fluent WithTimes(const std::string& start, const std::string& finish) {
  return ReadKnowledge("!Fluent\nClass_Instance: [Mug, mug1]\nStartTime: " + start +
                           "\nFinishTime: " + finish + "\nProperties: []\n",
                       "t")
      .fluents.at(0);
}

// ------------------------------------------------------------------------------------ reading

TEST(ReadKnowledgeTest, AFluentHasConceptInstancePropertiesAndTimes) {
  const KnowledgeFile file = ReadKnowledge(
      "# a mug on its way\n!Fluent\nClass_Instance: [Mug, mug1]\nStartTime: [3, 4.5]\n"
      "FinishTime: [0, 0]\nProperties:\n  -  [hasPose, Pose, poseMug1]\n"
      "  -  [hasMass, \"xsd:float\", 0.3]\n",
      "t");
  Fluent mug;
  mug.concept_name = "Mug";
  mug.instance = "mug1";
  mug.properties = {{"hasPose", "Pose", std::string("poseMug1")}, {"hasMass", "xsd:float", 0.3}};
  mug.start = {3.0, 4.5};
  EXPECT_THAT(file.fluents, ElementsAre(mug));
  EXPECT_THAT(file.modifications, SizeIs(0));
  EXPECT_THAT(file.topics, SizeIs(0));
}

TEST(ReadKnowledgeTest, FillersHaveTheTypeThatIsNamed) {
  EXPECT_EQ(ReadFiller("xsd:float, 2"), Filler(2.0));
  EXPECT_EQ(ReadFiller("\"xsd:float\", -1.5e-3"), Filler(-0.0015));
  EXPECT_EQ(ReadFiller("'xsd:double', +.5"), Filler(0.5));
  EXPECT_EQ(ReadFiller("xsd:double, 5."), Filler(5.0));
  EXPECT_EQ(ReadFiller("xsd:int, -2147483648"), Filler(std::int64_t{-2147483648}));
  EXPECT_EQ(ReadFiller("xsd:integer, +9223372036854775807"),
            Filler(std::numeric_limits<std::int64_t>::max()));
  EXPECT_EQ(ReadFiller("xsd:boolean, True"), Filler(true));
  EXPECT_EQ(ReadFiller("xsd:boolean, FALSE"), Filler(false));
  EXPECT_EQ(ReadFiller("xsd:string, \"On\""), Filler(std::string("On")));
  EXPECT_EQ(ReadFiller("xsd:string, ''"), Filler(std::string()));
  EXPECT_EQ(ReadFiller("xsd:string, two words"), Filler(std::string("two words")));
  EXPECT_EQ(ReadFiller("xsd:string, !!str 12"), Filler(std::string("12")));
  EXPECT_EQ(ReadFiller("Pose, poseMug1"), Filler(std::string("poseMug1")));
}

TEST(ReadKnowledgeTest, ZerosAreSinceEverAndForEver) {
  const Fluent always = WithTimes("[0, 0]", "[0.0, 0.0]");
  EXPECT_EQ(always.start, (Bounds{-kForever, -kForever}));
  EXPECT_EQ(always.finish, (Bounds{kForever, kForever}));
  EXPECT_EQ(WithTimes("[-.inf, -.INF]", "[.inf, .Inf]"), always);
}

TEST(ReadKnowledgeTest, ZeroBesideAnotherTimeIsTheMomentZero) {
  EXPECT_EQ(WithTimes("[0, 5]", "[0, 0]").start, (Bounds{0.0, 5.0}));
  EXPECT_EQ(WithTimes("[-3, 0]", "[-3, 0]").finish, (Bounds{-3.0, 0.0}));
}

TEST(ReadKnowledgeTest, NegativeZerosAreTheMomentZero) {
  const Fluent begins = WithTimes("[-0.0, -0.0]", "[0, 0]");
  EXPECT_EQ(begins.start, (Bounds{0.0, 0.0}));
  EXPECT_FALSE(std::signbit(begins.start.earliest));
}

TEST(ReadKnowledgeTest, QuotedOnIsAConceptLikeAnyOther) {
  for (const std::string quoted : {"\"On\"", "'On'", "!!str On", "! On"}) {
    EXPECT_EQ(
        ReadKnowledge(Document("[" + quoted + ", onMug1]", " []"), "t").fluents.at(0).concept_name,
        "On")
        << quoted;
  }
}

TEST(ReadKnowledgeTest, WordsThatOnlyBeginLikeTruthAreNames) {
  for (const std::string name : {"Once", "oN", "yEs", "Nobody", "nulls", "x12", "e5", "a.b-c"}) {
    EXPECT_EQ(ReadKnowledge(Document("[" + name + ", one]", " []"), "t").fluents.at(0).concept_name,
              name);
  }
}

TEST(ReadKnowledgeTest, EmptyDocumentsAndCommentsArePassedOver) {
  const std::string fluent = Document("[Mug, mug1]", " []");
  const std::string text = "\xef\xbb\xbf# knowledge\n%YAML 1.1\n---\n" + fluent +
                           "...\n# between\n---\n---   # nothing\n" + fluent + "---\n";
  EXPECT_THAT(ReadKnowledge(text, "t").fluents, SizeIs(2));
  for (const std::string nothing : {"", "\n", "---\n", "# only a comment", "---\n...\n---\n\n"}) {
    EXPECT_THAT(ReadKnowledge(nothing, "t").fluents, SizeIs(0)) << nothing;
  }
}

TEST(ReadKnowledgeTest, LineEndsOfOtherSystemsAreReadAsWell) {
  const std::string text = Document("[Mug, mug1]", " []") + "---\n" +
                           Document("[Mug, mug2]", "\n  - [hasPose, Pose, poseMug2]");
  std::string with_returns;
  for (const char c : text) with_returns += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(ReadKnowledge(with_returns, "t").fluents, ReadKnowledge(text, "t").fluents);
}

TEST(ReadKnowledgeTest, AliasesStandForWhatTheyName) {
  const KnowledgeFile file = ReadKnowledge(
      "!Fluent\nClass_Instance: [Mug, mug1]\nStartTime: &always [0, 0]\nFinishTime: *always\n"
      "Properties:\n  - &pose [hasPose, Pose, poseMug1]\n  - *pose\n",
      "t");
  const Fluent& mug = file.fluents.at(0);
  EXPECT_EQ(mug.finish, (Bounds{kForever, kForever}));
  ASSERT_THAT(mug.properties, SizeIs(2));
  EXPECT_EQ(mug.properties[0], mug.properties[1]);
}

TEST(ReadKnowledgeTest, ATopicThatSaysLittleHasEmptyFilters) {
  const KnowledgeFile file = ReadKnowledge("!DemandTopic\nName: plan\nClassFilter: [Plan]\n", "t");
  ASSERT_THAT(file.topics, SizeIs(1));
  EXPECT_EQ(file.topics[0].name, "plan");
  EXPECT_THAT(file.topics[0].exact, ElementsAre("Plan"));
  EXPECT_THAT(file.topics[0].below, SizeIs(0));
  EXPECT_FALSE(file.topics[0].all_properties);
}

// ------------------------------------------------------------------------------------- errors

struct Malformed {
  std::string what, text;
  std::vector<std::string> parts;  // of the message, besides the name of the source
};

class MalformedTest : public ::testing::TestWithParam<Malformed> {};

TEST_P(MalformedTest, IsRefusedWithPlaceAndAdvice) {
  const std::string message = ErrorOf(GetParam().text);
  EXPECT_THAT(message, HasSubstr("kitchen.yaml: "));
  for (const std::string& part : GetParam().parts) EXPECT_THAT(message, HasSubstr(part));
  EXPECT_LT(message.size(), 700u) << "too long to be read";
}

const std::vector<Malformed> kStreams = {
    {"broken quotes",
     "!Fluent\nClass_Instance: [Mug, \"mug1]\n",
     {"document 1, line ", "no valid"}},
    {"broken brackets", "---\n---\n!Fluent\nA: [b\n", {"document 2, line ", "no valid YAML"}},
    {"tabs", "!Fluent\nProperties:\n\t- a\n", {"line 3", "no valid YAML"}},
    {"alias of nothing", "!Fluent\nClass_Instance: *a\n", {"line 2", "no valid YAML", "anchor"}},
    {"alias of its parent",
     "!Fluent\nClass_Instance: &a [*a]\n",
     {"line 2", "Class_Instance item 1", "inside of what it names"}},
    {"second root", "!Fluent {} !Fluent {}\n", {"line 1", "begin another one with '---'"}},
    {"no tag",
     "Class_Instance: [Mug, mug1]\n",
     {"line 1", "no tag", "!Fluent, !FluentPoseModification, !DemandTopic"}},
    {"unknown tag", "!Fluents\nA: b\n", {"line 1", "tag '!Fluents'", "did you mean '!Fluent'"}},
    {"tag alone", "# x\n!Fluent\n", {"document 1", "no content"}},
    {"list at the root", "!Fluent [a, b]\n", {"line 1", "!Fluent is no map", "Class_Instance"}},
    {"unknown key",
     "\n!Fluent\nClass_Instanze: [Mug, mug1]\n",
     {"line 3", "key 'Class_Instanze'", "did you mean 'Class_Instance'"}},
    {"list as a key", "!Fluent\n? [a, b]\n: c\n", {"line 2", "key '' is unknown"}},
    {"key twice",
     "!Fluent\nStartTime: [0, 0]\nStartTime: [0, 0]\n",
     {"line 3", "StartTime stands twice", "line 2"}},
    {"no instance",
     "!Fluent\nStartTime: [0, 0]\n",
     {"line ", "Class_Instance is missing", "write [concept, instance]"}},
    {"no start", "!Fluent\nClass_Instance: [Mug, mug1]\n", {"StartTime is missing", "[0, 0]"}},
    {"control character", "!Fluent\n# a\x04\nA: b\n", {"line 2", "0x04", "\\x04"}},
    {"returns without line feeds", "!Fluent\n\nA: b\rC: d\r", {"line 3", "carriage return"}},
    {"no UTF-8", "!Fluent\nClass_Instance: [Mug, m\xfcg]\n", {"line 2", "no UTF-8", "byte 32"}},
    {"UTF-16", std::string("\xff\xfe!\0F\0", 6), {"line 1", "control character 0x00"}},
    {"directive of another version", "%YAML 9.1\n---\n!Fluent {}\n", {"no valid YAML"}},
};

const std::vector<Malformed> kHeads = {
    {"unquoted On",
     Document("[On, onMug1]", " []"),
     {"document 1, line 2, Class_Instance item 1", "On, which YAML 1.1 reads as a truth value",
      "put it in quotes: \"On\""}},
    {"unquoted off", Document("[Mug, off]", " []"), {"Class_Instance item 2", "\"off\""}},
    {"unquoted YES", Document("[Mug, YES]", " []"), {"truth value", "\"YES\""}},
    {"unquoted No", Document("[Mug, No]", " []"), {"truth value", "\"No\""}},
    {"unquoted true", Document("[true, mug1]", " []"), {"truth value", "\"true\""}},
    {"unquoted n", Document("[Mug, n]", " []"), {"truth value", "\"n\""}},
    {"number as a name", Document("[Mug, 12]", " []"), {"12, which YAML 1.1 reads as a number"}},
    {"octal as a name", Document("[Mug, 0o17]", " []"), {"number", "\"0o17\""}},
    {"hexadecimal as a name", Document("[Mug, 0x1F]", " []"), {"number", "\"0x1F\""}},
    {"base 60 as a name", Document("[Mug, 1:30]", " []"), {"number", "\"1:30\""}},
    {"date as a name", Document("[Mug, 2015-03-01]", " []"), {"number", "\"2015-03-01\""}},
    {"not a number as a name", Document("[Mug, .NaN]", " []"), {"number", "\".NaN\""}},
    {"null as a name", Document("[Mug, ~]", " []"), {"Class_Instance item 2", "is empty"}},
    {"empty name", Document("[Mug, '']", " []"), {"line 2", "the name is empty"}},
    {"name with a line break", Document("[Mug, \"a\\nb\"]", " []"), {"control character"}},
    {"name too long",
     Document("[Mug, " + std::string(5000, 'm') + "]", " []"),
     {"line 2", "5000 bytes", "mmm..."}},
    {"three names",
     Document("[Mug, mug1, mug2]", " []"),
     {"line 2, Class_Instance", "a list of 3", "wanted [concept, instance]"}},
    {"name alone", Document("Mug", " []"), {"'Mug'", "wanted [concept, instance]"}},
    {"map as a name", Document("[Mug, {a: b}]", " []"), {"is a map, wanted text"}},
    {"tag on a name", Document("[Mug, !cup mug1]", " []"), {"tag '!cup'", "remove it"}},
};

std::string Times(const std::string& start, const std::string& finish) {
  return "!Fluent\nClass_Instance: [Mug, mug1]\nStartTime: " + start + "\nFinishTime: " + finish +
         "\nProperties: []\n";
}

const std::vector<Malformed> kTimes = {
    {"one time", Times("5", "[0, 0]"), {"line 3, StartTime", "'5'", "wanted [earliest, latest]"}},
    {"three times", Times("[0, 0]", "[1, 2, 3]"), {"line 4, FinishTime", "a list of 3"}},
    {"word as a time", Times("[now, 5]", "[0, 0]"), {"StartTime item 1", "'now'", "in seconds"}},
    {"quoted time", Times("['3', 5]", "[0, 0]"), {"quoted text '3'", "remove the quotes"}},
    {"no number", Times("[.nan, 5]", "[0, 0]"), {"StartTime item 1", "'.nan'", "in seconds"}},
    {"too large", Times("[1e400, 1e400]", "[0, 0]"), {"'1e400', which 64 bits cannot hold"}},
    {"wrong order", Times("[5, 4]", "[0, 0]"), {"line 3, StartTime", "[5, 4]", "earlier"}},
    {"ends before it starts",
     Times("[5, 6]", "[1, 4]"),
     {"line 4, FinishTime", "at 4 at the latest", "starts at 5"}},
    {"starts never", Times("[.inf, .inf]", "[0, 0]"), {"line 3, StartTime", "is never"}},
    {"ends before all time", Times("[0, 0]", "[-.inf, -.inf]"), {"line 4", "before all time"}},
};

const std::vector<Malformed> kFillers = {
    {"no list", Document("[Mug, mug1]", " hasPose"), {"line 5, Properties", "wanted a list"}},
    {"nothing", Document("[Mug, mug1]", ""), {"line 5, Properties", "empty", "wanted a list"}},
    {"two parts",
     Document("[Mug, mug1]", "\n  - [hasPose, poseMug1]"),
     {"line 6, Properties item 1", "a list of 2", "[property, filler type, filler]"}},
    {"unknown type",
     WithFiller("xsd:flaot, 1.0"),
     {"line 6, Properties item 1 item 2", "'xsd:flaot'",
      "xsd:float, xsd:double, xsd:int, "
      "xsd:integer, xsd:boolean, xsd:string, or a concept"}},
    {"word as a float",
     WithFiller("xsd:float, far"),
     {"line 6, Properties item 1 item 3", "'far'", "finite decimal number"}},
    {"quoted float", WithFiller("xsd:float, \"0.0\""), {"remove the quotes"}},
    {"infinite float", WithFiller("xsd:float, .inf"), {"'.inf'", "finite decimal number"}},
    {"no number", WithFiller("xsd:double, .nan"), {"'.nan'", "finite decimal number"}},
    {"too large", WithFiller("xsd:double, -1e999"), {"64 bits cannot hold"}},
    {"hexadecimal", WithFiller("xsd:integer, 0x10"), {"'0x10'", "whole decimal number"}},
    {"octal", WithFiller("xsd:integer, 010"), {"'010'", "whole decimal number"}},
    {"octal float", WithFiller("xsd:float, 010"), {"'010'", "finite decimal number"}},
    {"underscores", WithFiller("xsd:integer, 1_000"), {"'1_000'", "whole decimal number"}},
    {"two signs", WithFiller("xsd:integer, +-5"), {"'+-5'", "whole decimal number"}},
    {"fraction", WithFiller("xsd:int, 1.0"), {"'1.0'", "whole decimal number"}},
    {"33 bits", WithFiller("xsd:int, 2147483648"), {"2147483648", "32 bits", "xsd:integer"}},
    {"65 bits", WithFiller("xsd:integer, 9223372036854775808"), {"64 bits cannot hold"}},
    {"number as truth", WithFiller("xsd:boolean, 1"), {"'1'", "true or false"}},
    {"yes as truth", WithFiller("xsd:boolean, yes"), {"'yes'", "true or false"}},
    {"quoted truth", WithFiller("xsd:boolean, 'true'"), {"remove the quotes"}},
    {"unquoted word as text", WithFiller("xsd:string, On"), {"put it in quotes: \"On\""}},
    {"unquoted number as text", WithFiller("xsd:string, 5"), {"put it in quotes: \"5\""}},
    {"no text", WithFiller("xsd:string, null"), {"is empty, wanted text", "write \"\""}},
    {"list as text", WithFiller("xsd:string, [a]"), {"is a list of 1, wanted text"}},
    {"unquoted word as a link", WithFiller("Pose, Off"), {"item 3", "\"Off\""}},
    {"unquoted word as a role",
     Document("[Mug, mug1]", "\n  - [No, Pose, a]"),
     {"Properties item 1 item 1", "\"No\""}},
    {"unquoted word as a type", WithFiller("On, onMug1"), {"Properties item 1 item 2", "\"On\""}},
    {"second document",
     WithFiller("Pose, a") + "---\n" + WithFiller("xsd:float, a"),
     {"document 2, line 13"}},
};

std::string Modification(const std::string& instance, const std::string& choices,
                         const std::string& deltas, const std::string& attachments = "[]",
                         const std::string& group = "g") {
  return "!FluentPoseModification\nInstance: " + instance + "\nGroup: " + group +
         "\nChoices: " + choices + "\nModifications: " + deltas + "\nAttachments: " + attachments +
         "\n---\n";
}

const std::vector<Malformed> kModifications = {
    {"too few deltas",
     Modification("poseTable1", "3", "\n  - [hasX, [0, 1, 2]]\n  - [hasY, [0, 1]]"),
     {"document 1, line 7", "'poseTable1'", "hasY", "2 deltas", "Choices says 3"}},
    {"too many deltas",
     Modification("poseTable1", "1", "[[hasX, [0, 1]]]"),
     {"'poseTable1'", "hasX", "2 deltas", "Choices says 1"}},
    {"no axis",
     Modification("poseTable1", "1", "[[hasHeight, [0]]]"),
     {"line 1", "'poseTable1'", "hasHeight", "hasX, hasY, hasZ, hasYaw"}},
    {"axis twice",
     Modification("poseTable1", "1", "[[hasX, [0]], [hasX, [1]]]"),
     {"'poseTable1'", "hasX", "given twice"}},
    {"no choice", Modification("poseTable1", "0", "[]"), {"line 4, Choices", "is 0", "between 1"}},
    {"half a choice", Modification("poseTable1", "1.5", "[]"), {"'1.5'", "whole decimal number"}},
    {"delta no number", Modification("poseTable1", "1", "[[hasX, [far]]]"), {"'far'", "finite"}},
    {"delta no list", Modification("poseTable1", "1", "[[hasX, 1]]"), {"'1'", "list of deltas"}},
    {"no group", "!FluentPoseModification\nInstance: a\n", {"Group is missing"}},
    {"instance twice",
     Modification("a", "1", "[]") + Modification("a", "1", "[]"),
     {"document 2", "'a' is modified twice", "document 1"}},
    {"group of two minds",
     Modification("a", "2", "[]") + Modification("b", "3", "[]"),
     {"document 2", "'b' has 3 choices", "'a' of the same group 'g' has 2"}},
    {"attached to itself", Modification("a", "1", "[]", "[b, a]"), {"circle: a -> a", "take one"}},
    {"circle",
     Modification("t", "1", "[]", "[a]") + Modification("a", "1", "[]", "[x, b]") +
         Modification("b", "1", "[]", "[c]") + Modification("c", "1", "[]", "[z, a]"),
     {"circle: a -> b -> c -> a", "document 2"}},
};

const std::vector<Malformed> kTopics = {
    {"no name", "!DemandTopic\nClassFilter: [Plan]\n", {"Name is missing"}},
    {"no topic name", "!DemandTopic\nName: my topic\n", {"line 2, Name", "'my topic'", "letters"}},
    {"absolute name", "!DemandTopic\nName: /plan\n", {"'/plan'", "no topic name"}},
    {"name twice",
     "!DemandTopic\nName: plan\n---\n!DemandTopic\nName: plan\n",
     {"document 2, line ", "'plan' is demanded twice", "document 1"}},
    {"unknown mode",
     "!DemandTopic\nName: plan\nPropertyFilterMode: both\n",
     {"line 3, PropertyFilterMode", "'both'", "union or intersection"}},
    {"unquoted On",
     "!DemandTopic\nName: plan\nClassFilter: [Mug, On]\n",
     {"line 3, ClassFilter item 2", "put it in quotes: \"On\""}},
    {"filter no list", "!DemandTopic\nName: plan\nSubclassFilter: Plan\n", {"a list of names"}},
    {"query no list", "!DemandTopic\nName: plan\nQueryFilter: select\n", {"a list of queries"}},
    {"key of a fluent", "!DemandTopic\nName: plan\nStartTime: [0, 0]\n", {"key 'StartTime'"}},
};

/// Short and harmless to look at, and what they unfold to is not.
std::string BillionLaughs() {
  std::string text = "!Fluent\na: &a [x, x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c <= 'j'; ++c) {
    const std::string before = std::string("*") + static_cast<char>(c - 1) + " ";
    text += std::string(1, c) + ": &" + c + " [" + before;
    for (int i = 0; i < 9; ++i) text += ", " + before;
    text += "]\n";
  }
  return text;
}

/// Written flat, and deep once unfolded.
std::string StairsOfAliases() {
  std::string text = "!Fluent\ns0: &s0 [x]\n";
  for (int i = 1; i < 110; ++i) {
    const std::string step = "s" + std::to_string(i);
    text += step + ": &" + step + " [*s" + std::to_string(i - 1) + " ]\n";
  }
  return text;
}

/// Each document small enough, all together not.
std::string ManySmallLaughs() {
  std::string laughs = "SubclassFilter: [";
  for (int i = 0; i < 90'000; ++i) laughs += "*a ,";
  laughs += "]\n---\n";
  std::string text;
  for (int i = 0; i < 12; ++i) {
    text += "!DemandTopic\nName: t" + std::to_string(i) + "\nClassFilter: [&a x]\n" + laughs;
  }
  return text;
}

std::string LongTextOftenNamed() {
  std::string text = "!DemandTopic\nQueryFilter: [&a \"" + std::string(1 << 20, 'q') + "\"";
  for (int i = 0; i < 70; ++i) text += ", *a ";
  return text + "]\n";
}

std::string Repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

const std::vector<Malformed> kGreed = {
    {"billion laughs", BillionLaughs(), {"document 1, line 6, e item", "100000 values"}},
    {"many small laughs",
     ManySmallLaughs(),
     {"document 12, line 59, SubclassFilter item", "aliases unfold to 1000001 values"}},
    {"long text often named",
     LongTextOftenNamed(),
     {"QueryFilter item", "aliases unfold to", "67108864"}},
    {"stairs of aliases", StairsOfAliases(), {"document 1, line 100, s98 item 1", "100 levels"}},
    {"deep nesting",
     "!Fluent\nProperties: " + std::string(100'000, '['),
     {"line 2, Properties", "100 levels"}},
    {"deep nesting of blocks", "!Fluent\n" + Repeated("- ", 1000), {"line 2", "100 levels"}},
    {"too many values",
     "!Fluent\nProperties: [a" + Repeated(",a", 100'000) + "]",
     {"Properties item", "100000 values"}},
    {"too many brackets",
     "\n!Fluent\nProperties: " + std::string(1'000'001, '['),
     {"line 1", "1000000", "split it"}},
    {"10 MB in a value",
     WithFiller("xsd:string, \"" + std::string(10u << 20, 'x') + "\""),
     {"line 6, Properties item 1 item 3", "10485760 bytes", "at most 1048576"}},
    {"10 MB in a key",
     "!Fluent\n? " + std::string(10u << 20, 'x') + "\n: a\n",
     {"line 2", "10485760 bytes"}},
    {"65 MB", std::string(65u << 20, '#'), {"68157440 bytes", "at most 67108864"}},
};

std::string NameOf(const ::testing::TestParamInfo<Malformed>& info) {
  std::string name;
  for (const char c : info.param.what) name += c == ' ' || c == '-' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Stream, MalformedTest, ::testing::ValuesIn(kStreams), NameOf);
INSTANTIATE_TEST_SUITE_P(Head, MalformedTest, ::testing::ValuesIn(kHeads), NameOf);
INSTANTIATE_TEST_SUITE_P(Times, MalformedTest, ::testing::ValuesIn(kTimes), NameOf);
INSTANTIATE_TEST_SUITE_P(Filler, MalformedTest, ::testing::ValuesIn(kFillers), NameOf);
INSTANTIATE_TEST_SUITE_P(Modification, MalformedTest, ::testing::ValuesIn(kModifications), NameOf);
INSTANTIATE_TEST_SUITE_P(Topic, MalformedTest, ::testing::ValuesIn(kTopics), NameOf);
INSTANTIATE_TEST_SUITE_P(Greed, MalformedTest, ::testing::ValuesIn(kGreed), NameOf);

TEST(LoadKnowledgeTest, NamesTheFileThatIsMissing) {
  EXPECT_THAT(ConfigErrorOf([] { LoadKnowledge("/no/such/knowledge.yaml"); }),
              AllOf(HasSubstr("/no/such/knowledge.yaml"), HasSubstr("no such file")));
}

// ------------------------------------------------------------------------------------ writing

TEST(WriteKnowledgeTest, CanonicalTextComesBackAsItWas) {
  const std::string text = base::ReadTextFile(kData + "every_kind.yaml");
  EXPECT_EQ(WriteKnowledge(ReadKnowledge(text, "every_kind.yaml")), text);
}

TEST(WriteFluentsTest, NothingIsAnEmptyText) { EXPECT_EQ(WriteFluents({}), ""); }

TEST(WriteFluentsTest, NumbersAreShortAndFloatsForEveryReader) {
  const std::map<std::string, double> numbers = {
      {"5.0", 5.0},
      {"0.1", 0.1},
      {"-0.0", -0.0},
      {"1.0e+22", 1e22},
      {"1.5e-07", 1.5e-7},
      {"5.0e-324", 5e-324},
      {"1.7976931348623157e+308", 1.7976931348623157e308}};
  for (const auto& [text, number] : numbers) {
    Fluent fluent{"Mug", "mug1", {{"hasMass", "xsd:float", number}}};
    EXPECT_THAT(WriteFluents({fluent}), HasSubstr("\"xsd:float\", " + text + "]"));
    EXPECT_EQ(ReadFiller("xsd:float, " + text), Filler(number));
  }
}

TEST(WriteFluentsTest, WhatYamlWouldTakeForSomethingElseIsQuoted) {
  for (const std::string word :
       {"On", "off", "YES",  "n",    "Y",    "true", "False",    "null",
        "~",  "12",  "-1.5", "1e5",  "0x1F", "1:30", ".inf",     "2015-03-01",
        "",   " a",  "a b",  "a: b", "#a",   "*a",   "&a",       "!a",
        "<<", "=",   "a,b",  "[a]",  "-",    "?",    "xsd:float"}) {
    Fluent fluent{"Mug", "mug1", {{"hasReason", "xsd:string", word}}};
    EXPECT_THAT(WriteFluents({fluent}), HasSubstr(", \"" + word + "\"]"));
    EXPECT_THAT(ReadKnowledge(WriteFluents({fluent}), "t").fluents, ElementsAre(fluent)) << word;
  }
}

TEST(WriteFluentsTest, EveryCharacterOfTextComesBack) {
  std::string text;
  for (int c = 0; c < 128; ++c) text += static_cast<char>(c);
  text +=
      "\xc2\x80\xc2\x85\xc2\xa0\xc3\xa4\xe2\x80\xa8\xe2\x80\xa9\xef\xbb\xbf\xef\xbf\xbe\xef\xbf\xbd"
      "\xf0\x9f\x98\x80\xf4\x8f\xbf\xbf";
  const Fluent fluent{"Mug", "mug1", {{"hasReason", "xsd:string", text}}};
  const std::string written = WriteFluents({fluent});
  EXPECT_THAT(ReadKnowledge(written, "t").fluents, ElementsAre(fluent));
  EXPECT_EQ(WriteFluents(ReadKnowledge(written, "t").fluents), written);
}

TEST(WriteFluentsTest, LineBreaksAndInvisibleCharactersAreEscaped) {
  const Fluent fluent{
      "Mug",
      "mug1",
      {{"hasReason", "xsd:string",
        std::string("a\0\t\n\r\"\\\x7f", 8) + "\xc2\x85\xe2\x80\xa8\xef\xbb\xbf\xc3\xa4"}}};
  EXPECT_THAT(WriteFluents({fluent}), HasSubstr(R"("a\x00\t\n\x0d\"\\\x7f\x85\u2028\ufeff)" +
                                                std::string("\xc3\xa4\"]\n")));
}

TEST(WriteFluentsTest, WhatCannotBeReadBackIsNotWritten) {
  const Fluent infinite{"Mug", "mug1", {{"hasMass", "xsd:float", kForever}}};
  const Fluent no_text{"Mug", "mug1", {{"hasReason", "xsd:string", std::string("\xff")}}};
  EXPECT_THROW(WriteFluents({infinite}), std::logic_error);
  EXPECT_THROW(WriteFluents({no_text}), std::logic_error);
}

// ------------------------------------------------------------------------------ modifications

Fluent PoseAt(const std::string& instance, double x, double y, double z, double yaw) {
  return {"Pose",
          instance,
          {{"hasX", "xsd:float", x},
           {"hasY", "xsd:float", y},
           {"hasZ", "xsd:float", z},
           {"hasYaw", "xsd:float", yaw}}};
}

std::vector<Fluent> Scene() {
  std::vector<Fluent> scene = {
      {"Table", "table1", {{"hasPose", "Pose", std::string("poseTable1")}}}};
  for (const std::string name :
       {"poseTable1", "poseChair1", "poseChair2", "poseBag1", "posePR21", "poseFar"}) {
    scene.push_back(PoseAt(name, 10.0, 20.0, 0.5, 1.0));
  }
  return scene;
}

double Value(const std::vector<Fluent>& fluents, const std::string& instance, int property) {
  for (const Fluent& fluent : fluents) {
    if (fluent.instance == instance) {
      return std::get<double>(fluent.properties.at(static_cast<std::size_t>(property)).filler);
    }
  }
  throw std::runtime_error("no " + instance);
}

/// The scene after the choices that the seed draws, and which choices those were.
struct Drawn {
  std::vector<Fluent> scene;
  int furniture, robot;
};

Drawn ApplyScenario(std::uint64_t seed) {
  const KnowledgeFile file = LoadKnowledge(kData + "scenario.yaml");
  Drawn drawn{Scene(), base::Rng(seed).Fork(0).Index(3), base::Rng(seed).Fork(1).Index(3)};
  ApplyModifications(file.modifications, base::Rng(seed), &drawn.scene);
  return drawn;
}

TEST(ApplyModificationsTest, EachGroupDrawsOneChoiceAndAttachmentsMoveAlong) {
  const double table_x[] = {0, 0, 1}, table_y[] = {0, 1.5, -2}, chair_x[] = {0.5, 0.25, 0.125};
  const double robot_x[] = {0, -1, 0}, robot_y[] = {0, 1, 1}, robot_yaw[] = {0, -2, -0.43};
  std::map<int, int> seen;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Drawn drawn = ApplyScenario(seed);
    const int f = drawn.furniture, r = drawn.robot;
    ++seen[3 * f + r];
    EXPECT_EQ(Value(drawn.scene, "poseTable1", 0), 10.0 + table_x[f]);
    EXPECT_EQ(Value(drawn.scene, "poseTable1", 1), 20.0 + table_y[f]);
    EXPECT_EQ(Value(drawn.scene, "poseTable1", 2), 0.125);
    EXPECT_EQ(Value(drawn.scene, "poseChair2", 0), 10.0 + table_x[f]);
    EXPECT_EQ(Value(drawn.scene, "poseChair1", 0), 10.0 + table_x[f] + chair_x[f]);
    EXPECT_EQ(Value(drawn.scene, "poseBag1", 0), 10.0 + table_x[f] + chair_x[f]);
    EXPECT_EQ(Value(drawn.scene, "poseBag1", 1), 20.0 + table_y[f]);
    EXPECT_EQ(Value(drawn.scene, "posePR21", 0), 10.0 + robot_x[r]);
    EXPECT_EQ(Value(drawn.scene, "posePR21", 1), 20.0 + robot_y[r]);
    EXPECT_EQ(Value(drawn.scene, "posePR21", 3), 1.0 + robot_yaw[r]);
    EXPECT_EQ(Value(drawn.scene, "poseFar", 0), 10.0);
  }
  EXPECT_EQ(seen.size(), 9u) << "30 seeds meet every combination";
}

TEST(ApplyModificationsTest, TheSameSeedGivesTheSameScene) {
  EXPECT_EQ(ApplyScenario(7).scene, ApplyScenario(7).scene);
}

TEST(ApplyModificationsTest, WhatTwoWaysLeadToMovesOnce) {
  const KnowledgeFile file =
      ReadKnowledge(Modification("poseTable1", "1", "[[hasX, [1]]]", "[poseChair1, poseChair2]") +
                        Modification("poseChair1", "1", "[]", "[poseBag1, poseBag1]") +
                        Modification("poseChair2", "1", "[]", "[poseBag1]"),
                    "t");
  std::vector<Fluent> scene = Scene();
  ApplyModifications(file.modifications, base::Rng(1), &scene);
  EXPECT_EQ(Value(scene, "poseBag1", 0), 11.0);
}

TEST(ApplyModificationsTest, EveryValidityOfAPoseIsMoved) {
  const KnowledgeFile file = ReadKnowledge(Modification("poseFar", "1", "[[hasX, [1]]]"), "t");
  std::vector<Fluent> scene = {PoseAt("poseFar", 1, 0, 0, 0), PoseAt("poseFar", 2, 0, 0, 0)};
  ApplyModifications(file.modifications, base::Rng(1), &scene);
  EXPECT_THAT(scene, ElementsAre(PoseAt("poseFar", 2, 0, 0, 0), PoseAt("poseFar", 3, 0, 0, 0)));
}

TEST(ApplyModificationsTest, NamesCompareWithoutCase) {
  const KnowledgeFile file =
      ReadKnowledge(Modification("POSETABLE1", "1", "[[hasX, [1]]]", "[PoseChair1, poseCHAIR1]") +
                        Modification("poseChair1", "1", "[]", "[posebag1]"),
                    "t");
  std::vector<Fluent> scene = Scene();
  ApplyModifications(file.modifications, base::Rng(1), &scene);
  for (const std::string name : {"poseTable1", "poseChair1", "poseBag1"}) {
    EXPECT_EQ(Value(scene, name, 0), 11.0) << name;
  }
  EXPECT_EQ(Value(scene, "poseChair2", 0), 10.0);
  EXPECT_THAT(ConfigErrorOf([] {
                ReadKnowledge(Modification("poseA", "1", "[]") + Modification("POSEA", "1", "[]"),
                              "t");
              }),
              HasSubstr("'POSEA' is modified twice"));
  EXPECT_THAT(ConfigErrorOf([] {
                ReadKnowledge(Modification("poseA", "1", "[]", "[poseB]") +
                                  Modification("POSEB", "1", "[]", "[POSEA]"),
                              "t");
              }),
              HasSubstr("attachments go in a circle"));
}

std::string ApplyError(const std::string& text, std::vector<Fluent> scene) {
  const std::vector<Fluent> before = scene;
  const KnowledgeFile file = ReadKnowledge(text, "t");
  std::string message =
      ConfigErrorOf([&] { ApplyModifications(file.modifications, base::Rng(1), &scene); });
  EXPECT_EQ(scene, before) << "all or none";
  return message;
}

TEST(ApplyModificationsTest, NamesWhatItCannotMove) {
  const std::string good = Modification("poseTable1", "1", "[[hasX, [1]]]", "[]", "h");
  EXPECT_THAT(ApplyError(good + Modification("poseSofa1", "1", "[]"), Scene()),
              AllOf(HasSubstr("modification of 'poseSofa1'"), HasSubstr("no fluent is called so")));
  EXPECT_THAT(ApplyError(good + Modification("poseBag1", "1", "[]", "[poseSofa1]"), Scene()),
              AllOf(HasSubstr("modification of 'poseBag1'"), HasSubstr("'poseSofa1'")));
  EXPECT_THAT(ApplyError(good + Modification("table1", "1", "[]"), Scene()),
              AllOf(HasSubstr("'table1'"), HasSubstr("is a Table; name its Pose")));
  std::vector<Fluent> scene = Scene();
  scene.push_back({"Pose", "poseFlat", {{"hasX", "xsd:float", 1e308}}});
  EXPECT_THAT(ApplyError(good + Modification("poseFlat", "1", "[[hasYaw, [1]]]"), scene),
              AllOf(HasSubstr("'poseFlat'"), HasSubstr("along hasYaw")));
  EXPECT_THAT(ApplyError(good + Modification("poseFlat", "1", "[[hasX, [1.7e308]]]"), scene),
              AllOf(HasSubstr("hasX of 'poseFlat' overflows")));
}

TEST(ApplyModificationsTest, ChecksModificationsThatNobodyRead) {
  PoseModification modification{"poseTable1", "g", 2, {{"hasX", {1.0}}}, {}};
  std::vector<Fluent> scene = Scene();
  const auto apply = [&] { ApplyModifications({modification}, base::Rng(1), &scene); };
  EXPECT_THAT(ConfigErrorOf(apply),
              AllOf(HasSubstr("'poseTable1', hasX"), HasSubstr("1 deltas, Choices says 2")));
  modification = {"poseTable1", "g", 1, {{"hasX", {kForever}}}, {}};
  EXPECT_THAT(ConfigErrorOf(apply), HasSubstr("not finite"));
  modification = {"poseTable1", "g", 0, {}, {}};
  EXPECT_THAT(ConfigErrorOf(apply), HasSubstr("Choices is 0"));
  modification = {"poseTable1", "g", 1, {}, {"poseTable1"}};
  EXPECT_THAT(ConfigErrorOf(apply), HasSubstr("poseTable1 -> poseTable1"));
}

TEST(ApplyModificationsTest, AChainThatMovesTooMuchIsRefused) {
  std::string text;
  std::vector<Fluent> scene;
  constexpr int kLength = 1500;  // each moves all behind it: more than a million
  for (int i = 0; i < kLength; ++i) {
    const std::string name = "p" + std::to_string(i);
    const std::string next = i + 1 < kLength ? "[p" + std::to_string(i + 1) + "]" : "[]";
    text += Modification(name, "1", "[[hasX, [1]]]", next);
    scene.push_back(PoseAt(name, 0, 0, 0, 0));
  }
  EXPECT_THAT(ApplyError(text, scene), HasSubstr("more than 1000000 poses are moved"));
}

// A table at (10, 20) is turned by a quarter and shifted; a chair 2 m east of it comes to stand 2 m
// north of where the table is then, and a bag 1 m north of the chair 1 m west of it.
TEST(MovePosesTest, WhatIsAttachedGoesAlongRigidly) {
  const KnowledgeFile file =
      ReadKnowledge(Modification("poseTable1", "1",
                                 "[[hasX, [0.5]], [hasY, [-1]], [hasYaw, [1.5707963267948966]]]",
                                 "[poseChair1]") +
                        Modification("poseChair1", "1", "[[hasZ, [0.25]]]", "[poseBag1]"),
                    "t");
  std::vector<Fluent> scene = {PoseAt("poseTable1", 10, 20, 0, 0.5),
                               PoseAt("poseChair1", 12, 20, 0, 1),
                               PoseAt("poseBag1", 12, 21, 0.4, 0), PoseAt("poseFar", 1, 2, 3, 0)};
  const PoseMoves moves = MovePoses(file.modifications, {{"g", 0}}, &scene);
  const double expected[4][4] = {{10.5, 19.0, 0.0, 0.5 + M_PI_2},
                                 {10.5, 21.0, 0.25, 1.0 + M_PI_2},
                                 {9.5, 21.0, 0.65, M_PI_2},
                                 {1.0, 2.0, 3.0, 0.0}};
  for (std::size_t i = 0; i < scene.size(); ++i) {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      EXPECT_NEAR(std::get<double>(scene[i].properties[axis].filler), expected[i][axis], 1e-12)
          << scene[i].instance << " " << axis;
    }
  }
  ASSERT_EQ(moves.count("posebag1"), 1u);
  double x = 12.0, y = 21.0;
  for (const PoseMove& move : moves.at("posebag1")) MovePoint(move, &x, &y);
  EXPECT_NEAR(x, 9.5, 1e-12);
  EXPECT_NEAR(y, 21.0, 1e-12);
  EXPECT_EQ(moves.count("posefar"), 0u);
}

TEST(MovePosesTest, NothingIsTurnedAboutAPoseOfSeveralValidities) {
  const KnowledgeFile file =
      ReadKnowledge(Modification("poseFar", "1", "[[hasYaw, [1]]]", "[poseBag1]"), "t");
  std::vector<Fluent> scene = {PoseAt("poseFar", 1, 0, 0, 0), PoseAt("poseFar", 2, 0, 0, 0),
                               PoseAt("poseBag1", 0, 0, 0, 0)};
  EXPECT_THAT(ConfigErrorOf([&] {
                MovePoses(file.modifications, {{"g", 0}}, &scene);
              }),
              AllOf(HasSubstr("t: document 1, line 1"), HasSubstr("'poseFar' has 2 validities")));
}

// -------------------------------------------------------------------------------- scenarios

TEST(ScenarioDocumentTest, ATextForAllRunsOrOneForEachChoice) {
  const KnowledgeFile file = ReadKnowledge(
      "!Scenario\nScenario: serve_coffee\nZOrigin: -0.375\n---\n"
      "!Scenario\nGroup: sensors\nChoices: 2\nTruth: [same, ideal]\n",
      "t");
  ASSERT_THAT(file.scenarios, SizeIs(2));
  EXPECT_THAT(file.scenarios[0].values.at("Scenario"), ElementsAre("serve_coffee"));
  EXPECT_EQ(file.scenarios[0].z_origin, -0.375);
  EXPECT_EQ(file.scenarios[1].group, "sensors");
  EXPECT_THAT(file.scenarios[1].values.at("Truth"), ElementsAre("same", "ideal"));
}

TEST(ScenarioDocumentTest, ErrorsNameLineAndField) {
  const auto error = [](const std::string& text) {
    return ConfigErrorOf([&] { ReadKnowledge("!Scenario\n" + text, "t"); });
  };
  EXPECT_THAT(error("Group: g\nChoices: 3\nTruth: [same, ideal]\n"),
              AllOf(HasSubstr("t: document 1, line 4, Truth"), HasSubstr("a list of 2"),
                    HasSubstr("3 texts")));
  EXPECT_THAT(error("Group: g\nTruth: [same]\n"), HasSubstr("key Choices is missing"));
  EXPECT_THAT(error("Choices: 2\n"), AllOf(HasSubstr("line 2, Choices"), HasSubstr("no Group")));
  EXPECT_THAT(error("Truth: [same]\n"),
              AllOf(HasSubstr("line 2, Truth"), HasSubstr("wanted text")));
  EXPECT_THAT(error("Instructions: x\n"), AllOf(HasSubstr("line 2"), HasSubstr("Instruction")));
  EXPECT_THAT(error("ZOrigin: low\n"), AllOf(HasSubstr("line 2, ZOrigin"), HasSubstr("'low'")));
}

// ----------------------------------------------------------------------------- original files

class OriginalFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(Path("spawn_objects.yaml"))) {
      GTEST_SKIP() << "the original's files are not here: " << Path("spawn_objects.yaml");
    }
  }
  static std::string Path(const std::string& name) {
    return (std::filesystem::path(HIRES_SHARED_DATA) / name).string();
  }
};

TEST_F(OriginalFileTest, SpawnObjectsLoadsWholeAndComesBackTheSame) {
  const KnowledgeFile file = LoadKnowledge(Path("spawn_objects.yaml"));
  std::map<std::string, int> concepts;
  for (const Fluent& fluent : file.fluents) ++concepts[fluent.concept_name];
  EXPECT_EQ(concepts, (std::map<std::string, int>{{"Robot", 1},
                                                  {"HorizontalTable", 4},
                                                  {"Table", 1},
                                                  {"Chair", 4},
                                                  {"Mug", 2},
                                                  {"Pose", 12}}));
  EXPECT_EQ(file.fluents[1], PoseAt("posePR21", 12.5, 9.8, 0.0, 2.0));
  EXPECT_EQ(ReadKnowledge(WriteFluents(file.fluents), "t").fluents, file.fluents);
}

TEST_F(OriginalFileTest, TopicsLoadWholeAndComeBackTheSame) {
  const KnowledgeFile file = LoadKnowledge(Path("bb_topics.yaml"));
  ASSERT_THAT(file.topics, SizeIs(24));
  EXPECT_EQ(file.topics[1].name, "stefan_result");
  EXPECT_TRUE(file.topics[1].all_properties);
  EXPECT_THAT(file.topics[1].below, ElementsAre("RobotActivity"));
  EXPECT_THAT(file.topics[1].properties, ElementsAre("hasResult"));
  EXPECT_THAT(file.topics[22].queries, ElementsAre(HasSubstr("hasZ \"0.0\"^^xsd:float")));
  std::size_t num_queries = 0;
  for (const DemandTopic& topic : file.topics) num_queries += topic.queries.size();
  EXPECT_EQ(num_queries, 14u);
  const std::string written = WriteKnowledge(file);
  EXPECT_EQ(WriteKnowledge(ReadKnowledge(written, "t")), written);
}

TEST_F(OriginalFileTest, ReplaceHasThreeChoicesAndTwoDeltas) {
  EXPECT_THAT(ConfigErrorOf([] { LoadKnowledge(Path("replace.yaml")); }),
              AllOf(HasSubstr("replace.yaml: document 1, line 6"), HasSubstr("'poseTable1'"),
                    HasSubstr("hasX"), HasSubstr("2 deltas"), HasSubstr("Choices says 3")));
}

}  // namespace
}  // namespace hires::knowledge::fluent_yaml_test
