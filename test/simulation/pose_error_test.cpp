#include "hires/simulation/pose_error.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/base/text.h"
#include "support/messages.h"
#include "support/scenes.h"
#include "support/temporary_folder.h"

namespace hires::simulation::pose_error_test {
namespace {

using geometry::Pose2;
using hires::test_support::ConfigErrorOf;
using testing::HasSubstr;

const std::string kConfig = HIRES_SOURCE_DIR "/config";

PoseErrorParams Params() {
  PoseErrorParams params;
  params.kept << 0.8, 0.1, 0.0, -0.1, 0.9, 0.0, 0.0, 0.0, 0.7;
  params.added << 2e-4, 5e-5, 0.0, 5e-5, 1e-4, 2e-5, 0.0, 2e-5, 4e-5;
  params.start << 4e-4, 0.0, 0.0, 0.0, 1e-4, 0.0, 0.0, 0.0, 1e-4;
  return params;
}

Eigen::Vector3d VectorOf(const Pose2& X) { return {X.x, X.y, X.yaw}; }

/// P = A G P G' A' + W, where G is what a way ahead [m] makes of an error: who heads wrongly comes
/// off to the side.
Eigen::Matrix3d Stationary(const PoseErrorParams& params, double way) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(1, 2) = way;
  const Eigen::Matrix3d A = params.kept * G;
  Eigen::Matrix3d P = params.added;
  for (int i = 0; i < 1000; ++i) P = A * P * A.transpose() + params.added;
  return P;
}

/// Mean of e e' over errors, which have mean 0.
class Moments {
 public:
  void Add(const Pose2& error) {
    sum_ += VectorOf(error) * VectorOf(error).transpose();
    n_ += 1.0;
  }
  Eigen::Matrix3d value() const { return sum_ / n_; }

 private:
  Eigen::Matrix3d sum_{Eigen::Matrix3d::Zero()};
  double n_{0.0};
};

TEST(PoseErrorWalkTest, ErrorsBeginAsSpreadAsIsSaid) {
  PoseErrorParams params = Params();
  params.start(0, 1) = params.start(1, 0) = 1.5e-4;
  Moments moments;
  for (std::uint64_t seed = 0; seed < 20000; ++seed)
    moments.Add(PoseErrorWalk(params, {1.0, 2.0, 0.5}, base::Rng(seed)).error());
  EXPECT_LT((moments.value() - params.start).cwiseAbs().maxCoeff(), 1e-5);  // 2.5 % of the largest
}

TEST(PoseErrorWalkTest, AfterManyCorrectionsErrorsAreThoseOfTheAutoregression) {
  const PoseErrorParams params = Params();
  const double way = 1.01 * params.update_distance;
  Moments moments;
  PoseErrorWalk walk(params, {}, base::Rng(5));
  Pose2 X_MB;
  for (int i = 0; i < 200000; ++i) {
    X_MB.x += way;  // one correction each, and odometry that does not err
    walk.Drive(X_MB);
    moments.Add(walk.error());
  }
  const Eigen::Matrix3d expected = Stationary(params, way);
  EXPECT_LT((moments.value() - expected).cwiseAbs().maxCoeff(), 0.04 * expected.maxCoeff());
}

TEST(PoseErrorWalkTest, BetweenCorrectionsTheErrorIsThatOfTheOdometry) {
  PoseErrorParams params;  // a correction takes all of it away
  params.stretch = 0.1;
  PoseErrorWalk walk(params, {1.0, 0.0, 0.0}, base::Rng(3));
  walk.Drive({1.1, 0.0, 0.0});
  const double told_too_long = walk.error().x;
  EXPECT_NE(told_too_long, 0.0);
  EXPECT_LT(std::abs(told_too_long), 0.04);  // four deviations
  walk.Drive({1.15, 0.0, 0.0});
  EXPECT_NEAR(walk.error().x, 1.5 * told_too_long, 1e-12);
  EXPECT_NEAR(walk.X_OB().x, 0.15 + walk.error().x, 1e-12);
  EXPECT_NEAR(walk.X_MBelieved().x, 1.15 + walk.error().x, 1e-12);
  walk.Drive({1.4, 0.0, 0.0});
  EXPECT_EQ(walk.error().x, 0.0);
}

TEST(PoseErrorWalkTest, AnErrorIsTurnedWithTheRobot) {
  PoseErrorParams params = Params();
  params.update_turn = 10.0;
  PoseErrorWalk walk(params, {}, {0.1, 0.0, 0.0}, base::Rng(1));
  walk.Drive({0.0, 0.0, M_PI / 2.0});
  EXPECT_NEAR(walk.error().x, 0.0, 1e-12);
  EXPECT_NEAR(walk.error().y, -0.1, 1e-12);
  EXPECT_NEAR(walk.X_MBelieved().x, 0.1, 1e-12) << "the same place of the map";
}

TEST(PoseErrorWalkTest, AtRestNothingChangesAndACopyGoesOnAlike) {
  PoseErrorParams params = Params();
  params.walk = 0.01;
  PoseErrorWalk walk(params, {}, base::Rng(2));
  for (int i = 1; i < 50; ++i) walk.Drive({0.03 * i, 0.0, 0.01 * i});
  const Eigen::Vector3d error = VectorOf(walk.error());
  PoseErrorWalk copy = walk;
  walk.Drive({0.03 * 49, 0.0, 0.01 * 49});
  EXPECT_EQ(VectorOf(walk.error()), error);
  for (int i = 50; i < 90; ++i) {
    walk.Drive({0.03 * i, 0.0, 0.01 * i});
    copy.Drive({0.03 * i, 0.0, 0.01 * i});
  }
  EXPECT_EQ(VectorOf(walk.error()), VectorOf(copy.error()));
  EXPECT_NE(VectorOf(walk.error()), error);
}

TEST(PoseErrorFileTest, WhatIsWrittenIsRead) {
  test_support::TemporaryFolder folder;
  PoseErrorFile file{Params(), "00000000000000ab"};
  file.params.stretch = 0.01;
  file.params.walk = 0.002;
  file.params.walk_yaw = 0.003;
  const PoseErrorFile read = ReadPoseError(folder.Write("error.yaml", ToYaml(file)));
  EXPECT_EQ(ToYaml(read), ToYaml(file));
  EXPECT_EQ(read.params.kept(1, 0), -0.1);
  EXPECT_EQ(read.hash, "00000000000000ab");
}

TEST(PoseErrorFileTest, WhatCannotBeIsRefusedWithItsKey) {
  test_support::TemporaryFolder folder;
  const auto why_refused = [&](const std::string& from, const std::string& to) {
    std::string text = ToYaml({Params(), "ab"});
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const std::string path = folder.Write("error.yaml", text);
    return ConfigErrorOf([&] { ReadPoseError(path); });
  };
  EXPECT_THAT(why_refused("ahead: [0.8", "ahead: [1.2"), HasSubstr("kept"));
  EXPECT_THAT(why_refused("left: [5e-05", "left: [4e-05"), HasSubstr("added"));
  EXPECT_THAT(why_refused("left: [0, 0.0001", "left: [0, -0.0001"), HasSubstr("start"));
  EXPECT_THAT(why_refused("left: [5e-05, 0.0001, 2e-05]", "left: [5e-05, 0.0001]"),
              HasSubstr("added.left"));
  EXPECT_THAT(why_refused("turn: [0, 0, 0.7]", "turn: [0, 0, 70]"), HasSubstr("kept.turn"));
  EXPECT_THAT(why_refused("walk: 0", "walk: -1"), HasSubstr("walk"));
  EXPECT_THAT(why_refused("stretch: 0", "strech: 0"), HasSubstr("'strech' is unknown"));
}

class PlaceHashTest : public testing::Test {
 protected:
  /// The shipped files, in one of which a text is replaced.
  std::string Copy(const std::string& name, const std::string& from, const std::string& to) {
    for (const char* file :
         {"self_localisation.yaml", "localisation.yaml", "odometry_filter.yaml"}) {
      std::string text = base::ReadTextFile(kConfig + "/" + file);
      if (file == name) {
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
      }
      folder_.Write(file, text);
    }
    return (folder_.path() / "self_localisation.yaml").string();
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(PlaceHashTest, IsOfMapAndFiltersAlone) {
  const world::World room = test_support::Room();
  const std::string hash = PlaceHash(kConfig + "/self_localisation.yaml", room, 0.3);
  EXPECT_EQ(PlaceHash(Copy("none", "", ""), room, 0.3), hash) << "wherever they lie";
  world::World more = room;
  more.frames["there"] = {};
  EXPECT_EQ(PlaceHash(Copy("none", "", ""), more, 0.3), hash) << "an area is no wall";
  more.statics.push_back(test_support::Block("box", {0.3, 0.3, 0.6}, {1.0, 1.0, 0.3}));
  EXPECT_NE(PlaceHash(Copy("none", "", ""), more, 0.3), hash);
  EXPECT_NE(
      PlaceHash(Copy("localisation.yaml", "update_min_d: 0.2", "update_min_d: 0.3"), room, 0.3),
      hash);
  EXPECT_NE(PlaceHash(Copy("self_localisation.yaml", "wear: 0.01", "wear: 0.02"), room, 0.3), hash);
  const auto no_file = [&] { PlaceHash("/nowhere/self_localisation.yaml", room, 0.3); };
  EXPECT_THAT(ConfigErrorOf(no_file), HasSubstr("/nowhere/self_localisation.yaml"));
}

}  // namespace
}  // namespace hires::simulation::pose_error_test
