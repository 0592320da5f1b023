#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/command_line.h"
#include "cli/command_run.h"
#include "hires/base/text.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "hires/perception/pcd_file.h"
#include "hires/world/object_catalogue.h"
#include "support/temporary_folder.h"

namespace hires::cli::recognise_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunHires;
using nlohmann::json;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

/// A coffee cup and a box that nobody knows on a table, as a camera 0.7 m above it sees them.
perception::PointCloud Breakfast(bool is_laid = true) {
  world::World world;
  const auto put = [&](const geometry::Shape& shape, const Eigen::Vector3d& p_M) {
    world.statics.emplace_back();
    world.statics.back().name = "body" + std::to_string(world.statics.size());
    world.statics.back().X_MB.translation = p_M;
    world.statics.back().collisions.emplace_back();
    world.statics.back().collisions.back().shape = shape;
  };
  put(geometry::Box{{0.9, 1.4, 0.04}}, {0.0, 0.0, 0.73});
  if (is_laid) {
    const world::ObjectModel cup =
        world::FindObjectModel("mug1", std::string(HIRES_SOURCE_DIR) + "/worlds/objects.yaml");
    put(cup.collisions[0].shape,
        Eigen::Vector3d(0.1, 0.2, 0.75) + cup.collisions[0].X_BS.translation);
    put(geometry::Box{{0.15, 0.12, 0.2}}, {0.1, -0.2, 0.85});
  }
  const perception::PinholeCamera camera =
      perception::LookAt({-0.8, 0.0, 1.45}, {0.05, 0.0, 0.75}, 640, 480, 1.0);
  perception::DepthSensorParams sensor;
  sensor.max_range = 1.6;  // before the floor, which is a larger plane
  const perception::LineOfSight sight(std::make_shared<perception::Surroundings>(world), {});
  base::Rng rng(1);
  return perception::Measure(sight.Look(camera, 5.0), camera, sensor, &rng);
}

class RecogniseCommandTest : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Write(const perception::PointCloud& cloud) const {
    perception::WriteLabelledPcd(cloud, std::vector<int>(cloud.points.size()), Path("cloud.pcd"));
    return Path("cloud.pcd");
  }
  Ended Recognise(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"recognise"};
    words.insert(words.end(), more.begin(), more.end());
    return RunHires(words);
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(RecogniseCommandTest, ACloudOfAnotherFrameIsRefused) {
  perception::PointCloud cloud = Breakfast();
  for (Eigen::Vector3f& p : cloud.points) p.z() = -p.z();
  const Ended ended = Recognise({Write(cloud)});
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.err, HasSubstr("cloud.pcd: "));
  EXPECT_THAT(ended.err, HasSubstr("points lie behind the camera; wanted an optical frame"));
  EXPECT_THAT(ended.err, HasSubstr("they are (-y, -z, x). A VIEWPOINT in the file is not applied"));
}

TEST_F(RecogniseCommandTest, WhatStandsOnTheTableIsNamed) {
  const Ended ended = Recognise({Write(Breakfast()), "--json", Path("seen.json")});
  EXPECT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("table 0.70 m below the camera"));
  EXPECT_THAT(ended.out, HasSubstr("2 things on it"));
  EXPECT_THAT(ended.out, HasSubstr("coffee_cup 0.5"));
  EXPECT_THAT(ended.out, HasSubstr("unknown"));
  const json seen = json::parse(std::ifstream(Path("seen.json")));
  EXPECT_EQ(seen["schema"], "hires/recognition");
  EXPECT_NEAR(seen["table"]["distance"].get<double>(), 0.7, 0.002);
  ASSERT_EQ(seen["things"].size(), 2u);
  const auto& cup =
      seen["things"][0]["kind"] == "coffee_cup" ? seen["things"][0] : seen["things"][1];
  EXPECT_EQ(cup["category"], "Mug");
  EXPECT_EQ(cup["alternatives"][0]["kind"], "coffee_cup_hot");
  EXPECT_NEAR(cup["size"][2].get<double>(), 0.1, 1e-6);
}

TEST_F(RecogniseCommandTest, ItSaysWhereItSaved) {
  const std::string cloud = Write(Breakfast(false));
  const auto out = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{cloud, "--labels", Path("labels.pcd")};
    words.insert(words.end(), more.begin(), more.end());
    return Recognise(words).out;
  };
  EXPECT_THAT(
      out({"--json", Path("seen.json")}),
      EndsWith("saved to " + Path("seen.json") + "\nsaved to " + Path("labels.pcd") + "\n"));
  EXPECT_THAT(out({"--json", "/dev/null"}), EndsWith("\nsaved to " + Path("labels.pcd") + "\n"))
      << "a device needs no word";
  EXPECT_THAT(out({"--json", "-"}), Not(HasSubstr("saved to"))) << "JSON and nothing else";
  EXPECT_THAT(Recognise({cloud}).out, Not(HasSubstr("saved to")));
}

TEST_F(RecogniseCommandTest, LabelsTellThingsApart) {
  const Ended ended = Recognise(
      {Write(Breakfast()), "--segment-only", "--labels", Path("labels.pcd"), "--json", "-"});
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  const json seen = json::parse(ended.out);
  ASSERT_EQ(seen["things"].size(), 2u);
  EXPECT_FALSE(seen["things"][0].contains("kind"));
  std::ifstream file(Path("labels.pcd"), std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_THAT(text, HasSubstr("FIELDS x y z label\n"));
  const std::size_t data = text.find("DATA binary\n") + 12;
  std::map<std::uint32_t, int> counts;
  for (std::size_t at = data; at + 16 <= text.size(); at += 16) {
    std::uint32_t label = 0;
    std::memcpy(&label, &text[at + 12], sizeof(label));
    ++counts[label];
  }
  EXPECT_EQ(counts.size(), 4u) << "nothing, table, two things";
  EXPECT_EQ(counts[1], seen["table"]["points"]);
  EXPECT_EQ(counts[2], seen["things"][0]["points"]);
  EXPECT_EQ(counts[3], seen["things"][1]["points"]);
}

TEST_F(RecogniseCommandTest, WhatIsUnknownSaysWhatItIsMostLike) {
  std::string text = base::ReadTextFile(HIRES_SOURCE_DIR "/config/recogniser.yaml");
  text = std::regex_replace(text, std::regex("min_quality: [0-9.]+"), "min_quality: 1.0");
  text = std::regex_replace(text, std::regex("objects: [^ \n]+"),
                            "objects: " HIRES_SOURCE_DIR "/worlds/objects.yaml");
  std::ofstream(Path("config.yaml")) << text;
  const Ended ended =
      Recognise({Write(Breakfast()), "--config", Path("config.yaml"), "--json", Path("seen.json")});
  EXPECT_THAT(ended.out, HasSubstr("unknown (nearest: coffee_cup, quality 0.8"));
  for (const auto& thing : json::parse(std::ifstream(Path("seen.json")))["things"]) {
    EXPECT_EQ(thing["kind"], "unknown");
    EXPECT_TRUE(thing["confidence"].is_null()) << "a recogniser does not know how unknown it is";
    EXPECT_LT(thing["nearest"]["quality"], 1.0);
  }
}

TEST_F(RecogniseCommandTest, AFewPointsAreNoTable) {
  perception::PointCloud few;
  few.width = 3;
  few.points = {{0.0F, 0.0F, 1.0F}, {0.2F, 0.0F, 1.0F}, {0.0F, 0.1F, 1.0F}};
  EXPECT_EQ(Recognise({Write(few)}).code, kExitUndecided);
}

TEST_F(RecogniseCommandTest, NothingIsInvented) {
  const Ended bare = Recognise({Write(Breakfast(false))});
  EXPECT_EQ(bare.code, kExitRecommended);
  EXPECT_THAT(bare.out, HasSubstr("nothing on it"));
  perception::PointCloud blind;
  blind.width = 100;
  blind.points.assign(100, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  const Ended nothing = Recognise({Write(blind)});
  EXPECT_EQ(nothing.code, kExitUndecided);
  EXPECT_THAT(nothing.out, HasSubstr("no point of the cloud was measured: no table is seen"));
}

TEST_F(RecogniseCommandTest, WhatCannotBeToldIsNotCalledNothing) {
  const perception::PointCloud dense = Breakfast();
  perception::PointCloud sparse;
  for (std::size_t i = 0; i < dense.points.size(); i += 29)
    sparse.points.push_back(dense.points[i]);
  sparse.width = static_cast<int>(sparse.points.size());
  sparse.height = 1;
  const Ended ended = Recognise({Write(sparse)});
  EXPECT_EQ(ended.code, kExitUndecided);
  EXPECT_THAT(ended.out, HasSubstr("table 0.70 m below the camera"));
  EXPECT_THAT(ended.out, HasSubstr("it cannot be told what is on it"));
  EXPECT_THAT(ended.out, HasSubstr("points over it tell no thing: they are too few for their "
                                   "distance, or scatter too much; take a cloud from nearer"));
  EXPECT_THAT(ended.out, Not(HasSubstr("nothing")));
}

TEST_F(RecogniseCommandTest, ACloudWithoutPointsIsCalledEmpty) {
  const Ended empty = Recognise({Write({}), "--json", Path("seen.json")});
  EXPECT_EQ(empty.code, kExitBadInput) << "there was nothing to look at";
  EXPECT_THAT(empty.err, HasSubstr("cloud.pcd: is an empty cloud, of no points; wanted one with "
                                   "points: record it again while the camera sends clouds"));
  EXPECT_FALSE(std::filesystem::exists(Path("seen.json")));
  const Ended nothing = Recognise({folder_.Write("none.pcd", "")});
  EXPECT_EQ(nothing.code, kExitBadInput);
  EXPECT_THAT(nothing.err, HasSubstr("none.pcd: is an empty file; wanted a cloud"));
}

TEST_F(RecogniseCommandTest, BadInputIsRefused) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& said) {
    const Ended ended = Recognise(words);
    EXPECT_EQ(ended.code, kExitBadInput);
    EXPECT_THAT(ended.err, HasSubstr(said));
    EXPECT_EQ(ended.out, "");
  };
  const std::string cloud = Write(Breakfast());
  refused({Path("none.pcd")}, "none.pcd: no such file");
  refused({std::string(HIRES_SOURCE_DIR) + "/README.md"}, "begins no line of a header");
  refused({cloud, "--objects", Path("none.yaml")}, "none.yaml");
  refused({cloud, "--json", Path("none/seen.json")}, "none");
  refused({cloud, "--labels", Path("none/out.pcd")}, "none");
  refused({cloud, "--labels", folder_.path().string()}, "it is a folder");
  refused({cloud, "--labels", "-"}, "is no file");
  refused({cloud, "--labels", cloud}, "would write over the cloud");
  refused({cloud, "--json", cloud}, "would write over the cloud");
  refused({cloud, "--json", Path("a"), "--labels", Path("a")}, "name two files");
  for (const auto& [factor, question] :
       {std::pair<float, const char*>{1000.0F, "are these millimetres? Divide them by 1000"},
        {100.0F, "are these centimetres? Divide them by 100"}}) {
    perception::PointCloud other = Breakfast();
    for (Eigen::Vector3f& p : other.points) p *= factor;
    refused({Write(other)}, question);
  }
  std::ofstream(Path("config.yaml"))
      << "objects: " << HIRES_SOURCE_DIR << "/worlds/objects.yaml\ncategories: {coffee_cup: Mug}\n";
  refused({cloud, "--config", Path("config.yaml")}, "block `concepts` of the catalogue");
}

}  // namespace
}  // namespace hires::cli::recognise_command_test
