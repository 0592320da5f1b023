#include <fmt/format.h>
#include <gmock/gmock.h>

#include "loop/support/task_setup.h"
#include "loop/task_loop.h"
#include "support/temporary_folder.h"

namespace hires::loop::hot_coffee_test {
namespace {

using test_support::kConfig;
using test_support::StandsOnTable1;
using test_support::TheSetup;
using testing::HasSubstr;

/// The scenario hot_coffee with other temperatures [K], which none but the world is told of.
LoopRun ServeHotCoffee(const std::string& sensing, double mug1, double mug2) {
  const std::string knowledge = kConfig + "knowledge/";
  const test_support::TemporaryFolder folder;
  LoopOrder order;
  order.scenario = folder.Write(
      "hot_coffee.yaml",
      fmt::format("task: serve_hot_coffee_to_guest guest1\n"
                  "knowledge: [{0}restaurant.yaml, {0}two_coffees.yaml]\n"
                  "robot:\n"
                  "  pose: [12.5, 9.8, 2.0]\n"
                  "  torso: torsodownposture\n"
                  "  arms: {{leftarm1: armuntuckedposture, rightarm1: armuntuckedposture}}\n"
                  "objects:\n"
                  "  - {{name: mug1, pose: [5.37, 10.26, 0.75, 0.0], temperature: {1}}}\n"
                  "  - {{name: mug2, pose: [5.37, 9.94, 0.75, 0.0], temperature: {2}}}\n",
                  knowledge, mug1, mug2));
  order.sensing = sensing;
  return PlayTask(TheSetup(), order);
}

void ExpectServed(const LoopRun& run, const std::string& served, const std::string& left) {
  ASSERT_EQ(run.report.outcome, AchieveOutcome::kSucceeded) << run.report.reason;
  EXPECT_TRUE(StandsOnTable1(run, served));
  EXPECT_GT(run.truth.objects.at(served).X_MO.translation.x(), 7.0);
  EXPECT_NEAR(run.truth.objects.at(left).X_MO.translation.x(), 5.37, 0.02);  // on the counter
}

/// The first by name is the cold one: whoever takes that without looking serves the wrong one.
/// loop_hot_mug_test.py plays it the other way round, with nodes.
TEST(HotCoffeeTest, OfTwoMugsThatOneIsServedThatTheThermalCameraSeesToBeHot) {
  ExpectServed(ServeHotCoffee("pictures", 293.15, 335.65), "mug2", "mug1");
}

TEST(HotCoffeeTest, OfTwoMugsThatAreBothSeenToBeColdNoneIsServed) {
  const LoopRun run = ServeHotCoffee("pictures", 293.15, 303.15);
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kNoPlan) << run.report.reason;
}

TEST(HotCoffeeTest, WhereNobodyMeasuresHowWarmTheyAreTheTaskFailsAndSaysWhy) {
  const LoopRun run = ServeHotCoffee("fitted", 293.15, 335.65);
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kFailed);
  EXPECT_THAT(run.report.reason, HasSubstr("temperatureknown"));
  for (const char* mug : {"mug1", "mug2"})
    EXPECT_NEAR(run.truth.objects.at(mug).X_MO.translation.x(), 5.37, 0.02) << mug;
}

}  // namespace
}  // namespace hires::loop::hot_coffee_test
