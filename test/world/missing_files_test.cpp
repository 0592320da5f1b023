#include "world/files/missing_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>

#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/world/occupancy_grid.h"
#include "hires/world/world.h"
#include "support/messages.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::world::missing_files_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::Rounds;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// A closed box of that size [m], its underside on z = 0.
std::string BoxObj(double x, double y, double z) {
  return fmt::format(
      "v -{0} -{1} 0\nv {0} -{1} 0\nv {0} {1} 0\nv -{0} {1} 0\nv -{0} -{1} {2}\nv {0} -{1} {2}\n"
      "v {0} {1} {2}\nv -{0} {1} {2}\nf 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n"
      "f 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n",
      0.5 * x, 0.5 * y, z);
}

std::string MeshModel(const std::string& name, double x, const std::string& uri) {
  return fmt::format(
      "<model name='{0}'><static>true</static><pose>{1} 2 0 0 0 0</pose><link name='link'>"
      "<collision name='body'><geometry>\n<mesh><uri>{2}</uri></mesh></geometry></collision>"
      "</link></model>\n",
      name, x, uri);
}

std::string WorldText(const std::string& models) {
  return "<?xml version='1.0'?>\n<sdf version='1.7'><world name='w'>\n<model name='floor'><static>"
         "true</static><link name='l'><collision name='p'><geometry><plane><normal>0 0 1</normal>"
         "</plane></geometry></collision></link></model>\n" +
         models + "</world></sdf>";
}

class MissingFilesTest : public ::testing::Test {
 protected:
  MissingFilesTest() { ::setenv("ROS_PACKAGE_PATH", "", 1); }
};

TEST_F(MissingFilesTest, AllThatAWorldLacksIsToldAtOnceWithLineNearestAndRemedy) {
  base::Rng rng(25);
  const std::vector<std::string> known{"counter", "shelfboard", "pallet_long"};
  for (int round = 0; round < Rounds(80); ++round) {
    const TemporaryFolder folder;
    for (const std::string& name : known) {
      folder.Write("meshes/" + name + ".obj", BoxObj(1, 1, 1));
      folder.Write("models/" + name + "/model.config", "<model/>");
      folder.Write("models/" + name + "/body.obj", BoxObj(1, 1, 1));
    }
    std::string models;
    std::vector<std::vector<std::string>> wanted;
    int line = 4;
    const int num_models = 2 + rng.Index(5);
    for (int i = 0; i < num_models; ++i) {
      const std::string& name = known[rng.Index(3)];
      std::string wrong = name;
      wrong.erase(2 + rng.Index(3), 1);
      std::string uri;
      const std::string at = fmt::format("w.world:{}", line + 1);
      switch (rng.Index(4)) {
        case 0:
          uri = "meshes/" + name + ".obj";
          break;
        case 1:
          uri = "meshes/" + wrong + ".obj";
          wanted.push_back({at, uri, name + ".obj'?"});
          break;
        case 2:
          uri = "model://" + name + "/bodi.obj";
          wanted.push_back({at, uri, "models/" + name + "/bodi.obj", "body.obj'?"});
          break;
        default:
          uri = "model://" + wrong + "/body.obj";
          wanted.push_back({at, uri, "looked in ", name});
      }
      models += MeshModel(fmt::format("m{}", i), 3.0 * i, uri);
      line += 2;
    }
    if (rng.Bernoulli(0.5)) {
      models += "<include><uri>model://nowhere_at_all</uri></include>\n";
      wanted.push_back({fmt::format("w.world:{}", line), "model://nowhere_at_all"});
    }
    const std::string path = folder.Write("w.world", WorldText(models));
    if (wanted.empty()) {
      EXPECT_NO_THROW(LoadWorld(path));
      continue;
    }
    const std::string error = ConfigErrorOf([&] { LoadWorld(path); });
    const std::vector<std::string> lines = base::Split(error, '\n');
    for (std::vector<std::string> words : wanted) {
      // Of what is named several times the first place alone is told.
      const auto first = std::find_if(wanted.begin(), wanted.end(),
                                      [&](const auto& other) { return other[1] == words[1]; });
      words[0] = (*first)[0];
      const bool is_told = std::any_of(lines.begin(), lines.end(), [&](const std::string& told) {
        return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
          return told.find(word) != std::string::npos;
        });
      });
      EXPECT_TRUE(is_told) << base::Join(words, " | ") << "\nin\n" << error;
    }
  }
}

TEST_F(MissingFilesTest, MeshesThatAreOnlyLookedAtMayBeMissing) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(LoadWorld(folder.Write(
      "w.world",
      WorldText(
          "<model name='m'><static>true</static><link name='l'><visual name='v'><geometry><mesh>"
          "<uri>model://none/x.dae</uri></mesh></geometry></visual></link></model>"))));
}

TEST_F(MissingFilesTest, PackagesOfWorldsAndObjectsAreCalledWhatTheirPackageXmlSays) {
  for (const bool is_on_path : {true, false}) {
    const TemporaryFolder folder;
    folder.Write("checkout/package.xml", "<package><name>my_hall</name></package>");
    folder.Write("checkout/meshes/box.obj", BoxObj(0.1, 0.1, 0.1));
    ::setenv("ROS_PACKAGE_PATH", is_on_path ? folder.path().c_str() : "", 1);
    const std::string place = is_on_path ? "elsewhere/" : "checkout/worlds/";
    const std::string uri = "package://my_hall/meshes/box.obj";
    EXPECT_EQ(LoadWorld(folder.Write(place + "w.world", WorldText(MeshModel("m", 1.0, uri))))
                  .statics.size(),
              1u);
    const std::string inertia =
        "<mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>";
    EXPECT_EQ(LoadObjectModel(folder.Write(place + "thing.urdf",
                                           "<robot name='t'><link name='l'><inertial>" + inertia +
                                               "</inertial><collision><geometry><mesh filename='" +
                                               uri + "'/></geometry></collision></link></robot>"))
                  .collisions.size(),
              1u);
  }
  ::setenv("ROS_PACKAGE_PATH", "", 1);
}

TEST_F(MissingFilesTest, WhatIsNamedOftenIsToldOnceWithItsNumber) {
  const TemporaryFolder folder;
  std::string models;
  for (int i = 0; i < 3; ++i) models += MeshModel(fmt::format("m{}", i), i, "none.obj");
  const std::string path = folder.Write("w.world", WorldText(models));
  EXPECT_THAT(ConfigErrorOf([&] { LoadWorld(path); }),
              AllOf(HasSubstr("w.world:5"), HasSubstr("(named 3 times)"), Not(HasSubstr(":7"))));
}

TEST_F(MissingFilesTest, MeshesInMillimetresAreAskedAboutNeverScaled) {
  const TemporaryFolder folder;
  folder.Write("pole.obj", BoxObj(30, 30, 1000));
  const World world =
      LoadWorld(folder.Write("w.world", WorldText(MeshModel("pole", 2.0, "pole.obj"))));
  const auto says = AllOf(HasSubstr("pole.obj is 30 x 30 x 1000 m large"),
                          HasSubstr("<scale>0.001 0.001 0.001</scale>"));
  EXPECT_THAT(world.notes, Contains(says));
  EXPECT_THAT(SourceOf("pole", world), says);
  geometry::Aabb bounds = geometry::BoundsOf(world.statics[0].collisions[0].shape, {});
  EXPECT_EQ(bounds.upper.z(), 1000.0);
  folder.Write("shelf.obj", BoxObj(400, 1200, 1800));
  const World wide =
      LoadWorld(folder.Write("v.world", WorldText(MeshModel("shelf", 2.0, "shelf.obj"))));
  EXPECT_THAT(ConfigErrorOf([&] { SliceWorld(wide, 0.0, 1.0, 0.01, 5000.0); }),
              AllOf(HasSubstr("is too large"), HasSubstr("'shelf'"), HasSubstr("shelf.obj"),
                    HasSubstr("0.001")));
}

TEST_F(MissingFilesTest, MapsOfKilometresAreAskedAbout) {
  const TemporaryFolder folder;
  folder.Write("m.pgm", std::string("P5 4 4 255\n") + std::string(16, '\xfe'));
  const auto notes_with = [&](const std::string& resolution) {
    return LoadMap(folder.Write("m.yaml", "image: m.pgm\nresolution: " + resolution +
                                              "\norigin: [0, 0, 0]\nnegate: 0\n"
                                              "occupied_thresh: 0.65\nfree_thresh: 0.196\n"))
        .notes;
  };
  EXPECT_THAT(notes_with("5"), Contains(AllOf(HasSubstr("m.yaml is 20 x 20 m large"),
                                              HasSubstr("in cm"), HasSubstr("resolution: 0.05"))));
  EXPECT_THAT(notes_with("50"), Contains(HasSubstr("in mm")));
  EXPECT_TRUE(notes_with("0.05").empty());
}

}  // namespace
}  // namespace hires::world::missing_files_test
