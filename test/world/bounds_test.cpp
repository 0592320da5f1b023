// Files that would take memory or time without end: refused by name, or read, within a second.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "geometry/mesh_pieces.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/world/world.h"
#include "support/messages.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::bounds_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BoundsTest : public testing::Test {
 protected:
  BoundsTest() {
    base::SetLogSink([](base::LogLevel, const std::string&) {});
  }
  ~BoundsTest() override { base::SetLogSink({}); }

  std::string ErrorOf(const std::string& text) {
    return ConfigErrorOf([&] { LoadWorld(folder_.Write("test.world", text)); });
  }
  /// A model that includes others, `times` each.
  void WriteIncluder(const std::string& name, const std::string& included, int times) {
    std::string content;
    for (int i = 0; i < times; ++i) {
      content +=
          fmt::format("<include><uri>model://{}</uri><name>i{}</name></include>", included, i);
    }
    folder_.Write("models/" + name + "/model.config", ModelConfig(name));
    folder_.Write("models/" + name + "/model.sdf", ModelFile(StaticModel(name, content)));
  }

  TempFolder folder_;
};

TEST_F(BoundsTest, EntitiesAreNamedAndNotPutIn) {
  std::string declared = "<!DOCTYPE x [<!ENTITY a0 'ha'>\n";
  for (int i = 1; i < 12; ++i) {
    declared += fmt::format("<!ENTITY a{} '", i);
    for (int k = 0; k < 10; ++k) declared += fmt::format("&a{};", i - 1);
    declared += "'>\n";
  }
  const std::string box = StaticModel("m&a11;", LinkWithShape(kUnitBox));
  EXPECT_THAT(ErrorOf(declared + "]>\n" + WorldText(box)),
              AllOf(HasSubstr("test.world:16: uses entities"), HasSubstr("&a11;"),
                    HasSubstr("xmllint --noent")));
  // Nobody minds those that are not used, and XML's own.
  const std::string path =
      folder_.Write("fine.world", "<!DOCTYPE x [<!ENTITY b 'ha'>]>\n" +
                                      WorldText(StaticModel("a &amp; b", LinkWithShape(kUnitBox))));
  EXPECT_EQ(LoadWorld(path).statics.front().name, "a & b");
}

TEST_F(BoundsTest, IncludesInACircleAreNamed) {
  WriteIncluder("a", "b", 1);
  WriteIncluder("b", "c", 1);
  WriteIncluder("c", "a", 1);
  EXPECT_THAT(ErrorOf(WorldText("<include><uri>model://a</uri></include>")),
              AllOf(HasSubstr("includes itself"), HasSubstr("a/model.sdf -> "),
                    HasSubstr("break the circle")));
}

TEST_F(BoundsTest, IncludesThatGrowWithEachLevelAreRefused) {
  for (int i = 0; i < 14; ++i) WriteIncluder(fmt::format("m{}", i), fmt::format("m{}", i + 1), 10);
  folder_.Write("models/m14/model.config", ModelConfig("m14"));
  folder_.Write("models/m14/model.sdf", ModelFile(StaticModel("m14", LinkWithShape(kUnitBox))));
  EXPECT_THAT(ErrorOf(WorldText("<include><uri>model://m0</uri></include>")),
              AllOf(HasSubstr("more than 200000 elements"), HasSubstr("includes counted")));
}

TEST_F(BoundsTest, ElementsThatNestAreRefusedByTheirLine) {
  std::string deep;
  for (int i = 0; i < 10000; ++i) deep += "<model name='m'>";
  EXPECT_THAT(ErrorOf(WorldText(deep)),
              AllOf(HasSubstr("test.world:3"), HasSubstr("nest more than 64 deep")));
}

TEST_F(BoundsTest, LongChainsOfPosesAreRefusedByTheirLine) {
  const auto chain = [](int length) {
    std::string frames;
    for (int i = 0; i < length; ++i) {
      frames +=
          fmt::format("<frame name='f{}'><pose relative_to='{}'>0.1 0 0 0 0 0</pose></frame>\n", i,
                      i == 0 ? "world" : fmt::format("f{}", i - 1));
    }
    return WorldText(frames);
  };
  EXPECT_NEAR(LoadWorld(folder_.Write("test.world", chain(100))).frames.at("f99").translation.x(),
              10.0, 1e-9);
  EXPECT_THAT(ErrorOf(chain(5000)),
              AllOf(HasSubstr("chain of"), HasSubstr("at most 100 are followed")));
  // A circle is libsdformat's to tell.
  EXPECT_THAT(ErrorOf(WorldText("<frame name='p'><pose relative_to='q'/></frame>"
                                "<frame name='q'><pose relative_to='p'/></frame>")),
              AllOf(HasSubstr("'p'"), Not(HasSubstr("followed"))));
}

TEST_F(BoundsTest, TooManyModelsOrLinksAreRefusedBeforeTheyAreRead) {
  std::string models, links;
  for (int i = 0; i < 10001; ++i)
    models += fmt::format("<include><uri>model://a</uri><name>a{}</name></include>", i);
  for (int i = 0; i < 2001; ++i) links += fmt::format("<link name='l{}'/>", i);
  EXPECT_THAT(ErrorOf(WorldText(models)),
              AllOf(HasSubstr("<world> has 10001 models"), HasSubstr("at most 10000")));
  EXPECT_THAT(
      ErrorOf(WorldText(StaticModel("m", links))),
      AllOf(HasSubstr("test.world:3"), HasSubstr("<model> has 0 models, 0 frames and 2001")));
}

TEST_F(BoundsTest, OfThousandsOfThingsFiftyAreListed) {
  std::string unknown, missing;
  for (int i = 0; i < 9000; ++i) {
    unknown += fmt::format("<x{}/>", i);
    missing += fmt::format("<include><uri>model://gone{}</uri></include>", i);
  }
  const World world = LoadWorld(folder_.Write("test.world", WorldText(unknown)));
  ASSERT_EQ(world.notes.size(), 51u);
  EXPECT_EQ(world.notes.back(), "and 8950 more");
  const std::string error = ErrorOf(WorldText(missing));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 51);
  EXPECT_THAT(error, AllOf(HasSubstr("'model://gone0'"), HasSubstr("and 8950 more")));
}

TEST_F(BoundsTest, AFileLongNameIsCutInTheMessage) {
  const std::string error = ErrorOf(
      WorldText("<include><uri>model://" + std::string(4'000'000, 'a') + "</uri></include>"));
  EXPECT_LT(error.size(), 10'000u);
  EXPECT_THAT(error, HasSubstr("test.world:3: 'model://aaa"));
}

TEST(MeshBoundsTest, TensOfThousandsOfHollowPartsAreToldApart) {
  geometry::TriangleMesh mesh;
  const auto add = [&](const Eigen::Vector3d& p, double size, bool is_inward) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(p);
    for (int axis = 0; axis < 3; ++axis)
      mesh.vertices.emplace_back(p + size * Eigen::Vector3d::Unit(axis));
    for (std::array<int, 3> t : {std::array<int, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
      if (is_inward) std::swap(t[1], t[2]);
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  };
  constexpr int kPairs = 10'000;
  for (int i = 0; i < kPairs; ++i) {
    const Eigen::Vector3d p(i % 100, i / 100, 0.0);
    add(p, 0.8, false);
    add(p + Eigen::Vector3d::Constant(0.05), 0.2, true);
    add(p + Eigen::Vector3d(0.0, 0.0, 2.0), 0.2, true);  // round which nothing is
  }
  EXPECT_EQ(geometry::ConnectedParts(mesh).size(), 2u * kPairs);
}

}  // namespace
}  // namespace hires::world::bounds_test
