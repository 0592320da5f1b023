#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "hires/perception/segmentation.h"
#include "perception/support/segmentation_score.h"
#include "perception/support/tabletop_scenes.h"

namespace hires::perception::learning_scenes_test {
namespace {

using test_support::ScoreOf;
using test_support::SegmentationScore;

/// Kinds of scenes, of the Object Segmentation Database. Skipped as a whole without its pictures,
/// which ctest then says of the entry (CMakeLists.txt).
class LearningScenesRegressionTest : public testing::TestWithParam<int> {};

// Weighted overlap of PCL 1.13 on the same scenes (benchmark/perception/compare_with_pcl, which has
// its parameters): Euclidean clusters 0.978, 0.511, 0.808, 0.840; LCCP 0.985, 0.962, 0.883, 0.835.
// The bound is the better of the two.
// SegmentationParams were chosen on these very 45 scenes, PCL's but for one were not. So this shows
// when segmentation becomes worse than it was here. How well it does on scenes on which nothing was
// chosen compare_with_pcl tells.
TEST_P(LearningScenesRegressionTest, OverlapStaysAboveThatOfPeersOnTheScenesOfOurParameters) {
  const std::string folder = std::string(HIRES_SHARED_DATA) + "/tabletop/learn";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto& kind = test_support::kTabletopKinds[GetParam()];
  constexpr double kBound[] = {0.985, 0.962, 0.883, 0.840};
  SegmentationScore all;
  for (int index = kind.first; index <= kind.last; ++index) {
    const auto scene = test_support::ReadTabletopScene(folder + "/learn" + std::to_string(index));
    const Segmentation out = SegmentTabletop(scene.cloud, std::nullopt, {}, base::Rng(1));
    ASSERT_TRUE(out.table.has_value()) << index;
    EXPECT_GE(test_support::ShareOfTableNear(*out.table, test_support::kTableTolerance, scene.cloud,
                                             scene.truth),
              test_support::kMinTableShare)
        << index;
    all.Add(ScoreOf(scene.truth, out.labels));
  }
  RecordProperty("weighted_overlap", std::to_string(all.WeightedOverlap()));
  EXPECT_GT(all.WeightedOverlap(), kBound[GetParam()]) << kind.name;
}

INSTANTIATE_TEST_SUITE_P(Kinds, LearningScenesRegressionTest, testing::Range(0, 4));

}  // namespace
}  // namespace hires::perception::learning_scenes_test
