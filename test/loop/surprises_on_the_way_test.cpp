#include <gmock/gmock.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/loop/task_loop.h"
#include "loop/support/task_setup.h"

namespace hires::loop::surprises_on_the_way_test {
namespace {

using evaluation::AchieveOutcome;
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

// A chair stands across the way. Before the robot sees it, imagination drives where the chair is;
// after that, it drives around it as long as the robot will.
TEST(SurprisesOnTheWayTest, AChairThatWasMovedIsInTheWorldsThatAreImagined) {
  LoopOrder order;
  order.scenario = kConfig + "scenarios/topple.yaml";
  order.truth = kData + "moved_chair.yaml";
  order.rollouts = 8;        // the fewest that can decide
  order.time_limit = 115.0;  // until the drive is over
  const LoopRun run = PlayTask(TheSetup(), order);
  EXPECT_EQ(run.truth.contact, "");
  const auto& steps = run.report.status.steps;
  const auto drive = std::find_if(steps.begin(), steps.end(), [](const auto& step) {
    return step.action.name == "move_base_param" && step.finished;
  });
  ASSERT_NE(drive, steps.end()) << run.report.reason;
  EXPECT_EQ(ToString(drive->failure), "");
  std::vector<double> imagined;  // [s] for what it did in the end
  for (const evaluation::ImaginedStep& answer : run.report.status.imaginations) {
    for (const imagination::Prediction& one : answer.predictions)
      if (one.action == drive->action) imagined.push_back(one.evidence.duration.mean);
  }
  ASSERT_GE(imagined.size(), 2u);
  const double driven = *drive->finished - *drive->started;
  EXPECT_NEAR(imagined.back(), driven, 0.15 * driven);
  EXPECT_LT(imagined.front(), 0.8 * imagined.back());
}

}  // namespace
}  // namespace hires::loop::surprises_on_the_way_test
