// Two roads: what is read quickly equals what sdf::readFile makes of the same file.
#include "world/quick_sdf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sdf/parser.hh>
#include <thread>

#include "hires/base/error.h"
#include "hires/world/object_catalogue.h"
#include "world/sdf_file.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::quick_sdf_test {
namespace {

using testing::HasSubstr;

const std::string kWorlds = HIRES_SOURCE_DIR "/worlds";

std::string PlaceInTree(const sdf::ElementPtr& element) {
  return fmt::format("{} <{}>", PlaceOf(element), element->GetName());
}

/// One line for each element: where it stands, its name, attributes and value. A <pose> and a
/// <static> that come from an <include> stand there in one way and in the model in the other.
void Describe(const sdf::ElementPtr& element, const std::string& indent,
              std::vector<std::string>* lines) {
  const bool has_two_places = element->GetName() == "pose" || element->GetName() == "static";
  std::string line = indent + (has_two_places ? element->GetName() : PlaceInTree(element));
  for (const sdf::ParamPtr& attribute : element->GetAttributes()) {
    line += fmt::format(" {}={}", attribute->GetKey(), attribute->GetAsString());
  }
  if (element->GetValue() != nullptr) line += " " + element->GetValue()->GetAsString();
  if (element->GetIncludeElement() != nullptr) {
    line += " from " + element->GetIncludeElement()->Get<std::string>("uri");
  }
  lines->push_back(line);
  for (auto child = element->GetFirstElement(); child != nullptr; child = child->GetNextElement()) {
    Describe(child, indent + " ", lines);
  }
}

std::vector<std::string> Described(const sdf::ElementPtr& element) {
  std::vector<std::string> lines;
  Describe(element, "", &lines);
  return lines;
}

ResourceFinder FinderFor(const std::string& path) {
  return ResourceFinder(ModelFoldersFor(path, {}));
}

sdf::SDFPtr ReadQuickly(const std::string& path) {
  const ResourceFinder finder = FinderFor(path);
  return QuickReader(finder, CheckXmlFile(path, finder)).Read(path);
}

void ExpectBothWaysAgree(const std::string& path) {
  const sdf::Root quick = ReadSdf(path, FinderFor(path), {}, ReadingWay::kQuick);
  const sdf::Root straight = ReadSdf(path, FinderFor(path), {}, ReadingWay::kStraight);
  EXPECT_EQ(Described(quick.Element()), Described(straight.Element())) << path;
}

TEST(QuickSdfTest, TheRestaurantIsReadQuicklyAndTheSame) {
  const std::string path = kWorlds + "/restaurant.world";
  EXPECT_NE(ReadQuickly(path), nullptr);
  ExpectBothWaysAgree(path);
}

TEST(QuickSdfTest, EveryModelIsReadQuicklyAndTheSame) {
  int num_models = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kWorlds + "/models")) {
    const std::string path = (entry.path() / "model.sdf").string();
    EXPECT_NE(ReadQuickly(path), nullptr) << path;
    ExpectBothWaysAgree(path);
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
  EXPECT_NE(ReadQuickly(path), nullptr);
  ExpectBothWaysAgree(path);
  const World world = LoadWorld(path);
  EXPECT_EQ(world.initial.Find("far")->X_MO.translation.z(), 6.123456789);
  EXPECT_EQ(world.initial.Find("mug")->X_MO.translation.z(), 3.0);
  EXPECT_EQ(world.statics.at(0).X_MB.translation.x(), 1.0);
  EXPECT_EQ(world.statics.at(0).collisions.size(), 1u);
}

TEST_F(QuickSdfFileTest, EveryLargePartIsReadTheSameWay) {
  const std::string path = Write(
      "<gui fullscreen='false'><camera name='c'><pose>1 0 0 0 0 0</pose></camera></gui>"
      "<light name='l' type='point'><diffuse>1 1 1 1</diffuse></light>"
      "<model name='m'><link name='a'><sensor name='s' type='camera'><camera><image><width>10"
      "</width><height>10</height></image><clip><near>0.1</near><far>9</far></clip></camera>"
      "</sensor><visual name='v'><geometry><box><size>1 1 1</size></box></geometry></visual>"
      "</link><link name='b'/><joint name='j' type='fixed'><parent>a</parent><child>b</child>"
      "</joint></model>");
  EXPECT_NE(ReadQuickly(path), nullptr);
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

TEST_F(QuickSdfFileTest, WhatIsNotPlainIsReadStraight) {
  const std::string merged = Write(
      "<model name='m'><include merge='true'><uri>model://mug</uri>"
      "</include></model>");
  EXPECT_EQ(ReadQuickly(merged), nullptr);
  ExpectBothWaysAgree(merged);
  const std::string placed = Write(
      "<include><uri>model://mug</uri><pose>1 0 0 0 0 0</pose>"
      "<placement_frame>body</placement_frame></include>");
  EXPECT_EQ(ReadQuickly(placed), nullptr);
  ExpectBothWaysAgree(placed);
  const std::string old = folder_.Write(
      "old.world", "<sdf version='1.5'><world name='w'>" + LooseCube("a") + "</world></sdf>");
  EXPECT_EQ(ReadQuickly(old), nullptr);
  ExpectBothWaysAgree(old);
}

TEST_F(QuickSdfFileTest, MessagesAreThoseOfTheStraightWay) {
  for (const std::string& content :
       {std::string("<include><uri>model://mug</uri><pose>a b c</pose></include>"),
        std::string("<include><uri>model://mug</uri></include>"
                    "<include><uri>model://mug</uri></include>"),
        std::string("<frame name='f' attached_to='nowhere'/>"),
        std::string("<model name='m'><link name='a'/><joint name='j' type='fixed'>"
                    "<parent>a</parent><child>nothing</child></joint></model>"),
        std::string("<model name='m'><link name='a'><sensor name='s'/></link></model>")}) {
    const std::string path = Write(content);
    const auto message = [&](ReadingWay way) {
      return MessageOf<base::ConfigError>([&] { ReadSdf(path, FinderFor(path), {}, way); });
    };
    EXPECT_EQ(message(ReadingWay::kQuick), message(ReadingWay::kStraight)) << content;
    EXPECT_THAT(message(ReadingWay::kQuick), HasSubstr("test.world")) << content;
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
