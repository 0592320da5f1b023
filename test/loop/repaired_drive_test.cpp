#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "loop/support/task_setup.h"
#include "loop/task_loop.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

// The middle layer is lost while the robot drives as it was imagined, with the mill on its tray.
namespace hires::loop::repaired_drive_test {
namespace {

using test_support::TheSetup;

constexpr char kMill[] = "peppermill1";
constexpr char kDrive[] = "move_base_param";

/// The task begins with the drive: the mill is on the tray already.
std::string ScenarioOf(const test_support::TemporaryFolder& folder) {
  return folder.Write(
      "scenario.yaml",
      fmt::format("task: unload_tray {0} table1\n"
                  "knowledge: [{1}/config/knowledge/restaurant.yaml, "
                  "{1}/test/data/loop/mill_on_tray.yaml]\n"
                  "robot:\n  pose: [6.8, 10.1, 3.14]\n  torso: torsoupposture\n"
                  "  arms: {{leftarm1: armtuckedposture, rightarm1: armtuckedposture}}\n"
                  "objects: [{{name: {0}, pose: [6.52, 10.1, 0.3464, 0.0]}}]\nhidden: []\n",
                  kMill, HIRES_SOURCE_DIR));
}

std::vector<execution::StepStatus> DrivesOf(const LoopRun& run) {
  std::vector<execution::StepStatus> drives;
  for (const execution::StepStatus& step : run.report.status.steps) {
    if (step.action.name == kDrive && step.started) drives.push_back(step);
  }
  return drives;
}

class RepairedDriveTest : public testing::Test {
 protected:
  /// A run whose middle layer is lost at these times [s]; it ends when the drives are over.
  LoopRun Play(const std::vector<double>& losses) const {
    LoopOrder order;
    order.scenario = scenario_;
    order.seed = 2;
    order.rollouts = 8;  // the fewest that can decide
    order.threads = 2;
    order.time_limit = 70.0;
    order.middle_layer_losses = losses;
    return PlayTask(TheSetup(), order);
  }

  test_support::TemporaryFolder folder_;
  std::string scenario_{ScenarioOf(folder_)};
};

/// What was recommended last.
std::string LastRecommended(const LoopRun& run) {
  std::string last;
  for (const ImaginedStep& step : run.report.status.imaginations) {
    if (step.outcome != ImaginedOutcome::kRanked) continue;
    last = ToString(step.predictions.at(static_cast<std::size_t>(step.recommended)).action);
  }
  return last;
}

TEST_F(RepairedDriveTest, IsImaginedAtWhateverMomentTheMiddleLayerIsLost) {
  const LoopRun undisturbed = Play({});
  const auto whole = DrivesOf(undisturbed);
  ASSERT_EQ(whole.size(), 1u) << undisturbed.report.reason;
  const double begin = *whole[0].started, lasts = *whole[0].finished - begin;
  const int num_moments = test_support::IsLongRun() ? 10 : 1;
  for (int i = 1; i <= num_moments; ++i) {
    const double moment = lasts * i / (num_moments + 1);
    SCOPED_TRACE(fmt::format("lost {:.1f} s after the start of a drive of {:.1f} s", moment, lasts));
    const LoopRun run = Play({begin + moment});
    const auto drives = DrivesOf(run);
    ASSERT_EQ(drives.size(), 2u);
    EXPECT_EQ(drives[0].failure.code, base::FailureCode::kUnavailable);
    EXPECT_EQ(drives[1].note.rfind("imagined: ", 0), 0u) << drives[1].note;
    EXPECT_EQ(ToString(drives[1].action), LastRecommended(run));
    EXPECT_EQ(run.truth.objects.at(kMill).falls, 0);
  }
}

}  // namespace
}  // namespace hires::loop::repaired_drive_test
