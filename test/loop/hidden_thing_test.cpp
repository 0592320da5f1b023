#include <gtest/gtest.h>

#include <algorithm>

#include "loop/support/task_setup.h"
#include "loop/task_loop.h"

namespace hires::loop::hidden_thing_test {
namespace {

using test_support::kConfig;
using test_support::TheSetup;

const std::string kData = HIRES_SOURCE_DIR "/test/data/loop/";

// The robot's own pose at the counter, and the default of the plan, would see nothing of the mug.
TEST(HiddenThingTest, ThePoseThatIsImaginedToSeeBestIsLookedFrom) {
  LoopOrder order;
  order.scenario = kData + "hidden_mug.yaml";
  order.rollouts = 8;
  order.threads = 2;
  order.time_limit = 40.0;  // of the whole task no more is wanted
  const LoopRun run = PlayTask(TheSetup(), order);
  EXPECT_EQ(run.truth.contact, "");
  const auto& steps = run.report.status.steps;
  const auto look = std::find_if(steps.begin(), steps.end(), [](const auto& step) {
    return step.action.name == "observe_objects_at" && step.finished;
  });
  ASSERT_NE(look, steps.end()) << run.report.reason;
  EXPECT_EQ(ToString(look->failure), "");
  const auto& all = run.report.status.imaginations;
  const auto answer = std::find_if(all.rbegin(), all.rend(), [&](const auto& one) {
    return one.outcome == ImaginedOutcome::kRanked && one.action.name == "observe_objects_at" &&
           *one.answered <= *look->started;
  });
  ASSERT_NE(answer, all.rend());
  EXPECT_EQ(answer->predictions.size(), 12u);
  EXPECT_EQ(ToString(look->action), ToString(answer->predictions.at(answer->recommended).action));
  EXPECT_NE(look->action.arguments.back(), "default");
}

}  // namespace
}  // namespace hires::loop::hidden_thing_test
