#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <stdexcept>

#include "hires/base/error.h"
#include "loop/support/task_setup.h"
#include "loop/task_loop.h"
#include "support/temporary_folder.h"

namespace hires::loop::surprises_on_the_way_test {
namespace {

using test_support::kConfig;
using test_support::TheSetup;
using testing::EndsWith;

const std::string kData = HIRES_SOURCE_DIR "/test/data/loop/";

// Somebody said that something stands there, about where and about how large, and not what: its
// box, as the camera measures it, is what the hand needs. Nobody told of another mug and of a chair
// that stands in the way.
TEST(SurprisesOnTheWayTest, AThingOfNoKnownKindIsBroughtByItsBox) {
  LoopOrder order;
  order.scenario = kData + "unknown_thing.yaml";
  order.truth = kData + "moved_chair.yaml";
  order.sensing = "pictures";
  order.imagination = "off";
  const LoopRun run = PlayTask(TheSetup(), order);
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kSucceeded) << run.report.reason;
  EXPECT_EQ(run.truth.contact, "");
  const simulation::ObjectFate& box = run.truth.objects.at("box1");
  EXPECT_TRUE(box.stands && std::abs(box.X_MO.translation.z() - 0.73) < 0.02);
  for (const char* other : {"mug1", "mug9"})
    EXPECT_TRUE(run.truth.objects.at(other).stands) << other;
  EXPECT_THAT(run.truth_name, EndsWith(", sensing pictures"));
  order.sensing = "guessed";
  EXPECT_THROW(PlayTask(TheSetup(), order), base::ConfigError);
}

struct Drive {
  execution::StepStatus step;
  std::vector<double> imagined;  // [s] each time, for what it did in the end
  double lasted() const { return *step.finished - *step.started; }
};

/// The drive with the load, until it is over.
Drive DriveOf(const LoopRun& run) {
  const auto& steps = run.report.status.steps;
  const auto found = std::find_if(steps.begin(), steps.end(), [](const auto& step) {
    return step.action.name == "move_base_param" && step.finished;
  });
  if (found == steps.end()) throw std::runtime_error("no drive: " + run.report.reason);
  Drive drive{*found, {}};
  for (const ImaginedStep& answer : run.report.status.imaginations) {
    for (const imagination::Prediction& one : answer.predictions)
      if (one.action == found->action) drive.imagined.push_back(one.evidence.duration.mean);
  }
  return drive;
}

LoopOrder Toppling(const std::string& scenario) {
  LoopOrder order;
  order.scenario = scenario;
  order.rollouts = 8;        // the fewest that can decide
  order.time_limit = 130.0;  // until the drive is over
  return order;
}

void ExpectDrivenAsImagined(const LoopRun& run) {
  EXPECT_EQ(run.truth.contact, "");
  const Drive drive = DriveOf(run);
  EXPECT_EQ(ToString(drive.step.failure), "");
  ASSERT_GE(drive.imagined.size(), 2u);
  EXPECT_NEAR(drive.imagined.back(), drive.lasted(), 0.15 * drive.lasted());
  EXPECT_LT(drive.imagined.front(), 0.8 * drive.imagined.back());
}

// A chair stands across the way. Before the robot sees it, imagination drives where the chair is;
// after that, it drives around it as long as the robot will.
TEST(SurprisesOnTheWayTest, AChairThatWasMovedIsInTheWorldsThatAreImagined) {
  LoopOrder order = Toppling(kConfig + "scenarios/topple.yaml");
  order.truth = kData + "moved_chair.yaml";
  ExpectDrivenAsImagined(PlayTask(TheSetup(), order));
}

// A box that is lower than the laser of the base looks; that which nods sees it. Where it stands
// nobody can drive to the north of the table any more, and the south serves as well.
TEST(SurprisesOnTheWayTest, ALowBoxOnTheFloorIsInTheWorldsThatAreImagined) {
  LoopOrder order = Toppling(kData + "low_box.yaml");
  order.rollouts = 64;
  order.time_limit = 300.0;
  const LoopRun run = PlayTask(TheSetup(), order);
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kSucceeded) << run.report.reason;
  EXPECT_EQ(run.truth.contact, "");
  const Eigen::Vector3d p_M = run.truth.objects.at("crate1").X_MO.translation;
  EXPECT_LT((p_M - Eigen::Vector3d(6.3, 11.43, 0.0)).norm(), 0.01) << p_M.transpose();
  std::vector<std::pair<ImaginedOutcome, std::string>> answers;  // and where to
  for (const ImaginedStep& one : run.report.status.imaginations)
    answers.emplace_back(one.outcome, one.action.alternatives.at(0).at(0));
  using testing::Pair;
  ASSERT_GE(answers.size(), 3u);
  EXPECT_THAT(answers.front(), Pair(ImaginedOutcome::kRanked, "premanipulationareanorthtable1"));
  EXPECT_THAT(answers, testing::Contains(
                           Pair(ImaginedOutcome::kAllFailed, "premanipulationareanorthtable1")));
  EXPECT_THAT(answers.back(), Pair(ImaginedOutcome::kRanked, "premanipulationareasouthtable1"));
}

// What is told of things is not enough to serve them: nothing fits so well that it is recognised.
TEST(SurprisesOnTheWayTest, WithoutRecognitionNothingIsBroughtByPictures) {
  const test_support::TemporaryFolder folder;
  YAML::Node recogniser = YAML::LoadFile(kConfig + "recogniser.yaml");
  recogniser["recognition"]["min_quality"] = 1.0;
  YAML::Node loop = YAML::LoadFile(kConfig + "loop.yaml");
  for (auto entry : loop) {
    if (entry.second.IsScalar() && entry.first.Scalar() != "planning_time")
      entry.second = kConfig + entry.second.Scalar();
  }
  loop["recogniser"] = folder.Write("recogniser.yaml", YAML::Dump(recogniser));
  const LoopSetup blind(folder.Write("loop.yaml", YAML::Dump(loop)));
  LoopOrder order;
  order.scenario = kConfig + "scenarios/topple.yaml";
  order.sensing = "pictures";
  order.imagination = "off";
  EXPECT_EQ(PlayTask(TheSetup(), order).report.outcome, AchieveOutcome::kSucceeded);
  const LoopRun run = PlayTask(blind, order);
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kNoPlan) << run.report.reason;
  EXPECT_NEAR(run.truth.objects.at("peppermill1").X_MO.translation.y(), 10.16, 0.01);
}

}  // namespace
}  // namespace hires::loop::surprises_on_the_way_test
