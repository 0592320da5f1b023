// Versions, XML, names and values of worlds as people have them, and files that are no worlds.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"
#include "world/wild_world.h"

namespace hires::world::wild_formats_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class WildFormatsTest : public WildWorld {};

TEST_F(WildFormatsTest, NewerVersionsAreReadAsFarAsTheirElementsAreKnown) {
  const std::string content =
      StaticModel("a", LinkWithShape(kUnitBox)) + LooseCube("cube", "3 0 0 0 0 0");
  const std::uint64_t hash = Load(content, "1.9").hash;
  for (const std::string version : {"1.10", "1.11", "1.12"}) {
    const World world = Load(content, version);
    EXPECT_EQ(world.hash, hash) << version;
    EXPECT_THAT(world.notes, ElementsAre(HasSubstr("SDF " + version + " read as 1.9")));
  }
}

TEST_F(WildFormatsTest, OldFormatsAndNoneAreToldOrRead) {
  const auto error_of = [&](const std::string& text) {
    return MessageOf<base::ConfigError>([&] { LoadWorld(folder_.Write("a.world", text)); });
  };
  EXPECT_THAT(error_of("<gazebo version='1.2'><world name='w'/></gazebo>"),
              AllOf(HasSubstr("old format"), HasSubstr("gz sdf --convert")));
  const std::string box = StaticModel("a", LinkWithShape(kUnitBox));
  for (const char* version : {"", " version=''"}) {
    const World world = LoadWorld(folder_.Write(
        "a.world", fmt::format("<sdf{}><world name='w'>{}</world></sdf>", version, box)));
    EXPECT_EQ(world.statics.size(), 1u);
    EXPECT_THAT(world.notes, ElementsAre(HasSubstr("without a version of SDF read as 1.9")));
  }
}

TEST_F(WildFormatsTest, CommentsAndBlanksMayStandWhereverXmlHasThem) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)));
  folder_.Write("models/crate/model.config",
                "<!-- ours --><?xml version='1.0'?>\n" + ModelConfig("crate"));
  folder_.Write(
      "models/crate/model.sdf",
      "\xEF\xBB\xBF<!-- a -->\n<?xml version='1.0'?>" +
          ModelFile(StaticModel("crate", LinkWithShape("<box><size>1 <!-- x --> 2 3</size>"
                                                       "</box>"))));
  const World world = LoadWorld(folder_.Write(
      "a.world",
      "<!-- a\n comment -->\n<?xml version='1.0'?>\n<!DOCTYPE sdf [<!ENTITY a 'b'>]>\n" +
          WorldText("<include><uri>\n <!-- which --> model://crate\n </uri></include>")));
  ASSERT_EQ(world.statics.size(), 1u);
  EXPECT_EQ(std::get<geometry::Box>(world.statics[0].collisions[0].shape).size,
            Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(world.notes, IsEmpty());
}

TEST_F(WildFormatsTest, FramesOfPosesCountUpToSdf16AndAreToldOfLater) {
  const auto load = [&](const std::string& frame, const std::string& version) {
    const std::string pose = "<pose frame='" + frame + "'>";
    return Load(StaticModel("room",
                            "<link name='a'><pose>0 3 0 0 0 0</pose></link>\n"
                            "<link name='b'>" +
                                pose +
                                "1 0 0 0 0 0</pose>"
                                "<collision name='c'>" +
                                pose + "0 0 1 0 0 0</pose><geometry>" + kUnitBox +
                                "</geometry></collision></link>"),
                version);
  };
  const auto place_of = [](const World& world) {
    return world.statics.at(0).collisions.at(0).X_BS.translation;
  };
  for (const char* version : {"1.4", "1.6", "1.7", "1.8", "1.9"}) {
    const World world = load("", version);
    EXPECT_THAT(world.notes, IsEmpty()) << version;
    EXPECT_EQ(log_, "") << version;
    EXPECT_TRUE(place_of(world).isApprox(Eigen::Vector3d(1, 0, 1))) << version;
  }
  for (const char* version : {"1.7", "1.8", "1.9"}) {
    const World world = load("a", version);
    EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("2 poses whose attribute frame is passed"),
                                               HasSubstr("relative_to"), HasSubstr("first"),
                                               HasSubstr("test.world:4"))));
    EXPECT_THAT(log_, Not(HasSubstr("sdformat=")));
    EXPECT_TRUE(place_of(world).isApprox(Eigen::Vector3d(1, 0, 1))) << version;
  }
  const World old =
      Load(StaticModel("room",
                       "<link name='a'><pose>0 3 0 0 0 0</pose></link><link name='b'>"
                       "<pose frame='a'>1 0 0 0 0 0</pose><collision name='c'><geometry>" +
                           std::string(kUnitBox) + "</geometry></collision></link>"),
           "1.6");
  EXPECT_THAT(old.notes, IsEmpty());
  EXPECT_TRUE(place_of(old).isApprox(Eigen::Vector3d(1, 3, 0)));
}

TEST_F(WildFormatsTest, GravityOfOldWorldsIsRead) {
  EXPECT_EQ(Load("<physics type='ode'><gravity>0 0 -1.6</gravity></physics>", "1.5").gravity, 1.6);
}

TEST_F(WildFormatsTest, AnotherGravityThanTheEarthsIsSaid) {
  for (const char* earths : {"9.8", "9.81", "9.80665", "9.78", "9.83"}) {
    EXPECT_THAT(Load("<gravity>0 0 -" + std::string(earths) + "</gravity>", "1.7").notes,
                IsEmpty());
  }
  for (const char* other : {"0", "1.62", "3.7", "98.1"}) {
    EXPECT_THAT(Load("<gravity>0 0 -" + std::string(other) + "</gravity>", "1.7").notes,
                ElementsAre(HasSubstr("<gravity> is " + std::string(other) + " m/s^2")));
  }
}

TEST_F(WildFormatsTest, ObstaclesNeedNoNamesOfTheirOwn) {
  const World world = Load(StaticModel("Wall", LinkWithShape(kUnitBox)) +
                           StaticModel("wall", LinkWithShape(kUnitBox)) +
                           StaticModel("WALL", LinkWithShape(kUnitBox)));
  ASSERT_EQ(world.statics.size(), 3u);
  std::set<std::string> names;
  for (const StaticBody& body : world.statics) names.insert(base::ToLower(body.name));
  EXPECT_EQ(names.size(), 3u);
  EXPECT_THAT(ErrorOf(StaticModel("Cup", LinkWithShape(kUnitBox)) + LooseCube("cup")),
              HasSubstr("has the name of another"));
  EXPECT_THAT(ErrorOf(StaticModel("a", LinkWithShape(kUnitBox)) +
                      StaticModel("a", LinkWithShape(kUnitBox))),
              AllOf(HasSubstr("test.world:4: model 'a' has the name of another, in line 3"),
                    Not(HasSubstr("already exists"))));
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)));
  const std::string include = "<include><uri>model://crate</uri></include>\n";
  EXPECT_THAT(ErrorOf(include + include),
              AllOf(HasSubstr("test.world:4: model 'crate' has the name of another, in line 3"),
                    HasSubstr("<name> of its own"), Not(HasSubstr("already exists"))));
}

TEST_F(WildFormatsTest, AllWrongValuesAndNamesAreToldWithTheirLines) {
  const std::string error =
      ErrorOf(StaticModel("table", "<pose>1 2 x 0 0 0</pose>" + LinkWithShape(kUnitBox)) +
              StaticModel("b", LinkWithShape("<box><size>1 1</size></box>")) +
              StaticModel("c", LinkWithShape("<cylinder><radius>abc</radius><length>1</length>"
                                             "</cylinder>")) +
              StaticModel("d", "<pose relative_to='tabel'/>" + LinkWithShape(kUnitBox)));
  EXPECT_THAT(
      error,
      AllOf(HasSubstr("test.world:3: <pose> in <model> is '1 2 x 0 0 0', wanted 6 numbers"),
            HasSubstr("test.world:4: <size> in <box> is '1 1', wanted 3 numbers"),
            HasSubstr("test.world:5: <radius> in <cylinder> is 'abc', wanted 1 number"),
            HasSubstr("test.world:6: relative_to of a <pose>: name 'tabel' is unknown; did you "
                      "mean 'table'"),
            Not(HasSubstr("Graph")), Not(HasSubstr("Error reading"))));
}

TEST_F(WildFormatsTest, AFileOfAnotherKindIsToldByItsKind) {
  const auto error_of = [&](const std::string& name, const std::string& text) {
    return MessageOf<base::ConfigError>([&] { LoadWorld(folder_.Write(name, text)); });
  };
  EXPECT_THAT(error_of("m.yaml", "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n"),
              AllOf(HasSubstr("a map (YAML)"), HasSubstr("--map")));
  EXPECT_THAT(error_of("map.pgm", std::string("P5\n1 1\n255\n\0", 12)),
              AllOf(HasSubstr("a picture"), HasSubstr("--map")));
  EXPECT_THAT(error_of("map.png", "\x89PNG\r\n"), HasSubstr("a picture"));
  EXPECT_THAT(error_of("w.world.erb", WorldText("<% 3.times do |i| %>\n<model/><% end %>")),
              AllOf(HasSubstr("template (ERB)"), HasSubstr("erb w.world.erb > w.world")));
  EXPECT_THAT(error_of("w.world.xacro", "<sdf xmlns:xacro='x'><xacro:arg name='a'/></sdf>"),
              AllOf(HasSubstr("template (xacro)"), HasSubstr("xacro w.world.xacro > w.world")));
  EXPECT_THAT(error_of("r.xacro", "<robot xmlns:xacro='x'><xacro:arg name='a'/></robot>"),
              AllOf(HasSubstr("a robot (xacro)"), HasSubstr("--robot")));
  EXPECT_THAT(error_of("r.urdf", "<robot name='r'><link name='l'/></robot>"),
              AllOf(HasSubstr("a robot (URDF)"), HasSubstr("--robot")));
  EXPECT_THAT(error_of("robot.yaml", "urdf: a.urdf\n"), HasSubstr("--robot"));
  EXPECT_THAT(error_of("can.yaml", "shape: cylinder\n"), HasSubstr("--object"));
  EXPECT_THAT(error_of("m.stl", "solid a\nendsolid a\n"), HasSubstr("a mesh"));
  EXPECT_THAT(error_of("m.dae", "<?xml version='1.0'?><COLLADA/>"), HasSubstr("a mesh"));
  EXPECT_THAT(error_of("a.bag", "#ROSBAG V2.0\n"), HasSubstr("a bag"));
  EXPECT_THAT(error_of("model.sdf", ModelFile(LooseCube("a"))), HasSubstr("--object"));
  EXPECT_THAT(error_of("w.wbt", "#VRML_SIM R2023b utf8\nWorldInfo { basicTimeStep 20 }\n"),
              AllOf(HasSubstr("a world of Webots"), HasSubstr("SDF"), HasSubstr("--map")));
  for (const std::string stage :
       {"# cave.world - Authors: A <a@b.org>\ndefine hokuyo ranger ( sensor( range [ 0.0 5.0 ] ) "
        ")\n",
        "include \"map.inc\"\r\nfloorplan\r\n(\r\n  bitmap \"cave.png\"\r\n)\r\n",
        "\n  window( size [ 635 666 ] )\n"}) {
    EXPECT_THAT(error_of("w.world", stage),
                AllOf(HasSubstr("a world of Stage"), HasSubstr("bitmap"), HasSubstr("--map")));
  }
  for (const std::string other : {"a text of models (and more)\n", "window: (1)\n", "window 3\n"})
    EXPECT_THAT(error_of("w.world", other), Not(HasSubstr("Stage")));
  EXPECT_THAT(error_of("x.launch", "<launch/>"), HasSubstr("a launch file"));
  const std::string box = StaticModel("b", LinkWithShape(kUnitBox));
  EXPECT_THAT(error_of("e.sdf", WorldText("{% for i in range(3) %}" + box + "{% endfor %}")),
              HasSubstr("a template (Jinja)"));
  EXPECT_THAT(
      error_of("e.world", WorldText("@{n = 0}\n@[for x in [-1, 1]]\n" + box + "@[end for]")),
      HasSubstr("a template (EmPy)"));
  EXPECT_THAT(error_of("f.world", "<sdf>@[if n < 2]<world name='a'>" + box),
              HasSubstr("a template (EmPy)"));
  EXPECT_EQ(Load("<!-- {% for %} and @[for: what this was made from -->" + box).statics.size(), 1u);
}

}  // namespace
}  // namespace hires::world::wild_formats_test
