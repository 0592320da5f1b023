// Two roads: a world that is read in parts equals the one that is read at once.
#include "world/world_parts.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <sdf/Model.hh>
#include <sdf/World.hh>

#include "hires/base/error.h"
#include "hires/base/progress.h"
#include "hires/base/text.h"
#include "world/load_world_in_parts.h"
#include "world/resource_finder.h"
#include "world/sdf_file.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::world_parts_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::size_t kAtOnce = 100000;
const std::string kWorlds = HIRES_SOURCE_DIR "/worlds";

/// All numbers to their last bit.
std::string Bits(const geometry::Pose3& pose) {
  const auto& p = pose.translation;
  const auto& q = pose.rotation;
  return fmt::format("{:a} {:a} {:a} {:a} {:a} {:a} {:a}", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(),
                     q.z());
}

std::vector<std::string> Described(const World& world) {
  std::vector<std::string> lines{fmt::format("{} {:x} {:a} {:a}", world.name, world.hash,
                                             world.gravity, world.floor_friction)};
  for (const StaticBody& body : world.statics) {
    lines.push_back(fmt::format("{} {}", body.name, Bits(body.X_MB)));
    for (const auto& part : body.collisions) lines.push_back(part.name + " " + Bits(part.X_BS));
  }
  for (const ObjectState& object : world.initial.objects) {
    lines.push_back(fmt::format("{} is a {} {}", object.name, object.model, Bits(object.X_MO)));
  }
  for (const auto& [name, model] : world.models) lines.push_back(name + " " + model->name);
  for (const auto& [name, X_MF] : world.frames) {
    lines.push_back(fmt::format("{} {} {}", name, world.frame_names.at(name), Bits(X_MF)));
  }
  return lines;
}

void ExpectTheSameInParts(const std::string& path) {
  const std::vector<std::string> at_once = Described(LoadWorldInParts(path, {}, kAtOnce));
  ASSERT_GT(CutWorld(base::ReadTextFile(path), 1).size(), 2u);
  for (const std::size_t models_per_part : {1, 2, 5}) {
    EXPECT_EQ(Described(LoadWorldInParts(path, {}, models_per_part)), at_once) << models_per_part;
  }
}

TEST(WorldPartsTest, TheRestaurantIsTheSameInParts) {
  ExpectTheSameInParts(kWorlds + "/restaurant.world");
}

class WorldPartsFileTest : public testing::Test {
 protected:
  std::string Write(const std::string& content) const {
    return folder_.Write("test.world", WorldText(content));
  }
  std::string WriteBoxes(int number) const {
    std::string boxes;
    for (int i = 0; i < number; ++i) {
      boxes += StaticModel("box_" + std::to_string(i), LinkWithShape(kUnitBox));
    }
    return Write(boxes);
  }
  void WriteMug() const {
    folder_.Write("models/mug/model.config", ModelConfig("mug"));
    folder_.Write("models/mug/model.sdf", ModelFile(LooseCube("mug", "1 2 3 0 0 0.5")));
  }

  TempFolder folder_;
};

TEST_F(WorldPartsFileTest, WhatCountsFromElsewhereIsWhereItWas) {
  WriteMug();
  ExpectTheSameInParts(Write(
      StaticModel("first", "<pose>0.1 0.2 0 0 0 0.3</pose>" + LinkWithShape(kUnitBox)) +
      StaticModel("base", "<pose>1 2 0.7 0 0 0.9</pose>" + LinkWithShape(kUnitBox)) +
      StaticModel("shelf",
                  "<pose relative_to='base'>0 0.3 0 0 0 0.1</pose>" + LinkWithShape(kUnitBox)) +
      StaticModel("top", "<pose relative_to='shelf'>0 0 1 0 0 0</pose>" + LinkWithShape(kUnitBox)) +
      "<frame name='dock' attached_to='base::body'><pose>0.7 0.1 0 0 0 0</pose></frame>"
      "<frame name='beside' attached_to='dock'><pose>0.3 0 0 0 0 1</pose></frame>"
      "<include><uri>model://mug</uri></include>"
      "<frame name='atArea' attached_to='world'><pose>4 5 0 0 0 0.2</pose></frame>" +
      StaticModel("atFrame",
                  "<pose relative_to='beside'>1 0 0 0 0 0</pose>" + LinkWithShape(kUnitBox)) +
      "<include><uri>model://mug</uri><name>far</name><pose>4 5 6 0 0 1</pose></include>" +
      LooseCube("absolute", "0 0 0 0 0 0")));
}

TEST_F(WorldPartsFileTest, KindsAreNamedByTheOrderOfTheFile) {
  WriteMug();
  std::string other = LooseCube("mug");
  other.replace(other.find("<mass>1<"), 8, "<mass>2<");
  // What the pose of `box` counts from is read with the first part, though it stands behind others.
  const std::string path =
      Write("<include><uri>model://mug</uri><name>a</name></include>" + LooseCube("cube") + other +
            StaticModel("box", "<pose relative_to='mug'/>" + LinkWithShape(kUnitBox)));
  EXPECT_EQ(LoadWorldInParts(path, {}, 1).initial.Find("a")->model, "mug");
  EXPECT_EQ(LoadWorldInParts(path, {}, 1).initial.Find("mug")->model, "mug_2");
  ExpectTheSameInParts(path);
}

TEST_F(WorldPartsFileTest, EachPartIsGoneBeforeTheNextIsRead) {
  const std::string path = WriteBoxes(1000);
  std::weak_ptr<sdf::Element> before;
  std::size_t num_models = 0;
  LoadNotes notes;
  const SdfFiles files = ReadWorldFiles(path, ResourceFinder({}), &notes);
  ReadSdfWorld(files, path, 64, &notes, [&](const SdfWorldPart& part) {
    EXPECT_LE(part.world.ModelCount(), 64u);
    EXPECT_TRUE(before.expired()) << "after " << num_models << " models";
    if (part.world.ModelCount() > 0) before = part.world.ModelByIndex(0)->Element();
    num_models += part.world.ModelCount();
  });
  EXPECT_EQ(num_models, 1000u);
}

TEST_F(WorldPartsFileTest, ALargeWorldIsReadInPartsWithoutBeingAsked) {
  const std::string path = WriteBoxes(200);
  std::vector<double> shares;
  base::SetProgressSink([&](const std::string& task, double share) {
    EXPECT_EQ(task, "reading " + path);
    shares.push_back(share);
  });
  LoadWorld(path);
  base::SetProgressSink({});
  EXPECT_GT(shares.size(), 2u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  ASSERT_FALSE(shares.empty());
  EXPECT_EQ(shares.back(), 1.0);
}

TEST_F(WorldPartsFileTest, MessagesNameTheLineOfTheFile) {
  const auto error_of = [&](const std::string& last) {
    const std::string path =
        Write(StaticModel("one", LinkWithShape(kUnitBox)) + "<!-- a\nb -->\n" +
              StaticModel("two", LinkWithShape("<box>\n<size>1\n1 1</size></box>")) + last);
    return MessageOf<base::ConfigError>([&] { LoadWorldInParts(path, {}, 1); });
  };
  EXPECT_THAT(error_of(LooseCube("far", "0 2e6 0 0 0 0")), HasSubstr("test.world:9: model 'far'"));
  EXPECT_THAT(error_of(LooseCube("Two")),
              AllOf(HasSubstr("test.world:9: model 'Two'"), HasSubstr("test.world:6: model 'two'"),
                    HasSubstr("rename")));
  EXPECT_THAT(error_of(StaticModel("three", "<pose>here</pose>" + LinkWithShape(kUnitBox))),
              AllOf(HasSubstr("here"), HasSubstr("test.world:9")));
}

TEST_F(WorldPartsFileTest, UnusualIncludesAndLightsAreTheSameInParts) {
  WriteMug();
  folder_.Write("models/lamp/model.config", ModelConfig("lamp"));
  folder_.Write("models/lamp/model.sdf", ModelFile("<light name='l' type='point'/>"));
  ExpectTheSameInParts(Write(
      "<include><uri>model://lamp</uri></include>" + StaticModel("one", LinkWithShape(kUnitBox)) +
      StaticModel("two", LinkWithShape(kUnitBox)) +
      StaticModel("odd", "<include merge='true'><uri>model://mug</uri></include>") +
      "<include><uri>model://lamp</uri><name>again</name></include>"
      "<include><uri>model://mug</uri><pose>1 0 0 0 0 0</pose>"
      "<placement_frame>body</placement_frame></include>"));
}

TEST(WorldPartsTest, NothingIsCutThatIsSmallOrNoSingleWorld) {
  const std::string models = StaticModel("a", "") + StaticModel("b", "") + StaticModel("c", "");
  EXPECT_EQ(CutWorld(WorldText(models), 2).size(), 3u);
  EXPECT_TRUE(CutWorld(WorldText(models), 3).empty());
  EXPECT_TRUE(CutWorld(WorldText(models + "<joint name='j'/>"), 2).empty());
  EXPECT_TRUE(CutWorld(ModelFile(models), 2).empty());
  EXPECT_TRUE(CutWorld("<sdf", 2).empty());
  EXPECT_TRUE(
      CutWorld("<sdf version='1.7'><world name='a'>" + models + "</world><world name='b'/></sdf>",
               2)
          .empty());
}

}  // namespace
}  // namespace hires::world::world_parts_test
