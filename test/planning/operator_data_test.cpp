#include "hires/planning/operator_data.h"

#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/planning/shop2_reader.h"
#include "support/temporary_folder.h"

namespace hires::planning::operator_data_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr double kOpen = std::numeric_limits<double>::infinity();

const char kDomain[] = R"((defdomain small (
  (:operator (!drive ?to ?set) ((at ?from)) ((at ?from)) ((at ?to)))
  (:operator (!grasp ?cup ?arm) () () ())
  (:operator (!wait (fixed ?time)) () () ())
  (:operator (!!note ?x) () () ()))))";

const char kSidecar[] = R"(capacities: {Wheels: 1, LeftHand: 1, rightHand: 2}
operators:
  drive:
    duration: [1.5, .inf]
    resources: {wheels: 1}
    imagine: {parameters: [set], default: {set: Fast}, on_late: wait, min_success: 0.8}
    leg: {from: from, to: to, motion_set: set}
  grasp:
    duration: [2, 9.5]
    expected: 3.0
    resources: {<arm>Hand: 1}
    disturbs: ['(At ?where)']
  wait:
    duration: [0.0, 0.0]
    resources: {}
legs:
  - {from: bar, to: Table, motion_set: fast, duration: [4.0, .inf], expected: 6.5}
  - {from: bar, to: table, motion_set: slow, duration: [8.0, 60.0]}
)";

Domain SmallDomain() { return ReadShop2Domain(kDomain, "small.lisp"); }

OperatorData ReadSmall(const std::string& yaml = kSidecar) {
  return ReadOperatorData(yaml, "small.yaml", SmallDomain());
}

/// The sidecar with the first `old_text` replaced.
std::string Changed(const std::string& old_text, const std::string& new_text) {
  std::string yaml = kSidecar;
  const std::size_t at = yaml.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return yaml.replace(at, old_text.size(), new_text);
}

std::string ErrorOf(const std::string& yaml) {
  try {
    ReadSmall(yaml);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

PlanStep Step(const std::vector<std::string>& words) {
  PlanStep step;
  for (const std::string& word : words) step.task.items.push_back(MakeSymbol(word));
  return step;
}

/// As in a plan: the bindings have what the task does not say.
PlanStep Drive(const std::string& from, const std::string& to, const std::string& set) {
  PlanStep step = Step({"!drive", to, set});
  step.bindings = {{"?from", MakeSymbol(from)}};
  return step;
}

TEST(OperatorDataTest, TheOrderOfSubtasksIsKeptUnlessTheSidecarSaysOtherwise) {
  EXPECT_EQ(ReadSmall().subtask_order, SubtaskOrder::kKept);
  EXPECT_EQ(ReadSmall("subtask_order: causal_links\n" + std::string(kSidecar)).subtask_order,
            SubtaskOrder::kCausalLinks);
}

TEST(OperatorDataTest, EveryFieldIsRead) {
  const OperatorData data = ReadSmall();
  EXPECT_THAT(data.capacities,
              UnorderedElementsAre(Pair("wheels", 1), Pair("lefthand", 1), Pair("righthand", 2)));
  const OperatorEntry& drive = EntryOf(data, "drive");
  EXPECT_THAT(drive.arguments, ElementsAre("to", "set"));
  EXPECT_EQ(drive.duration.min, 1.5);
  EXPECT_EQ(drive.duration.max, kOpen);
  EXPECT_FALSE(drive.duration.expected.has_value());
  EXPECT_THAT(drive.resources, ElementsAre(Pair("wheels", 1)));
  ASSERT_TRUE(drive.imagine.has_value());
  EXPECT_THAT(drive.imagine->parameters, ElementsAre("set"));
  EXPECT_THAT(drive.imagine->defaults, ElementsAre(Pair("set", "fast")));
  EXPECT_EQ(drive.imagine->on_late, OnLate::kWait);
  EXPECT_EQ(drive.imagine->min_success, 0.8);
  const OperatorEntry& grasp = EntryOf(data, "grasp");
  EXPECT_EQ(grasp.duration.max, 9.5);
  EXPECT_EQ(grasp.duration.expected, 3.0);
  EXPECT_FALSE(grasp.imagine.has_value());
  EXPECT_FALSE(grasp.leg.has_value());
  EXPECT_THAT(EntryOf(data, "wait").resources, IsEmpty());
}

TEST(OperatorDataTest, OperatorsAreFoundWithTheirMarkAndInAnyCase) {
  const OperatorData data = ReadSmall();
  EXPECT_EQ(&EntryOf(data, "!Grasp"), &EntryOf(data, "grasp"));
}

TEST(OperatorDataTest, AnUnknownOperatorIsAnErrorWithTheNearestName) {
  const OperatorData data = ReadSmall();
  try {
    EntryOf(data, "!grap");
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("operator 'grap' is unknown; did you mean 'grasp'"));
  }
}

TEST(OperatorDataTest, OperatorsOfBookkeepingNeedNoEntry) {
  EXPECT_THAT(ReadSmall().operators, ::testing::SizeIs(3));
}

TEST(OperatorDataTest, AResourceMayDependOnAnArgument) {
  const OperatorData data = ReadSmall();
  EXPECT_THAT(ResourcesOf(data, Step({"!grasp", "cup1", "right"})),
              ElementsAre(Pair("righthand", 1)));
  EXPECT_THAT(ResourcesOf(data, Drive("bar", "table", "slow")), ElementsAre(Pair("wheels", 1)));
}

TEST(OperatorDataTest, AnArgumentWithoutItsResourceIsAnError) {
  const OperatorData data = ReadSmall();
  try {
    ResourcesOf(data, Step({"!grasp", "cup1", "third"}));
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("(!grasp cup1 third)"));
    EXPECT_THAT(error.what(), HasSubstr("resource 'thirdhand' is unknown"));
  }
}

TEST(OperatorDataTest, DrivesTakeAsLongAsTheirLeg) {
  const OperatorData data = ReadSmall();
  const Duration fast = DurationOf(data, Drive("bar", "table", "fast"));
  EXPECT_EQ(fast.min, 4.0);
  EXPECT_EQ(fast.expected, 6.5);
  EXPECT_EQ(DurationOf(data, Drive("bar", "table", "slow")).max, 60.0);
}

TEST(OperatorDataTest, OtherDrivesTakeAsLongAsTheOperator) {
  const OperatorData data = ReadSmall();
  EXPECT_EQ(DurationOf(data, Drive("table", "bar", "fast")).min, 1.5);
  EXPECT_EQ(DurationOf(data, Step({"!drive", "table", "fast"})).min, 1.5) << "no bindings";
  EXPECT_EQ(DurationOf(data, Step({"!grasp", "cup1", "left"})).min, 2.0);
}

TEST(OperatorDataTest, OneMotionSetMayServeForAllDrives) {
  const OperatorData data = ReadSmall(Changed("leg: {from: from, to: to, motion_set: set}",
                                              "leg: {from: from, to: to, fixed_motion_set: slow}"));
  EXPECT_EQ(DurationOf(data, Drive("bar", "table", "fast")).min, 8.0);
}

struct BadSidecar {
  const char* what;
  const char* old_text;
  const char* new_text;
  std::vector<const char*> message;
};

class BadSidecarTest : public ::testing::TestWithParam<BadSidecar> {};

TEST_P(BadSidecarTest, TheMessageNamesFileAndKeyAndLine) {
  const std::string error = ErrorOf(Changed(GetParam().old_text, GetParam().new_text));
  EXPECT_THAT(error, HasSubstr("small.yaml: "));
  EXPECT_THAT(error, HasSubstr("; line "));
  for (const char* part : GetParam().message) EXPECT_THAT(error, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    OperatorDataTest, BadSidecarTest,
    ::testing::Values(
        BadSidecar{"UnknownOperator",
                   "  wait:",
                   "  jump: {}\n  wait:",
                   {"key 'operators.jump' is unknown"}},
        BadSidecar{"MissingOperator", "  wait:", "  wayt:", {"operators.wait is missing"}},
        BadSidecar{
            "NoDuration", "    duration: [2, 9.5]\n", "", {"operators.grasp.duration is missing"}},
        BadSidecar{"OneBound", "[2, 9.5]", "[2]", {"operators.grasp.duration", "[min, max]"}},
        BadSidecar{"NoBounds",
                   "[2, 9.5]",
                   "3.0",
                   {"operators.grasp.duration is '3.0'", "wanted [min, max]"}},
        BadSidecar{"BoundsByName", "[2, 9.5]", "{min: 2, max: 9.5}", {"wanted [min, max]"}},
        BadSidecar{"ListInBounds", "[2, 9.5]", "[[2], 9.5]", {"wanted [min, max]"}},
        BadSidecar{"NoNumber", "[2, 9.5]", "[2, soon]", {"'soon' is no bound", ".inf"}},
        BadSidecar{"NotANumber", "[2, 9.5]", "[.nan, 9.5]", {"'.nan' is no bound"}},
        BadSidecar{"NegativeBound", "[2, 9.5]", "[-2, 9.5]", {"'-2' is no bound", "0 or more"}},
        BadSidecar{"MinAboveMax", "[2, 9.5]", "[20, 9.5]", {"min 20 is above max 9.5"}},
        BadSidecar{"InfiniteMin", "[2, 9.5]", "[.inf, .inf]", {"min is infinite"}},
        BadSidecar{"ExpectedOutside",
                   "expected: 3.0",
                   "expected: 1.0",
                   {"operators.grasp.expected", "between 2 and 9.5"}},
        BadSidecar{"UnknownResource",
                   "{wheels: 1}",
                   "{wheel: 1}",
                   {"operators.drive.resources.wheel", "did you mean 'wheels'"}},
        BadSidecar{"TooManyUnits",
                   "{wheels: 1}",
                   "{wheels: 2}",
                   {"operators.drive.resources.wheels", "between 1 and 1"}},
        BadSidecar{"ResourceTwice", "{wheels: 1}", "{wheels: 1, Wheels: 1}", {"stands twice"}},
        BadSidecar{"UnknownArgumentInResource",
                   "<arm>Hand",
                   "<hand>Hand",
                   {"argument 'hand' is unknown", "arm"}},
        BadSidecar{"NoResourceFitsArgument",
                   "<arm>Hand",
                   "<arm>Foot",
                   {"resource '<arm>Foot' is unknown"}},
        BadSidecar{
            "NoCapacity", "Wheels: 1", "Wheels: 0", {"capacities.Wheels", "between 1 and 1000"}},
        BadSidecar{"CapacityTwice", "Wheels: 1", "Wheels: 1, wheels: 1", {"stands twice"}},
        BadSidecar{"UnknownParameter",
                   "[set]",
                   "[speed]",
                   {"operators.drive.imagine.parameters", "argument 'speed' is unknown", "set"}},
        BadSidecar{"ParameterTwice", "[set]", "[set, Set]", {"'set' stands twice"}},
        BadSidecar{"NoDefault",
                   "[set], default: {set: Fast}",
                   "[to], default: {}",
                   {"operators.drive.imagine.default.to is missing"}},
        BadSidecar{"NoDefaults",
                   "[set], default: {set: Fast}",
                   "[set, to]",
                   {"operators.drive.imagine.default is missing"}},
        BadSidecar{"EmptyDefault",
                   "{set: Fast}",
                   "{set: \"\"}",
                   {"operators.drive.imagine.default.set", "wanted the value"}},
        BadSidecar{"UnknownDefault",
                   "{set: Fast}",
                   "{set: Fast, to: bar}",
                   {"key 'operators.drive.imagine.default.to' is unknown"}},
        BadSidecar{"UnknownOnLate",
                   "on_late: wait",
                   "on_late: never",
                   {"operators.drive.imagine.on_late", "'default', 'wait'"}},
        BadSidecar{"CertainSuccess",
                   "min_success: 0.8",
                   "min_success: 1.0",
                   {"operators.drive.imagine.min_success is '1.0'", "between 0.001 and 0.999"}},
        BadSidecar{"UnknownLegVariable",
                   "leg: {from: from",
                   "leg: {from: start",
                   {"operators.drive.leg.from", "variable of the operator 'start' is unknown"}},
        BadSidecar{"UnknownFixedMotionSet",
                   "motion_set: set",
                   "fixed_motion_set: fats",
                   {"motion set of the legs 'fats' is unknown", "'fast'"}},
        BadSidecar{"BothMotionSets",
                   "motion_set: set",
                   "motion_set: set, fixed_motion_set: fast",
                   {"key 'operators.drive.leg.motion_set' is unknown"}},
        BadSidecar{"LegTwice",
                   "motion_set: slow, duration",
                   "motion_set: FAST, duration",
                   {"legs[1].from", "stands twice"}},
        BadSidecar{"NoMap",
                   "{wheels: 1}",
                   "[wheels]",
                   {"operators.drive.resources is a list, wanted a map"}}),
    [](const auto& test) { return test.param.what; });

TEST(OperatorDataTest, DefaultOfAMotionSetMayBeLeftOut) {
  EXPECT_FALSE(LacksDefaults(ReadSmall()));
  for (const char* text : {"default: {}, ", ""}) {
    const OperatorData data = ReadSmall(Changed("default: {set: Fast}, ", text));
    EXPECT_THAT(data.operators.at("drive").imagine->defaults, IsEmpty());
    EXPECT_TRUE(LacksDefaults(data));
  }
}

TEST(OperatorDataTest, AFileIsReadAndNamedInErrors) {
  hires::test_support::TemporaryFolder folder;
  const std::string path = folder.Write("small.yaml", kSidecar);
  EXPECT_THAT(LoadOperatorData(path, SmallDomain()).legs, ::testing::SizeIs(2));
  EXPECT_THROW(LoadOperatorData(path + ".gone", SmallDomain()), base::ConfigError);
}

TEST(OperatorDataTest, WhatAStepDisturbsIsAPatternOfWhatStepsChange) {
  const OperatorData data = ReadSmall();
  ASSERT_EQ(data.operators.at("grasp").disturbs.size(), 1u);
  EXPECT_EQ(ToString(data.operators.at("grasp").disturbs[0]), "(at ?where)");
  EXPECT_THAT(data.operators.at("drive").disturbs, IsEmpty());
  EXPECT_THAT(ErrorOf(Changed("(At ?where)", "(ate ?where)")),
              AllOf(HasSubstr("small.yaml"), HasSubstr("disturbs"), HasSubstr("'ate'"),
                    HasSubstr("did you mean 'at'?")));
  EXPECT_THAT(ErrorOf(Changed("(At ?where)", "at")), HasSubstr("'at' is no atom; wanted"));
  EXPECT_THAT(ErrorOf(Changed("(At ?where)", "(at x) (at y)")), HasSubstr("is no atom"));
}

}  // namespace
}  // namespace hires::planning::operator_data_test
