// Two roads: what is read quickly equals what sdf::readFile makes of the same file.
#include "world/quick_sdf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sdf/Collision.hh>
#include <sdf/Frame.hh>
#include <sdf/Geometry.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/World.hh>
#include <thread>

#include "base/files/model_folders.h"
#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/world/object_catalogue.h"
#include "world/sdf_file.h"
#include "world/sdf_model.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::quick_sdf_test {
namespace {

using testing::HasSubstr;

const std::string kWorlds = HIRES_SOURCE_DIR "/worlds";

/// All numbers to their last bit.
std::string Bits(const geometry::Pose3& pose) {
  const auto& p = pose.translation;
  const auto& q = pose.rotation;
  return fmt::format("{:a} {:a} {:a} {:a} {:a} {:a} {:a}", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(),
                     q.z());
}

ResourceFinder FinderFor(const std::string& path) {
  return ResourceFinder(base::ModelFoldersFor(path, {}));
}

/// By libsdformat alone, from the whole file.
sdf::Root ReadStraight(const std::string& path) {
  const ResourceFinder finder = FinderFor(path);
  sdf::ParserConfig config;
  config.SetFindCallback([&](const std::string& uri) { return finder.FindModel(uri, uri, path); });
  sdf::Root root;
  const sdf::Errors errors = root.Load(path, config);
  EXPECT_TRUE(errors.empty()) << (errors.empty() ? "" : errors[0].Message());
  return root;
}

sdf::Root ReadQuickly(const std::string& path) {
  LoadNotes notes;
  auto root = ReadSdf(path, FinderFor(path), &notes);
  notes.ThrowIfProblems(path);
  return std::move(root.value());
}

/// What a model comes to: its pose, and where its shapes are.
void Describe(const sdf::Model& model, const std::string& indent, std::vector<std::string>* lines) {
  lines->push_back(fmt::format("{}{} {} {} {}", indent, PlaceOf(model.Element()), model.Name(),
                               model.Static(), Bits(PoseIn(model.SemanticPose(), "", "model"))));
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const sdf::Link& link = *model.LinkByIndex(i);
    lines->push_back(fmt::format("{} {} {} {}", indent, PlaceOf(link.Element()), link.Name(),
                                 Bits(PoseIn(link.SemanticPose(), "__model__", "link"))));
    for (std::uint64_t k = 0; k < link.CollisionCount(); ++k) {
      const sdf::Collision& collision = *link.CollisionByIndex(k);
      lines->push_back(fmt::format("{}  {} {} {} {}", indent, PlaceOf(collision.Element()),
                                   collision.Name(), static_cast<int>(collision.Geom()->Type()),
                                   Bits(PoseIn(collision.SemanticPose(), "", "collision"))));
    }
  }
  for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
    Describe(*model.ModelByIndex(i), indent + " ", lines);
  }
}

std::vector<std::string> Described(const sdf::Root& root) {
  std::vector<std::string> lines;
  if (root.Model() != nullptr) Describe(*root.Model(), "", &lines);
  for (std::uint64_t w = 0; w < root.WorldCount(); ++w) {
    const sdf::World& world = *root.WorldByIndex(w);
    for (std::uint64_t i = 0; i < world.ModelCount(); ++i) {
      Describe(*world.ModelByIndex(i), "", &lines);
    }
    for (std::uint64_t i = 0; i < world.FrameCount(); ++i) {
      const sdf::Frame& frame = *world.FrameByIndex(i);
      lines.push_back(frame.Name() + Bits(PoseIn(frame.SemanticPose(), "world", "frame")));
    }
  }
  return lines;
}

void ExpectBothWaysAgree(const std::string& path) {
  EXPECT_EQ(Described(ReadQuickly(path)), Described(ReadStraight(path))) << path;
}

TEST(QuickSdfTest, TheRestaurantIsTheSame) { ExpectBothWaysAgree(kWorlds + "/restaurant.world"); }

TEST(QuickSdfTest, EveryModelIsTheSame) {
  int num_models = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kWorlds + "/models")) {
    ExpectBothWaysAgree((entry.path() / "model.sdf").string());
    ++num_models;
  }
  EXPECT_EQ(num_models, 28);
}

class QuickSdfFileTest : public testing::Test {
 protected:
  void SetUp() override { WriteModel("mug", LooseCube("mug", "1 2 3 0 0 0.5")); }

  void WriteModel(const std::string& name, const std::string& model) const {
    folder_.Write("models/" + name + "/model.config", ModelConfig(name));
    folder_.Write("models/" + name + "/model.sdf", ModelFile(model));
  }
  std::string Write(const std::string& content) const {
    return folder_.Write("test.world", WorldText(content));
  }

  TempFolder folder_;
};

TEST_F(QuickSdfFileTest, IncludesCarryNamePoseAndStaticOver) {
  const std::string path = Write(
      "<include><uri>model://mug</uri></include>"
      "<include><uri>model://mug</uri><name>far</name><pose>4 5 6.123456789 0 0 1</pose></include>"
      "<frame name='area'><pose>1 0 0 0 0 0</pose></frame>"
      "<include><uri>model://mug</uri><name>fixed</name><static>true</static>"
      "<pose relative_to='area' degrees='true'>0 0 0 0 0 90</pose></include>" +
      LooseCube("own"));
  ExpectBothWaysAgree(path);
  const World world = LoadWorld(path);
  EXPECT_EQ(world.initial.Find("far")->X_MO.translation.z(), 6.123456789);
  EXPECT_EQ(world.initial.Find("mug")->X_MO.translation.z(), 3.0);
  EXPECT_EQ(world.statics.at(0).X_MB.translation.x(), 1.0);
  EXPECT_EQ(world.statics.at(0).collisions.size(), 1u);
}

TEST_F(QuickSdfFileTest, WhatIsNotNeededChangesNothing) {
  const std::string path = Write(
      "<gui fullscreen='false'><camera name='c'><pose>1 0 0 0 0 0</pose></camera></gui>"
      "<light name='l' type='point'><diffuse>1 1 1 1</diffuse></light>"
      "<model name='m'><link name='a'><sensor name='s' type='camera'><camera><image><width>10"
      "</width><height>10</height></image><clip><near>0.1</near><far>9</far></clip></camera>"
      "</sensor><visual name='v'><geometry><box><size>1 1 1</size></box></geometry></visual>"
      "</link><link name='b'/><joint name='j' type='fixed'><parent>a</parent><child>b</child>"
      "</joint></model>");
  ExpectBothWaysAgree(path);
}

TEST_F(QuickSdfFileTest, IncludesInIncludedModelsAreFollowed) {
  // The straight way cannot: libsdformat 12 forgets where to look once it is in an included file.
  WriteModel("pair",
             "<model name='pair'><static>true</static>"
             "<include><uri>model://mug</uri><name>one</name></include>"
             "<include><uri>model://mug</uri><name>two</name></include></model>");
  const World world = LoadWorld(Write("<include><uri>model://pair</uri></include>"));
  ASSERT_EQ(world.statics.size(), 1u);
  EXPECT_EQ(world.statics[0].collisions.size(), 2u);
}

TEST_F(QuickSdfFileTest, UnusualIncludesAndOldFilesAreTheSame) {
  ExpectBothWaysAgree(
      Write("<include><uri>model://mug</uri><pose>1 0 0 0 0 0</pose>"
            "<placement_frame>body</placement_frame></include>"));
  ExpectBothWaysAgree(folder_.Write(
      "old.world", "<sdf version='1.5'><world name='w'>" + LooseCube("a") + "</world></sdf>"));
}

TEST_F(QuickSdfFileTest, MergedModelsStandWhereLibsdformatPutsThem) {
  WriteModel("pair", "<model name='pair'><link name='a'><pose>1 2 0 0 0 1</pose>" +
                         std::string("<collision name='c'><geometry>") + kUnitBox +
                         "</geometry></collision></link></model>");
  const std::string path = Write(
      "<model name='m'><static>true</static><include merge='true'><uri>model://pair</uri>"
      "<pose>0 0 3 0 0 0.5</pose></include><link name='b'><pose relative_to='a'>0 1 0 0 0 0</pose>"
      "<collision name='c'><geometry>" +
      std::string(kUnitBox) + "</geometry></collision></link></model>");
  const sdf::Root straight = ReadStraight(path);
  const sdf::Model& model = *straight.WorldByIndex(0)->ModelByIndex(0);
  const World world = LoadWorld(path);
  ASSERT_EQ(world.statics.size(), 1u);
  for (const std::string link : {"a", "b"}) {
    const auto wanted = PoseIn(model.LinkByName(link)->SemanticPose(), "__model__", link);
    const auto& shapes = world.statics[0].collisions;
    EXPECT_TRUE(std::any_of(shapes.begin(), shapes.end(), [&](const auto& shape) {
      return (shape.X_BS.translation - wanted.translation).norm() < 1e-9;
    })) << link;
  }
}

TEST_F(QuickSdfFileTest, WhatNamesPartsOfMergedModelsStandsWhereLibsdformatPutsIt) {
  const std::string shape = "<link name='l'><collision name='c'><geometry>" +
                            std::string(kUnitBox) + "</geometry></collision></link>";
  WriteModel("pair", "<model name='pair'><link name='a'><pose>1 2 0 0 0 1</pose>" +
                         std::string("<collision name='c'><geometry>") + kUnitBox +
                         "</geometry></collision></link><frame name='tip' attached_to='a'><pose>3 "
                         "0 0 0 0 0</pose></frame></model>");
  WriteModel("other", "<model name='other'>" + shape + "</model>");
  base::Rng rng(5);
  for (int i = 0; i < 10; ++i) {
    // Of two decimals, as libsdformat prints six digits of what it merges.
    const auto number = [&] { return rng.Index(600) / 100.0 - 3.0; };
    const auto pose = [&](const std::string& from) {
      return fmt::format("<pose relative_to='{}'>{} {} 0 0 0 {}</pose>", from, number(), number(),
                         number());
    };
    const std::string path = Write(
        "<model name='m'>" + pose("") + "<static>true</static><include merge='true'><uri>" +
        "model://pair</uri><name>q</name>" + pose("") + "</include><include><uri>model://other" +
        "</uri><name>r</name>" + pose("a") + "</include><model name='n'>" + pose("tip") + shape +
        "</model></model><model name='beside'><static>true</static>" + pose("m::tip") + shape +
        "</model>");
    const sdf::Root straight = ReadStraight(path);
    const sdf::World& in = *straight.WorldByIndex(0);
    const World world = LoadWorld(path);
    ASSERT_EQ(world.statics.size(), 2u);
    const auto beside = PoseIn(in.ModelByName("beside")->SemanticPose(), "", "");
    EXPECT_LT((world.statics[0].X_MB.translation - beside.translation).norm(), 1e-9);
    for (const std::string inner : {"r", "n"}) {
      const auto wanted =
          PoseIn(in.ModelByName("m")->ModelByName(inner)->SemanticPose(), "__model__", inner);
      const auto& shapes = world.statics[1].collisions;
      EXPECT_TRUE(std::any_of(shapes.begin(), shapes.end(), [&](const auto& shape_M) {
        return (shape_M.X_BS.translation - wanted.translation).norm() < 1e-9;
      })) << inner;
    }
  }
}

TEST_F(QuickSdfFileTest, WhatLibsdformatRefusesIsSaidWithItsFile) {
  for (const std::string& content :
       {std::string("<include><uri>model://mug</uri><pose>a b c</pose></include>"),
        std::string("<include><uri>model://mug</uri></include>"
                    "<include><uri>model://mug</uri></include>"),
        std::string("<frame name='f' attached_to='nowhere'/>"),
        std::string("<model name='m'><link name='a'/><frame name='g' attached_to='g'/></model>")}) {
    const std::string path = Write(content);
    EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadWorld(path); }), HasSubstr("test.world"))
        << content;
  }
}

int NumDescriptions(const sdf::ElementPtr& element) {
  int num = 1;
  for (unsigned i = 0; i < element->GetElementDescriptionCount(); ++i) {
    num += NumDescriptions(element->GetElementDescription(i));
  }
  return num;
}

TEST(SchemaForTest, DescribesEachElementThatIsUsedAndLittleElse) {
  const sdf::ElementPtr small = SchemaFor({"model", "link", "collision"});
  EXPECT_FALSE(small->HasElementDescription("world"));
  const sdf::ElementPtr model = small->GetElementDescription("model");
  ASSERT_NE(model, nullptr);
  EXPECT_FALSE(model->HasElementDescription("joint"));
  const sdf::ElementPtr joint = SchemaFor({"joint", "sensor"})
                                    ->GetElementDescription("model")
                                    ->GetElementDescription("joint");
  ASSERT_NE(joint, nullptr);
  EXPECT_TRUE(joint->HasElementDescription("sensor"));
  EXPECT_LT(10 * NumDescriptions(small),
            NumDescriptions(SchemaFor(
                {"world", "light", "visual", "sensor", "joint", "actor", "state", "population"})));
}

TEST(SchemaForTest, IsMadeOnce) {
  EXPECT_EQ(SchemaFor({"model", "visual"}), SchemaFor({"link", "visual", "collision"}));
  EXPECT_NE(SchemaFor({"model", "visual"}), SchemaFor({"model"}));
}

TEST(QuickSdfTest, SeveralThreadsReadTheSame) {
  const std::string path = kWorlds + "/restaurant.world";
  const std::uint64_t wanted = LoadWorld(path).hash;
  std::vector<std::uint64_t> hashes(4, 0);
  std::vector<std::thread> threads;
  for (std::uint64_t& hash : hashes) {
    threads.emplace_back([&hash, &path] { hash = LoadWorld(path).hash; });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(hashes, testing::Each(wanted));
}

TEST(CatalogueModelsTest, EachInstanceHasTheModelThatFindObjectModelFinds) {
  const std::string catalogue = kWorlds + "/objects.yaml";
  const auto models = LoadCatalogueModels(catalogue);
  EXPECT_EQ(models.size(), LoadObjectCatalogue(catalogue).size());
  for (const auto& [instance, model] : models) {
    EXPECT_EQ(model->name, FindObjectModel(instance, catalogue).name) << instance;
  }
  EXPECT_EQ(models.at("mug1"), models.at("coffee_cup2"));
  EXPECT_NE(models.at("mug1"), models.at("vase1"));
}

TEST(CatalogueModelsTest, RefusesAnInstanceWhoseModelIsNotThere) {
  const TempFolder folder;
  const std::string catalogue = folder.Write("objects.yaml", "mug1: coffee_cup\n");
  EXPECT_THAT(
      MessageOf<base::ConfigError>([&] { LoadCatalogueModels(catalogue); }),
      testing::AllOf(HasSubstr("objects.yaml"), HasSubstr("mug1"), HasSubstr("coffee_cup")));
}

}  // namespace
}  // namespace hires::world::quick_sdf_test
