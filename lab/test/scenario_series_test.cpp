#include "lab/src/series/scenario_series.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::scenario_series_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kReplace = std::string(HIRES_SOURCE_DIR) + "/lab/config/series/replace.yaml";
const std::string kOriginal = std::string(HIRES_SHARED_DATA) + "/replace.yaml";

/// A document that moves one pose; line 6 is its first delta.
std::string Move(const std::string& pose, const std::string& group, int choices,
                 const std::string& x, const std::string& attachments = "[]") {
  return "!FluentPoseModification\nInstance: " + pose + "\nGroup: " + group +
         "\nChoices: " + std::to_string(choices) + "\nModifications:\n  - [hasX, " + x +
         "]\nAttachments: " + attachments + "\n";
}

class ScenarioSeriesTest : public ::testing::Test {
 protected:
  ScenarioSeries Read(const std::string& text) {
    return ReadScenarioSeries(folder_.Write("some.yaml", text));
  }
  std::string ErrorOf(const std::string& text) {
    return ConfigErrorOf([&] { Read(text); });
  }

  test_support::TemporaryFolder folder_;
};

/// Deltas of an axis; empty: none.
std::vector<double> Deltas(const ScenarioSeries& series, const std::string& pose,
                           const std::string& axis) {
  for (const auto& modification : series.modifications) {
    if (modification.instance != pose) continue;
    for (const auto& delta : modification.modifications) {
      if (delta.property == axis) return delta.choices;
    }
  }
  return {};
}

TEST_F(ScenarioSeriesTest, ReplaceIsListing51) {
  const ScenarioSeries series = ReadScenarioSeries(kReplace);
  EXPECT_EQ(series.name, "replace");
  ASSERT_THAT(series.groups, SizeIs(2));
  EXPECT_THAT(series.groups[0].members, ElementsAre("poseTable1", "poseTable2", "poseCounter1"));
  EXPECT_THAT(series.groups[1].members, ElementsAre("posePR21"));
  EXPECT_EQ(series.groups[0].choices * series.groups[1].choices, 9);
  EXPECT_THAT(Deltas(series, "poseTable1", "hasX"), ElementsAre(0, 0, 1));
  EXPECT_THAT(Deltas(series, "poseTable1", "hasY"), ElementsAre(0, 1.5, -2));
  EXPECT_THAT(Deltas(series, "poseTable2", "hasX"), ElementsAre(0, 0, 3));
  EXPECT_THAT(Deltas(series, "poseTable2", "hasY"), ElementsAre(0, 1.5, 1));
  EXPECT_THAT(Deltas(series, "poseCounter1", "hasX"), ElementsAre(0, 3, -1));
  EXPECT_THAT(Deltas(series, "poseCounter1", "hasY"), ElementsAre(0, -0.7, 2));
  EXPECT_THAT(Deltas(series, "poseCounter1", "hasYaw"), ElementsAre(0, -1.57, 0));
  EXPECT_THAT(Deltas(series, "posePR21", "hasX"), ElementsAre(0, -1, 0));
  EXPECT_THAT(Deltas(series, "posePR21", "hasY"), ElementsAre(0, 1, 1));
  EXPECT_THAT(Deltas(series, "posePR21", "hasYaw"), ElementsAre(0, -2, -0.43));
  for (const std::string pose : {"poseTable1", "poseTable2", "poseCounter1"}) {
    EXPECT_THAT(Deltas(series, pose, "hasZ"), ElementsAre(0, 0, 0)) << "ZOrigin is taken off";
  }
  EXPECT_THAT(series.modifications[2].attachments, ElementsAre("poseMug1", "poseMug2"));
}

TEST_F(ScenarioSeriesTest, TheOriginalFileIsRefusedByLineAndField) {
  if (!std::filesystem::exists(kOriginal)) GTEST_SKIP() << "not here: " << kOriginal;
  EXPECT_THAT(ConfigErrorOf([] { ReadScenarioSeries(kOriginal); }),
              AllOf(HasSubstr("replace.yaml: document 1, line 6"), HasSubstr("hasX"),
                    HasSubstr("2 deltas"), HasSubstr("Choices says 3")));
}

TEST_F(ScenarioSeriesTest, RunsGoThroughAllCombinationsTheFirstGroupFastest) {
  const ScenarioSeries series =
      Read(Move("poseA", "g", 2, "[0, 1]") + "---\n" + Move("poseB", "h", 3, "[0, 1, 2]"));
  EXPECT_EQ(NumCombinations(series), 6);
  const auto choices = [&](int run) { return ChoicesOfRun(series, SeriesOrder::kAll, 1, run); };
  EXPECT_THAT(choices(1), ElementsAre(0, 0));
  EXPECT_THAT(choices(2), ElementsAre(1, 0));
  EXPECT_THAT(choices(3), ElementsAre(0, 1));
  EXPECT_THAT(choices(6), ElementsAre(1, 2));
  EXPECT_THAT(choices(7), ElementsAre(0, 0));
}

TEST_F(ScenarioSeriesTest, DrawnChoicesRepeatWithTheSeedAndReachEveryCombination) {
  const ScenarioSeries series =
      Read(Move("poseA", "g", 2, "[0, 1]") + "---\n" + Move("poseB", "h", 3, "[0, 1, 2]"));
  std::set<std::vector<int>> drawn;
  bool differs = false;
  for (int run = 1; run <= 60; ++run) {
    const auto choices = ChoicesOfRun(series, SeriesOrder::kDrawn, 7, run);
    EXPECT_EQ(choices, ChoicesOfRun(series, SeriesOrder::kDrawn, 7, run));
    differs = differs || choices != ChoicesOfRun(series, SeriesOrder::kDrawn, 8, run);
    drawn.insert(choices);
  }
  EXPECT_THAT(drawn, SizeIs(6));
  EXPECT_TRUE(differs);
}

TEST_F(ScenarioSeriesTest, StartsAreTheSameForAllOrChosenByAGroup) {
  const ScenarioSeries series = Read(
      "!Scenario\nScenario: serve_coffee\nWorld: halls/hall.world\n---\n" +
      Move("poseA", "g", 2, "[0, 1]") +
      "---\n!Scenario\nGroup: g\nChoices: 2\nInstruction: [achieve a, achieve b]\nTruth: [same, "
      "ideal]\n");
  ASSERT_THAT(series.groups, SizeIs(1));
  EXPECT_THAT(series.groups[0].members, ElementsAre("poseA", "Instruction", "Truth"));
  const SeriesStart start = StartOfRun(series, {1});
  EXPECT_EQ(start.scenario, "serve_coffee");
  EXPECT_EQ(start.instruction, "achieve b");
  EXPECT_EQ(start.truth, "ideal");
  EXPECT_EQ(start.world, (folder_.path() / "halls/hall.world").string());
  EXPECT_THAT(start.places.at("Scenario"), HasSubstr("document 1"));
  EXPECT_THAT(start.places.at("Instruction"), HasSubstr("document 3"));
}

TEST_F(ScenarioSeriesTest, ErrorsSayWhereAndWhat) {
  EXPECT_THAT(ErrorOf(""), HasSubstr("some.yaml: is empty"));
  EXPECT_THAT(ErrorOf("!DemandTopic\nName: all\n"), HasSubstr("what varies"));
  EXPECT_THAT(ErrorOf("!Scenario\nTruth: same\n---\n!Scenario\nTruth: ideal\n"),
              AllOf(HasSubstr("document 2, line 4"), HasSubstr("Truth is given already"),
                    HasSubstr("document 1, line 1")));
  EXPECT_THAT(ErrorOf(Move("poseA", "g", 2, "[0, 1]") +
                      "---\n!Scenario\nGroup: g\nChoices: 1\nTruth: [same]\n"),
              AllOf(HasSubstr("document 2"), HasSubstr("Choices is 1"), HasSubstr("'g' has 2")));
  EXPECT_THAT(ErrorOf("!Scenario\nZOrigin: 1\n---\n!Scenario\nZOrigin: 2\n"),
              AllOf(HasSubstr("document 2"), HasSubstr("ZOrigin holds for the whole file")));
  EXPECT_THAT(ErrorOf(Move("poseA", "g", 1, "[0]", "[poseB]") + "---\n" +
                      Move("poseB", "g", 1, "[0]", "[poseA]")),
              HasSubstr("poseA -> poseB -> poseA"));
}

TEST(TaskOfInstructionTest, LeavesOutWhatTheOriginalSaysMore) {
  EXPECT_EQ(TaskOfInstruction("achieve serve_coffee_to_guest_Task guest1"),
            "serve_coffee_to_guest guest1");
  EXPECT_EQ(TaskOfInstruction("  serve_coffee_to_guest   guest1 "), "serve_coffee_to_guest guest1");
  EXPECT_EQ(TaskOfInstruction("achieve"), "");
  EXPECT_EQ(TaskOfInstruction("_Task x"), "_Task x");
}

}  // namespace
}  // namespace hires::lab::scenario_series_test
