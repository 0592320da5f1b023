#include "hires/ros/imagination/trace_markers.h"

#include <gtest/gtest.h>

#include "hires/imagination/imagination_setup.h"
#include "support/scene_copy.h"

namespace hires_ros::trace_markers_test {
namespace {

using hires::test_support::SceneCopy;
using visualization_msgs::Marker;

/// The marker of that name after a drive in which the stool on the tray tips and leans by 0.45 rad.
std::optional<Marker> MarkerAfterDrive(const std::string& scene, const std::string& name) {
  const auto setup =
      hires::imagination::LoadImaginationSetup(hires::imagination::ReadSetupConfig(scene));
  const auto start = hires::imagination::MakeStartState(setup, "nearStartArea1",
                                                        std::vector<std::string>{"stool1"});
  hires::simulation::RobotSimulator simulator(setup.scene, {}, start.world, start.robot,
                                              hires::base::Rng(1), setup.physics);
  TraceMarkers markers(1, setup.standing);
  for (int i = 0; i < 1500; ++i) {
    hires::robot::Command command;
    command.base_velocity = hires::geometry::Twist2{i < 500 ? 0.5 : 0.0, 0.0, 0.0};
    simulator.Send(command);
    simulator.Step();
    if (i % 50 == 0) markers.Add(simulator);
  }
  for (const Marker& marker : markers.Draw(simulator).markers) {
    if (marker.ns == "worker_1/" + name) return marker;
  }
  return {};
}

// The one line of config/scene.yaml that says what a fall is; see
// test/evaluation/one_criterion_test.
TEST(TraceMarkersTest, TheAxisIsRedOnceTheLoadHasFallenAsTheCriterionSays) {
  const auto before = MarkerAfterDrive(SceneCopy().path(), "tilt");
  const auto after = MarkerAfterDrive(
      SceneCopy(hires::test_support::kStandingLine, hires::test_support::kOtherStandingLine).path(),
      "tilt");
  ASSERT_TRUE(before && after);
  EXPECT_GT(before->color.g, 0.5f) << "orange: it leans and stands";
  EXPECT_EQ(after->color.g, 0.0f) << "red: 0.45 rad for more than 0.2 s";
  EXPECT_EQ(after->color.r, 1.0f);
}

TEST(TraceMarkersTest, TheAxisStaysOrangeWhileTheLoadLeansForLessThanTheHoldTime) {
  const auto marker = MarkerAfterDrive(
      SceneCopy(hires::test_support::kStandingLine, hires::test_support::kLongHoldStandingLine)
          .path(),
      "tilt");
  ASSERT_TRUE(marker);
  EXPECT_GT(marker->color.g, 0.5f);
}

TEST(TraceMarkersTest, TheTextSaysHowFarTheLoadLeans) {
  const auto text = MarkerAfterDrive(SceneCopy().path(), "alpha");
  ASSERT_TRUE(text);
  EXPECT_NEAR(std::stod(text->text), 0.45, 0.05);
}

}  // namespace
}  // namespace hires_ros::trace_markers_test
