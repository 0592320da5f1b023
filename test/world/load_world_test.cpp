#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::load_world_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class LoadWorldTest : public testing::Test {
 protected:
  World Load(const std::string& content) const {
    return LoadWorld(folder_.Write("test.world", WorldText(content)));
  }
  std::string ErrorOf(const std::string& content) const {
    return MessageOf<base::ConfigError>([&] { Load(content); });
  }
  void WriteModel(const std::string& name, const std::string& model) const {
    folder_.Write("models/" + name + "/model.sdf", ModelFile(model));
    folder_.Write("models/" + name + "/model.config", ModelConfig(name));
  }

  TempFolder folder_;
};

TEST_F(LoadWorldTest, EmptyWorldHasTheDefaults) {
  const World world = Load("");
  EXPECT_EQ(world.name, "test");
  EXPECT_EQ(world.gravity, 9.8);  // SDF's own default
  EXPECT_EQ(world.floor_friction, 1.0);
  EXPECT_TRUE(world.statics.empty());
  EXPECT_TRUE(world.initial.objects.empty());
  EXPECT_EQ(world.hash, world.ComputeHash());
}

TEST_F(LoadWorldTest, StaticModelKeepsNameShapePoseAndSurface) {
  const World world = Load(
      "<gravity>0 0 -9.81</gravity>" +
      StaticModel("Wall", "<pose>1 2 3 0 0 0.5</pose>" +
                              LinkWithShape(kUnitBox,
                                            "<surface><bounce><restitution_coefficient>0.25"
                                            "</restitution_coefficient></bounce><friction><ode>"
                                            "<mu>0.5</mu></ode></friction></surface>")));
  EXPECT_EQ(world.gravity, 9.81);
  ASSERT_EQ(world.statics.size(), 1u);
  const StaticBody& wall = world.statics[0];
  EXPECT_EQ(wall.name, "Wall");
  EXPECT_EQ(wall.X_MB.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(geometry::YawOf(wall.X_MB.rotation), 0.5, 1e-15);
  ASSERT_EQ(wall.collisions.size(), 1u);
  EXPECT_EQ(wall.collisions[0].name, "c");
  EXPECT_EQ(wall.collisions[0].friction, 0.5);
  EXPECT_EQ(wall.collisions[0].restitution, 0.25);
  EXPECT_EQ(std::get<geometry::Box>(wall.collisions[0].shape).size, Eigen::Vector3d(1, 1, 1));
}

TEST_F(LoadWorldTest, ShapesAreNamedAndFoundInTheirFile) {
  const std::string two =
      "<link name='l'><collision name='coat_stand'><geometry>" + std::string(kUnitBox) +
      "</geometry></collision>\n<collision name='shelf'><pose>3 0 0 0 0 0</pose><geometry>" +
      kUnitBox + "</geometry></collision></link>";
  const World world =
      Load(StaticModel("house", two) + "\n" + StaticModel("wall", LinkWithShape(kUnitBox)));
  ASSERT_EQ(world.sources.size(), 3u);
  const auto line_of = [&](const std::string& name) {
    const std::string& source = world.sources.at(name);
    EXPECT_THAT(source, HasSubstr("test.world:"));
    return std::stoi(source.substr(source.rfind(':') + 1));
  };
  EXPECT_EQ(line_of("house::shelf"), line_of("house::coat_stand") + 1);
  EXPECT_GT(line_of("wall"), line_of("house::shelf"));
}

TEST_F(LoadWorldTest, CylinderAndSphereAreRead) {
  const World world =
      Load(StaticModel("a", LinkWithShape("<cylinder><radius>0.2</radius><length>0.7</length>"
                                          "</cylinder>")) +
           StaticModel("b", LinkWithShape("<sphere><radius>0.3</radius></sphere>")));
  const auto& cylinder = std::get<geometry::Cylinder>(world.statics[0].collisions[0].shape);
  EXPECT_EQ(cylinder.radius, 0.2);
  EXPECT_EQ(cylinder.length, 0.7);
  EXPECT_EQ(std::get<geometry::Sphere>(world.statics[1].collisions[0].shape).radius, 0.3);
}

TEST_F(LoadWorldTest, LinksOfAStaticModelKeepTheirPosesAndNames) {
  const World world = Load(StaticModel(
      "desk",
      "<pose>1 0 0 0 0 1.5707963267948966</pose>"
      "<link name='top'><pose>0 0 0.7 0 0 0</pose><collision name='c'><pose>0.5 0 0 0 0 0"
      "</pose><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>"
      "<link name='leg'><pose relative_to='top'>0 0 -0.3 0 0 0</pose><collision name='c'>"
      "<geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>"));
  ASSERT_EQ(world.statics.size(), 1u);
  const StaticBody& desk = world.statics[0];
  ASSERT_EQ(desk.collisions.size(), 2u);
  EXPECT_EQ(desk.collisions[0].name, "leg::c");
  EXPECT_EQ(desk.collisions[1].name, "top::c");
  const auto leg = desk.X_MB * desk.collisions[0].X_BS;
  const auto top = desk.X_MB * desk.collisions[1].X_BS;
  EXPECT_TRUE(leg.translation.isApprox(Eigen::Vector3d(1, 0, 0.4), 1e-12));
  EXPECT_TRUE(top.translation.isApprox(Eigen::Vector3d(1, 0.5, 0.7), 1e-12));
}

TEST_F(LoadWorldTest, NestedModelsArePlacedByAllPosesAboveThem) {
  const World world = Load(
      StaticModel("outer",
                  "<pose>1 0 0 0 0 0</pose><model name='inner'><pose>0 2 0 0 0 0</pose>"
                  "<link name='l'><pose>0 0 3 0 0 0</pose><collision name='c'><geometry><box><size>"
                  "1 1 1</size></box></geometry></collision></link></model>"
                  "<link name='own'><collision name='c'><geometry><box><size>1 1 1</size></box>"
                  "</geometry></collision></link>"));
  const StaticBody& outer = world.statics.at(0);
  ASSERT_EQ(outer.collisions.size(), 2u);
  EXPECT_EQ(outer.collisions[0].name, "inner::l::c");
  EXPECT_EQ((outer.X_MB * outer.collisions[0].X_BS).translation, Eigen::Vector3d(1, 2, 3));
}

TEST_F(LoadWorldTest, PoseRelativeToAnotherModelIsFollowed) {
  const World world = Load(
      StaticModel("table", "<pose>2 1 0 0 0 3.141592653589793</pose>" + LinkWithShape(kUnitBox)) +
      "<model name='cup'><pose relative_to='table'>0.5 0 1 0 0 0</pose>" +
      LooseCube("x").substr(std::string("<model name='x'><pose>0 0 0 0 0 0</pose>").size()));
  const ObjectState* cup = world.initial.Find("CUP");
  ASSERT_NE(cup, nullptr);
  EXPECT_TRUE(cup->X_MO.translation.isApprox(Eigen::Vector3d(1.5, 1, 1), 1e-12));
}

TEST_F(LoadWorldTest, LinkFixedToTheWorldIsStatic) {
  const World world = Load("<model name='post'>" + LinkWithShape(kUnitBox) +
                           "<joint name='j' type='fixed'><parent>world</parent><child>body</child>"
                           "</joint></model>");
  EXPECT_EQ(world.statics.size(), 1u);
  EXPECT_TRUE(world.initial.objects.empty());
}

TEST_F(LoadWorldTest, ModelWithVisualsOnlyIsNoBody) {
  EXPECT_TRUE(Load(StaticModel("picture", "<link name='l'/>")).statics.empty());
}

TEST_F(LoadWorldTest, LooseObjectsOfOneDescriptionShareTheirModel) {
  const World world = Load(LooseCube("cube1", "1 0 0 0 0 0") + LooseCube("cube2", "2 0 0 0 0 0"));
  ASSERT_EQ(world.initial.objects.size(), 2u);
  EXPECT_EQ(world.initial.objects[0].model, "cube1");
  EXPECT_EQ(world.initial.objects[1].model, "cube1");
  EXPECT_EQ(world.initial.objects[1].X_MO.translation.x(), 2.0);
  EXPECT_EQ(world.models.size(), 1u);
}

TEST_F(LoadWorldTest, LinkPoseShiftsMassAndShapeButNotTheOrigin) {
  std::string text = LooseCube("cube");
  text.insert(text.find("<inertial>"), "<pose>0 0 1 0 0 1.5707963267948966</pose>");
  text.replace(text.find("<iyy>0.002"), 10, "<iyy>0.003");
  const World world = Load(text);
  const ObjectModel& cube = *world.models.at("cube");
  EXPECT_EQ(world.initial.objects[0].X_MO.translation, Eigen::Vector3d::Zero());
  EXPECT_TRUE(cube.mass_properties.p_BBcm.isApprox(Eigen::Vector3d(0, 0, 1.05), 1e-12));
  EXPECT_NEAR(cube.mass_properties.I_BBcm(0, 0), 0.003, 1e-15);  // turned by 90 degrees
  EXPECT_NEAR(cube.mass_properties.I_BBcm(1, 1), 0.002, 1e-15);
  EXPECT_TRUE(cube.collisions[0].X_BS.translation.isApprox(Eigen::Vector3d(0, 0, 1.05), 1e-12));
}

TEST_F(LoadWorldTest, IncludedModelsAreFoundBesideTheWorld) {
  WriteModel("mug", LooseCube("original"));
  const std::string include =
      "<include><uri>model://mug</uri><name>{}</name><pose>{} 0 0 0 0 0</pose></include>";
  const World world = Load(fmt::format(include, "mug1", 1) + fmt::format(include, "mug2", 2));
  ASSERT_EQ(world.initial.objects.size(), 2u);
  EXPECT_EQ(world.initial.objects[0].name, "mug1");
  EXPECT_EQ(world.initial.objects[0].model, "mug");
  EXPECT_EQ(world.initial.objects[1].X_MO.translation.x(), 2.0);
  EXPECT_EQ(world.models.size(), 1u);
}

TEST_F(LoadWorldTest, IncludeMayMakeAModelStatic) {
  WriteModel("mug", LooseCube("original"));
  const World world =
      Load("<include><uri>model://mug</uri><name>m</name><static>true</static></include>");
  EXPECT_EQ(world.statics.size(), 1u);
  EXPECT_TRUE(world.initial.objects.empty());
}

TEST_F(LoadWorldTest, ModelPathIsSearchedToo) {
  folder_.Write("elsewhere/mug/model.sdf", ModelFile(LooseCube("original")));
  folder_.Write("elsewhere/mug/model.config", ModelConfig("mug"));
  const std::string path = folder_.Write(
      "test.world", WorldText("<include><uri>model://mug</uri><name>m</name></include>"));
  EXPECT_EQ(LoadWorld(path, {folder_.path("elsewhere")}).initial.objects.size(), 1u);
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadWorld(path); }),
              AllOf(HasSubstr("test.world:3"), HasSubstr("model://mug"), HasSubstr("looked in"),
                    HasSubstr("GAZEBO_MODEL_PATH")));
}

TEST_F(LoadWorldTest, SunAndGroundPlaneOfGazeboWorldsAreThereAndLightIsPassedOver) {
  const char* before = std::getenv("ROS_PACKAGE_PATH");
  const std::string restored = before == nullptr ? "" : before;
  setenv("ROS_PACKAGE_PATH", HIRES_SOURCE_DIR, 1);
  const World world = Load(
      "<include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>"
      "<light type='point' name='lamp'><pose>0 0 3 0 0 0</pose></light>");
  setenv("ROS_PACKAGE_PATH", restored.c_str(), 1);
  EXPECT_EQ(world.floor_friction, 1.0);
  EXPECT_TRUE(world.statics.empty());
}

TEST_F(LoadWorldTest, FloorPlaneGivesTheFrictionOfTheFloor) {
  const World world = Load(StaticModel(
      "floor", LinkWithShape("<plane><normal>0 0 1</normal></plane>",
                             "<surface><friction><ode><mu>0.4</mu></ode></friction></surface>")));
  EXPECT_EQ(world.floor_friction, 0.4);
  EXPECT_TRUE(world.statics.empty());
}

TEST_F(LoadWorldTest, FramesAreAreasWhateverTheirCase) {
  const World world = Load(
      "<frame name='myArea' attached_to='world'><pose>1 2 0.7 0 0 -1</pose></frame>"
      "<frame name='Beside' attached_to='myArea'><pose relative_to='myArea'>0 0 0.1 0 0 0</pose>"
      "</frame>");
  EXPECT_THAT(world.FrameNames(), ElementsAre("Beside", "myArea"));
  const auto X_MF = world.FindFrame("MYAREA");
  ASSERT_TRUE(X_MF.has_value());
  EXPECT_EQ(X_MF->translation, Eigen::Vector3d(1, 2, 0.7));
  EXPECT_NEAR(geometry::YawOf(X_MF->rotation), -1.0, 1e-15);
  EXPECT_NEAR(world.FindFrame("beside")->translation.z(), 0.8, 1e-15);
  EXPECT_FALSE(world.FindFrame("other").has_value());
}

TEST_F(LoadWorldTest, AFrameMaySayWhereThingsStandOnIt) {
  const World world = Load(
      "<frame name='Long' attached_to='world'><hires:extent>-0.1 -0.5 0.2\n 0.3 </hires:extent>"
      "</frame><frame name='square' attached_to='world'/>");
  EXPECT_EQ(world.ExtentOf("LONG").min(), Eigen::Vector2d(-0.1, -0.5));
  EXPECT_EQ(world.ExtentOf("LONG").max(), Eigen::Vector2d(0.2, 0.3));
  EXPECT_EQ(world.ExtentOf("square").max(), Eigen::Vector2d(0.175, 0.175));
  EXPECT_EQ(Inset(world.ExtentOf("long"), 0.15).min(), Eigen::Vector2d(0.0, -0.35));
  const auto with = [](const std::string& extent) {
    return "<frame name='f' attached_to='world'>" + extent + "</frame>";
  };
  EXPECT_NE(Load(with("<hires:extent>-1 -1 1 1</hires:extent>")).hash, Load(with("")).hash);
  EXPECT_NE(Load(with("<hires:extent>-1 -1 1 1</hires:extent>")).hash,
            Load(with("<hires:extent>-1 -1 1 2</hires:extent>")).hash);
}

TEST_F(LoadWorldTest, RefusesExtentsThatAreNoRectangleRoundTheirFrame) {
  for (const std::string bad : {"", "1 2 3", "-1 -1 1 1 1", "0.1 -1 1 1", "-1 -1 1 -0.5",
                                "-1 -1 nan 1", "-1 -1 2000 1", "-1 -1 wide 1"}) {
    EXPECT_THAT(ErrorOf("<frame name='f' attached_to='world'><hires:extent>" + bad +
                        "</hires:extent></frame>"),
                AllOf(HasSubstr("test.world"), HasSubstr("frame 'f'"), HasSubstr("'" + bad + "'"),
                      HasSubstr("xmin ymin xmax ymax")))
        << bad;
  }
}

TEST_F(LoadWorldTest, HashDoesNotDependOnLayout) {
  const std::string a = LooseCube("a"), b = StaticModel("b", LinkWithShape(kUnitBox));
  const std::string frames[2] = {"<frame name='f' attached_to='world'/>",
                                 "<frame name='G' attached_to='world'/>"};
  const std::uint64_t hash = Load(a + b + frames[0] + frames[1]).hash;
  EXPECT_EQ(Load(frames[1] + "\n<!-- a comment -->\n" + b + frames[0] + "\n  " + a).hash, hash);
}

TEST_F(LoadWorldTest, HashTellsWorldsApartButNotTheirStates) {
  const std::string b = StaticModel("b", LinkWithShape(kUnitBox));
  const std::uint64_t hash = Load(LooseCube("a") + b).hash;
  EXPECT_EQ(Load(LooseCube("a", "1 0 0 0 0 0") + b).hash, hash);
  EXPECT_NE(Load(LooseCube("a")).hash, hash);
  EXPECT_NE(Load(LooseCube("a") + b + "<gravity>0 0 -9.81</gravity>").hash, hash);
  EXPECT_NE(Load(LooseCube("a") + b + "<frame name='f' attached_to='world'/>").hash, hash);
  std::string heavier = LooseCube("a");
  heavier.replace(heavier.find("<mass>1"), 7, "<mass>2");
  EXPECT_NE(Load(heavier + b).hash, hash);
}

TEST_F(LoadWorldTest, WithModelReplacesTheModelOfThatName) {
  const World world = Load(LooseCube("cube"));
  ObjectModel other = *world.models.at("cube");
  other.mass_properties.mass = 2.0;
  const World replaced = WithModel(world, other);
  EXPECT_EQ(replaced.models.size(), 1u);
  EXPECT_EQ(replaced.models.at("cube")->mass_properties.mass, 2.0);
  EXPECT_EQ(world.models.at("cube")->mass_properties.mass, 1.0);
  EXPECT_NE(replaced.hash, world.hash);
  other.name = "second";
  EXPECT_EQ(WithModel(world, other).models.size(), 2u);
  other.name = "";
  EXPECT_THROW(WithModel(world, other), std::logic_error);
}

TEST_F(LoadWorldTest, NothingIsPrinted) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  ErrorOf(StaticModel("a", LinkWithShape("<heightmap/>")));
  Load(StaticModel("b", LinkWithShape(kUnitBox)));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// --- what is refused ---------------------------------------------------------------------------

TEST_F(LoadWorldTest, RefusesFilesThatAreNoWorld) {
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadWorld(folder_.path("none.world")); }),
              HasSubstr("none.world: no such file"));
  const auto error_of = [&](const std::string& text) {
    return MessageOf<base::ConfigError>([&] { LoadWorld(folder_.Write("a.world", text)); });
  };
  EXPECT_THAT(error_of("<sdf version='1.7'>\n<world name='a'>\n</sdf>\n"),
              AllOf(HasSubstr("a.world:"), HasSubstr("XML")));
  EXPECT_THAT(error_of(""), HasSubstr("a.world: is empty, wanted XML"));
  EXPECT_THAT(error_of("<robot name='r'><link name='l'/></robot>"),
              HasSubstr("a.world: this is a robot (URDF), wanted a world (SDF); give it with "
                        "--robot"));
  EXPECT_THAT(error_of("<sdf version='1.7'>" + LooseCube("a") + "</sdf>"),
              HasSubstr("0 <world> elements, wanted 1"));
  EXPECT_THAT(error_of("<sdf version='99.0'><world name='a'/></sdf>"), HasSubstr("a.world"));
  EXPECT_THAT(error_of("<sdf version='1.7'><world name='a'/><world name='b'/></sdf>"),
              HasSubstr("2 <world> elements, wanted 1"));
}

TEST_F(LoadWorldTest, AFileOfAStaticModelIsAWorldThatHasIt) {
  const std::string building =
      "<model name='hall'><static>true</static><pose>3 0 0.5 0 0 0</pose>\n" +
      LinkWithShape(kUnitBox) + "</model>\n";
  const World world = LoadWorld(folder_.Write("model.sdf", ModelFile(building)));
  World same = LoadWorld(folder_.Write("a.world", WorldText(building)));
  same.name = world.name;
  EXPECT_EQ(world.hash, same.ComputeHash());
  EXPECT_EQ(SourceOf("hall", world), folder_.path("model.sdf") + ":3");
  EXPECT_THAT(world.notes, ElementsAre(HasSubstr("of a static model without a world")));
  const auto error_of = [&](const std::string& models) {
    const std::string path = folder_.Write("models.sdf", ModelFile(models));
    return MessageOf<base::ConfigError>([&] { LoadWorld(path); });
  };
  EXPECT_THAT(error_of(building + building), HasSubstr("0 <world> elements, wanted 1"));
  EXPECT_THAT(error_of(LooseCube("cube")), HasSubstr("a model goes with --object"));
  std::string wrong = building;
  wrong.replace(wrong.find("1 1 1"), 5, "1 1 x");
  EXPECT_THAT(error_of(wrong), HasSubstr("models.sdf:3"));
}

TEST_F(LoadWorldTest, ReportsEveryObjectionWithFileAndLine) {
  const std::string error = ErrorOf(
      StaticModel("a", LinkWithShape("<heightmap/>")) +
      StaticModel("b", "<pose>here</pose>" + LinkWithShape(kUnitBox)) +
      "<frame name='f'><pose relative_to='nowhere'/></frame>" + LooseCube("far", "0 2e6 0 0 0 0"));
  EXPECT_THAT(error, AllOf(HasSubstr("test.world:3: collision 'c'"), HasSubstr("here"),
                           HasSubstr("nowhere"), HasSubstr("test.world:5: model 'far'")));
}

TEST_F(LoadWorldTest, RefusesNumbersThatAreNone) {
  EXPECT_THAT(ErrorOf(StaticModel("a", LinkWithShape(kUnitBox,
                                                     "<surface><friction><ode><mu>much</mu></ode>"
                                                     "</friction></surface>"))),
              HasSubstr("much"));
  EXPECT_THAT(ErrorOf(StaticModel("a", "<pose>here</pose>" + LinkWithShape(kUnitBox))),
              HasSubstr("here"));
}

TEST_F(LoadWorldTest, RefusesEqualNamesWhateverTheirCase) {
  EXPECT_THAT(ErrorOf(LooseCube("cup") + LooseCube("cup")), HasSubstr("cup"));
  EXPECT_THAT(ErrorOf(LooseCube("mug1") + LooseCube("Mug1")),
              AllOf(HasSubstr("test.world:4: model 'Mug1'"),
                    HasSubstr("test.world:3: model 'mug1'"), HasSubstr("rename")));
  EXPECT_THAT(ErrorOf("<frame name='Area' attached_to='world'/>"
                      "<frame name='area' attached_to='world'/>"),
              AllOf(HasSubstr("frame 'Area'"), HasSubstr("frame 'area'")));
}

TEST_F(LoadWorldTest, RefusesPosesThatAreNotFiniteOrTooFar) {
  EXPECT_THAT(ErrorOf(LooseCube("a", "0 2000 0 0 0 0")),
              AllOf(HasSubstr("model 'a'"), HasSubstr("2000"), HasSubstr("1000 m")));
  EXPECT_THAT(ErrorOf(LooseCube("a", "nan 0 0 0 0 0")), HasSubstr("test.world"));
  EXPECT_THAT(ErrorOf("<frame name='f' attached_to='world'><pose>0 0 -1e9 0 0 0</pose></frame>"),
              HasSubstr("frame 'f'"));
}

TEST_F(LoadWorldTest, RefusesMassesThatNobodyHas) {
  const std::string cube = LooseCube("cube");
  const auto with = [&](const std::string& what, const std::string& by) {
    std::string text = cube;
    return ErrorOf(text.replace(text.find(what), what.size(), by));
  };
  EXPECT_THAT(with("<mass>1</mass>", "<mass>-1</mass>"), HasSubstr("mass is -1 kg"));
  EXPECT_THAT(with("<mass>1</mass>", "<mass>much</mass>"), HasSubstr("<mass>"));
  EXPECT_THAT(with("<ixx>0.002</ixx>", "<ixx>0.9</ixx>"),
              AllOf(HasSubstr("test.world:3: link 'body'"), HasSubstr("triangle inequality")));
}

TEST_F(LoadWorldTest, RefusesShapesItCannotHold) {
  const auto error_of = [&](const std::string& shape) {
    return ErrorOf(StaticModel("a", LinkWithShape(shape)));
  };
  EXPECT_THAT(
      error_of("<torus><radius>1</radius></torus>"),
      AllOf(HasSubstr("test.world:3: collision 'c'"), HasSubstr("<torus> is not supported")));
  EXPECT_THAT(error_of("<heightmap><uri>hills.png</uri></heightmap>"),
              AllOf(HasSubstr("<heightmap>"), HasSubstr("mesh")));
  EXPECT_THAT(error_of("<box><size>1 -1 1</size></box>"), HasSubstr("test.world"));
  EXPECT_THAT(error_of("<sphere><radius>-1</radius></sphere>"), HasSubstr("test.world"));
  EXPECT_THAT(error_of("<sphere><radius>5e5</radius></sphere>"), HasSubstr("500000"));
}

TEST_F(LoadWorldTest, RefusesSurfacesOutOfRange) {
  const auto error_of = [&](const std::string& surface) {
    return ErrorOf(StaticModel("a", LinkWithShape(kUnitBox, "<surface>" + surface + "</surface>")));
  };
  EXPECT_THAT(error_of("<friction><ode><mu>low</mu></ode></friction>"),
              AllOf(HasSubstr("test.world:3"), HasSubstr("mu"), HasSubstr("low")));
  EXPECT_THAT(error_of("<bounce><restitution_coefficient>1.5</restitution_coefficient></bounce>"),
              AllOf(HasSubstr("test.world:3"), HasSubstr("restitution_coefficient")));
}

TEST_F(LoadWorldTest, FrictionIsTheSmallerOfBothDirectionsAndEndlessOnesAreLarge) {
  const auto load = [&](const std::string& friction) {
    const std::string surface = "<surface><friction>" + friction + "</friction></surface>";
    return Load(
        StaticModel("a", LinkWithShape(kUnitBox, surface)) +
        StaticModel("floor", LinkWithShape("<plane><normal>0 0 1</normal></plane>", surface)));
  };
  const auto ode = [](const std::string& values) { return "<ode>" + values + "</ode>"; };
  const std::vector<std::pair<std::string, double>> plain{{"<mu>0.3</mu>", 0.3},
                                                          {"<mu>0.3</mu><mu2>0.3</mu2>", 0.3},
                                                          {"<mu>1</mu><mu2>0.05</mu2>", 0.05},
                                                          {"<mu>0.05</mu><mu2>1</mu2>", 0.05},
                                                          {"<mu>5</mu>", 5.0},
                                                          {"<mu2>0.2</mu2>", 0.2},
                                                          {"<mu>0</mu><mu2>2</mu2>", 0.0},
                                                          {"", 1.0}};
  for (const auto& [values, wanted] : plain) {
    const World world = load(ode(values));
    EXPECT_EQ(world.statics.at(0).collisions.at(0).friction, wanted) << values;
    EXPECT_EQ(world.floor_friction, wanted) << values;
    EXPECT_THAT(world.notes, testing::IsEmpty()) << values;
  }
  for (const std::string endless : {"inf", "Inf", "-1", "1e400"}) {
    const World world = load(ode("<mu>" + endless + "</mu><mu2>" + endless + "</mu2>"));
    EXPECT_EQ(world.statics.at(0).collisions.at(0).friction, 1000.0) << endless;
    EXPECT_EQ(world.floor_friction, 1000.0) << endless;
    EXPECT_THAT(world.notes,
                ElementsAre(AllOf(HasSubstr("2 collisions"), HasSubstr("test.world:3 'c'"),
                                  HasSubstr("infinite or negative: 1000 is taken"))));
    EXPECT_EQ(load(ode("<mu>0.4</mu><mu2>" + endless + "</mu2>")).floor_friction, 0.4);
  }
}

TEST_F(LoadWorldTest, FrictionThatIsNotPlayedIsSaidWhereItMatters) {
  const auto notes_of = [&](const std::string& friction) {
    return Load(StaticModel("a", LinkWithShape(kUnitBox, "<surface><friction>" + friction +
                                                             "</friction></surface>")))
        .notes;
  };
  EXPECT_THAT(
      notes_of("<ode><mu>0.4</mu></ode><bullet><friction>0.4</friction><friction2>0.4"
               "</friction2></bullet><torsional><patch_radius>0</patch_radius></torsional>"),
      testing::IsEmpty());
  EXPECT_THAT(notes_of("<bullet><friction>0.05</friction></bullet>"),
              ElementsAre(HasSubstr("friction in <bullet> differs")));
  EXPECT_THAT(notes_of("<torsional><patch_radius>0.01</patch_radius></torsional>"),
              ElementsAre(HasSubstr("<torsional> friction is left out")));
}

TEST_F(LoadWorldTest, RefusesPlanesThatAreNoFloor) {
  const std::string plane = LinkWithShape("<plane><normal>0 0 1</normal></plane>");
  for (const char* pose : {"0 0 0 1.5707963 0 0", "0 0 0 0 0.1 0", "0 0 0 3.14159265 0 0"}) {
    EXPECT_THAT(ErrorOf(StaticModel("a", fmt::format("<pose>{}</pose>", pose) + plane)),
                HasSubstr("the only planes supported are level ones"))
        << pose;
  }
}

TEST_F(LoadWorldTest, RefusesGravityThatDoesNotPointDown) {
  EXPECT_THAT(ErrorOf("<gravity>1 0 -9.81</gravity>"),
              AllOf(HasSubstr("<gravity>"), HasSubstr("0 0 -9.81")));
  EXPECT_THAT(ErrorOf("<gravity>0 0 9.81</gravity>"), HasSubstr("<gravity>"));
}

TEST_F(LoadWorldTest, RefusesAreasOnThingsThatMove) {
  EXPECT_THAT(ErrorOf(LooseCube("cup") + "<frame name='f' attached_to='cup'/>"),
              AllOf(HasSubstr("frame 'f'"), HasSubstr("cup"), HasSubstr("can move")));
}

TEST_F(LoadWorldTest, RefusesIncludesThatLeadNowhere) {
  const auto error_of = [&](const std::string& uri) {
    return ErrorOf("<include><uri>" + uri + "</uri></include>");
  };
  EXPECT_THAT(error_of("model://none"), AllOf(HasSubstr("test.world:3"), HasSubstr("none")));
  EXPECT_THAT(error_of("https://example.com/mug"), HasSubstr("nothing is fetched"));
  EXPECT_THAT(error_of("ftp://example.com/mug"), HasSubstr("cannot be reached"));
  EXPECT_THAT(error_of("model://../../etc"), HasSubstr("'..'"));
  EXPECT_THAT(error_of("file:///no/such.sdf"), HasSubstr("not there"));
  folder_.Write("models/bare/other.sdf", ModelFile(LooseCube("a")));
  EXPECT_THAT(error_of("model://bare"), HasSubstr("no model.config"));
  folder_.Write("models/lost/model.config", ModelConfig("lost"));
  EXPECT_THAT(error_of("model://lost"), HasSubstr("model.config names no SDF file"));
  EXPECT_THAT(ErrorOf("<include></include>"), HasSubstr("no <uri>"));
}

TEST_F(LoadWorldTest, RefusesIncludesThatGoInCircles) {
  WriteModel("a", "<model name='a'><include><uri>model://b</uri></include></model>");
  WriteModel("b", "<model name='b'><include><uri>model://a</uri></include></model>");
  EXPECT_THAT(ErrorOf("<include><uri>model://a</uri></include>"), HasSubstr("includes itself"));
}

TEST_F(LoadWorldTest, RefusesIncludesThatMultiply) {
  for (int i = 0; i < 15; ++i) {  // 4^15 copies
    std::string twice;
    for (int k = 0; k < 4; ++k) {
      twice += fmt::format("<include><uri>model://m{}</uri><name>n{}</name></include>", i + 1, k);
    }
    WriteModel(fmt::format("m{}", i), fmt::format("<model name='m'>{}</model>", twice));
  }
  WriteModel("m15", LooseCube("leaf"));
  EXPECT_THAT(ErrorOf("<include><uri>model://m0</uri></include>"),
              HasSubstr("more than 200000 elements"));
}

TEST_F(LoadWorldTest, RefusesElementsThatNestTooDeep) {
  std::string open, close;
  for (int i = 0; i < 70; ++i) {
    open += fmt::format("<model name='m{}'>\n", i);
    close += "</model>\n";
  }
  EXPECT_THAT(ErrorOf(open + close), HasSubstr("nest more than 64 deep"));
  for (int i = 0; i < 2000; ++i) open += "<model name='m'>", close += "</model>";
  EXPECT_THAT(ErrorOf(open + close), HasSubstr("test.world:"));
}

TEST_F(LoadWorldTest, RefusesFilesThatAreTooLarge) {
  EXPECT_THAT(ErrorOf(std::string(17u << 20, ' ')), HasSubstr("bytes"));
}

}  // namespace
}  // namespace hires::world::load_world_test
