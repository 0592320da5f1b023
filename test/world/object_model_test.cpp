#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/world/object_catalogue.h"
#include "hires/world/world.h"
#include "world/liquid.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::object_model_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using MeshPtr = std::shared_ptr<const geometry::TriangleMesh>;

const char kCubeObj[] =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string WithShape(const std::string& shape) {
  std::string text = LooseCube("thing");
  const std::string box = "<box><size>0.1 0.1 0.1</size></box>";
  return ModelFile(text.replace(text.find(box), box.size(), shape));
}

std::string MeshShape(const std::string& uri, const std::string& scale = "0.1 0.2 0.3") {
  return "<mesh><uri>" + uri + "</uri><scale>" + scale + "</scale></mesh>";
}

/// A URDF of one link, the middle of a can that is 0.2 m high.
std::string CanUrdf(const std::string& inside_link, const std::string& after = "") {
  return "<robot name='can'>\n<link name='body'>\n<inertial><origin xyz='0 0 0.1'/><mass "
         "value='0.3'/><inertia ixx='0.002' ixy='0' ixz='0' iyy='0.002' iyz='0' izz='0.001'/>"
         "</inertial>\n" +
         inside_link + "</link>\n" + after + "</robot>\n";
}
const char kCanShape[] =
    "<collision><origin xyz='0 0 0.1' rpy='0 0 1'/><geometry><cylinder radius='0.03' "
    "length='0.2'/></geometry></collision>\n";

class ObjectModelTest : public testing::Test {
 protected:
  std::string ErrorOf(const std::string& name, const std::string& text) const {
    const std::string path = folder_.Write(name, text);
    return MessageOf<base::ConfigError>([&] { LoadObjectModel(path); });
  }
  TempFolder folder_;
};

TEST_F(ObjectModelTest, MeshIsReadScaledFromBesideTheFile) {
  folder_.Write("thing/meshes/cube.obj", kCubeObj);
  const ObjectModel thing =
      LoadObjectModel(folder_.Write("thing/model.sdf", WithShape(MeshShape("meshes/cube.obj"))));
  const auto mesh = std::get<MeshPtr>(thing.collisions.at(0).shape);
  EXPECT_EQ(mesh->triangles.size(), 12u);
  EXPECT_EQ(mesh->vertices.size(), 8u);
  const geometry::Aabb bounds = geometry::BoundsOf(mesh, {});
  EXPECT_LT((bounds.lower - Eigen::Vector3d::Zero()).norm(), 1e-9);
  EXPECT_LT((bounds.upper - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-7);
}

TEST_F(ObjectModelTest, MeshIsFoundByEveryScheme) {
  const std::string mesh = folder_.Write("thing/meshes/cube.obj", kCubeObj);
  for (const std::string& uri :
       {std::string("model://thing/meshes/cube.obj"),
        std::string("package://thing/meshes/cube.obj"), "file://" + mesh}) {
    const ObjectModel thing =
        LoadObjectModel(folder_.Write("thing/model.sdf", WithShape(MeshShape(uri))));
    EXPECT_EQ(std::get<MeshPtr>(thing.collisions.at(0).shape)->triangles.size(), 12u) << uri;
  }
}

TEST_F(ObjectModelTest, MeshesOfEqualObjectsAreShared) {
  folder_.Write("models/thing/cube.obj", kCubeObj);
  folder_.Write("models/thing/model.sdf", WithShape(MeshShape("cube.obj")));
  folder_.Write("models/thing/model.config", ModelConfig("thing"));
  const World world = LoadWorld(folder_.Write(
      "a.world", WorldText("<include><uri>model://thing</uri><name>a</name></include>"
                           "<include><uri>model://thing</uri><name>b</name></include>")));
  EXPECT_EQ(world.models.size(), 1u);
  EXPECT_EQ(world.initial.objects.size(), 2u);
}

TEST_F(ObjectModelTest, RefusesMeshesItCannotRead) {
  folder_.Write("cube.obj", kCubeObj);
  folder_.Write("bad.stl", "solid nonsense");
  folder_.Write("cube.blend", "x");
  const auto error_of = [&](const std::string& shape) {
    return ErrorOf("thing.sdf", WithShape(shape));
  };
  EXPECT_THAT(error_of(MeshShape("none.obj")),
              AllOf(HasSubstr("thing.sdf:2: collision 'c'"), HasSubstr("none.obj")));
  EXPECT_THAT(error_of(MeshShape("bad.stl")), HasSubstr("bad.stl"));
  EXPECT_THAT(error_of(MeshShape("cube.blend")), HasSubstr(".stl, .dae, .obj or .glb"));
  EXPECT_THAT(error_of(MeshShape("cube.obj", "0 1 1")), HasSubstr("scale"));
  EXPECT_THAT(error_of(MeshShape("../../outside.obj")), HasSubstr("outside the folder"));
  EXPECT_THAT(error_of(MeshShape("model://none/cube.obj")), HasSubstr("not there"));
  EXPECT_THAT(error_of("<mesh><uri>cube.obj</uri><submesh><name>lid</name></submesh></mesh>"),
              HasSubstr("submesh 'lid' is unknown"));
}

TEST_F(ObjectModelTest, AFolderIsTheModelSdfInIt) {
  folder_.Write("thing/meshes/cube.obj", kCubeObj);
  const std::string file =
      folder_.Write("thing/model.sdf", WithShape(MeshShape("meshes/cube.obj")));
  for (const char* folder : {"thing", "thing/", "./thing"}) {
    EXPECT_EQ(ObjectNameIn(folder_.path(folder)), "thing");
    EXPECT_EQ(FindObjectModel(folder_.path(folder), "").collisions.size(),
              LoadObjectModel(file).collisions.size());
  }
  folder_.Write("empty/model.config", "");
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadObjectModel(folder_.path("empty")); }),
              HasSubstr("a folder with a model.sdf"));
}

TEST_F(ObjectModelTest, RefusesSdfThatIsNoObject) {
  EXPECT_THAT(ErrorOf("a.sdf", WorldText("")), HasSubstr("no <model>"));
  EXPECT_THAT(ErrorOf("a.sdf", ModelFile(StaticModel("wall", LinkWithShape(kUnitBox)))),
              AllOf(HasSubstr("model 'wall'"), HasSubstr("<static>")));
  EXPECT_THAT(ErrorOf("a.txt", "hello"), HasSubstr("ends in .sdf, .urdf or .yaml"));
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadObjectModel(folder_.path("none.sdf")); }),
              HasSubstr("no such file"));
}

TEST_F(ObjectModelTest, RulerAndScalesGiveACylinderOrABox) {
  const ObjectModel bottle = LoadObjectModel(folder_.Write(
      "bottle.yaml", "{shape: cylinder, radius: 0.04, height: 0.2, mass: 0.5, friction: 0.3}"));
  EXPECT_EQ(bottle.name, "bottle");
  EXPECT_EQ(bottle.mass_properties.p_BBcm, Eigen::Vector3d(0, 0, 0.1));
  EXPECT_NEAR(bottle.mass_properties.I_BBcm(2, 2), 0.5 * 0.5 * 0.04 * 0.04, 1e-15);
  ASSERT_EQ(bottle.collisions.size(), 1u);
  EXPECT_EQ(geometry::BoundsOf(bottle.collisions[0].shape, bottle.collisions[0].X_BS).lower.z(), 0);
  EXPECT_EQ(bottle.collisions[0].friction, 0.3);
  const ObjectModel carton = LoadObjectModel(folder_.Write(
      "carton.yaml",
      "{shape: box, depth: 0.1, width: 0.06, height: 0.2, mass: 1.0, com_height: 0.05}"));
  EXPECT_EQ(carton.mass_properties.p_BBcm.z(), 0.05);
  EXPECT_EQ(std::get<geometry::Box>(carton.collisions[0].shape).size,
            Eigen::Vector3d(0.1, 0.06, 0.2));
  EXPECT_EQ(carton.collisions[0].friction, 1.0);
}

TEST_F(ObjectModelTest, AllNumbersThatAPlainObjectLacksAreNamedAtOnce) {
  EXPECT_THAT(ErrorOf("b.yaml", "{shape: box, mass: 1.0}"),
              HasSubstr("b.yaml: height, depth, width are missing; add them"));
  EXPECT_THAT(ErrorOf("b.yaml", "{shape: cylinder}"),
              HasSubstr("height, mass, radius are missing"));
  EXPECT_THAT(ErrorOf("b.yaml", "{depth: 1.0}"), HasSubstr("shape, height, mass are missing"));
}

TEST_F(ObjectModelTest, SizesAsOthersCallThemAreToldByTheirNamesHere) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases{
      {"cylinder, height: 0.2", "diameter", "'radius', half of it"},
      {"cylinder, radius: 0.04", "length", "'height'"},
      {"cylinder, radius: 0.04, height: 0.2", "length", "'height'"},
      {"box, width: 0.1, height: 0.2", "length", "'depth'"},
      {"box", "size", "'depth', 'width' and 'height'"},
      {"cylinder", "dimensions", "'radius' and 'height'"},
      {"box, height: 0.2", "diameter", "'depth' and 'width'"}};
  for (const auto& [shape, key, wanted] : cases) {
    EXPECT_THAT(
        ErrorOf("b.yaml", "{shape: " + shape + ", mass: 1, " + key + ": 0.08}"),
        AllOf(HasSubstr("b.yaml: " + key + " is '0.08', wanted " + wanted), HasSubstr("line 1")));
  }
}

TEST_F(ObjectModelTest, RefusesPlainObjectsThatAreNone) {
  const auto error_of = [&](const std::string& more) {
    return ErrorOf("b.yaml", "{shape: cylinder, height: 0.2, mass: 0.5, " + more + "}");
  };
  EXPECT_THAT(error_of("width: 0.1"), AllOf(HasSubstr("b.yaml"), HasSubstr("radius")));
  EXPECT_THAT(error_of("radius: 40"), HasSubstr("radius is '40'"));
  EXPECT_THAT(error_of("radius: .nan"), HasSubstr("radius"));
  EXPECT_THAT(error_of("radius: 0.04, com_height: 0.21"), HasSubstr("com_height is '0.21'"));
  EXPECT_THAT(error_of("radius: 0.04, colour: red"), HasSubstr("colour"));
  EXPECT_THAT(ErrorOf("m.yaml", "{shape: cylinder, radius: 0.04, height: 0.2, mas: 0.5}"),
              HasSubstr("m.yaml: key 'mas' is unknown; did you mean 'mass'?; line 1"));
  EXPECT_THAT(ErrorOf("c.yaml", "{shape: cone, height: 0.2, mass: 0.5}"), HasSubstr("cylinder"));
}

TEST_F(ObjectModelTest, LiquidOfAPlainObjectIsRead) {
  const ObjectModel tea =
      LoadObjectModel(folder_.Write("tea.yaml",
                                    "{shape: cylinder, radius: 0.038, height: 0.09, mass: 0.35,\n"
                                    " liquid: {radius: 0.036, fill: 0.077, rim: 0.085}}"));
  ASSERT_TRUE(tea.liquid);
  EXPECT_EQ(tea.liquid->radius, 0.036);
  EXPECT_EQ(tea.liquid->fill, 0.077);
  EXPECT_EQ(tea.liquid->rim, 0.085);
  EXPECT_FALSE(MayHoldUnknownLiquid(tea));
}

TEST_F(ObjectModelTest, RefusesLiquidsThatCannotBeNamingLineValueAndRange) {
  const auto error_of = [&](const std::string& liquid) {
    return ErrorOf(
        "tea.yaml",
        "shape: cylinder\nradius: 0.038\nheight: 0.09\nmass: 0.35\nliquid: {" + liquid + "}\n");
  };
  EXPECT_THAT(error_of("radius: 0.036, fill: 0.09, rim: 0.085"),
              AllOf(HasSubstr("tea.yaml: liquid.fill is '0.09', wanted at most the rim, 0.085 m"),
                    HasSubstr("line 5")));
  EXPECT_THAT(
      error_of("radius: 0.04, fill: 0.07, rim: 0.085"),
      AllOf(HasSubstr("liquid.radius is '0.04', wanted at most 0.038"), HasSubstr("line 5")));
  EXPECT_THAT(error_of("radius: 0.036, fill: 0.07, rim: 0.1"),
              HasSubstr("liquid.rim is '0.1', wanted at most 0.09"));
  EXPECT_THAT(error_of("radius: 36, fill: 0.07, rim: 0.085"),
              HasSubstr("liquid.radius is '36', wanted between 0.001 and 10"));
  EXPECT_THAT(error_of("radius: 0.036, fill: -1, rim: 0.085"), HasSubstr("liquid.fill is '-1'"));
  EXPECT_THAT(error_of("radius: 0.036"), HasSubstr("liquid.fill, liquid.rim are missing"));
  EXPECT_THAT(error_of("radius: 0.036, fill: 0.07, rim: 0.085, color: red"), HasSubstr("color"));
}

TEST_F(ObjectModelTest, VesselsMayHoldALiquidThatNobodyDescribes) {
  const auto may_hold = [&](const std::string& file, const std::string& kind,
                            const std::string& shape) {
    ObjectModel model =
        LoadObjectModel(folder_.Write(file, "{shape: " + shape + ", height: 0.1, mass: 0.3}"));
    model.concept_name = kind;
    return MayHoldUnknownLiquid(model);
  };
  const std::string round = "cylinder, radius: 0.04", box = "box, depth: 0.1, width: 0.1";
  EXPECT_TRUE(may_hold("x.yaml", "", round)) << "nothing says what it is";
  EXPECT_FALSE(may_hold("x.yaml", "", box));
  EXPECT_TRUE(may_hold("milk_bottle.yaml", "", box));
  EXPECT_TRUE(may_hold("x.yaml", "WineGlass", round));
  EXPECT_FALSE(may_hold("x.yaml", "Peppermill", round));
}

TEST_F(ObjectModelTest, UrdfGivesMassShapeAndFriction) {
  const ObjectModel can = LoadObjectModel(folder_.Write(
      "can.urdf",
      CanUrdf(kCanShape, "<gazebo reference='body'><mu1>0.6</mu1><mu2>0.6</mu2></gazebo>")));
  EXPECT_EQ(can.name, "can");
  EXPECT_EQ(can.mass_properties.mass, 0.3);
  EXPECT_EQ(can.mass_properties.p_BBcm, Eigen::Vector3d(0, 0, 0.1));
  EXPECT_EQ(can.mass_properties.I_BBcm(2, 2), 0.001);
  ASSERT_EQ(can.collisions.size(), 1u);
  EXPECT_EQ(std::get<geometry::Cylinder>(can.collisions[0].shape).length, 0.2);
  EXPECT_NEAR(geometry::YawOf(can.collisions[0].X_BS.rotation), 1.0, 1e-12);
  EXPECT_EQ(can.collisions[0].friction, 0.6);
}

/// What simulators of the field read.
TEST_F(ObjectModelTest, UrdfFrictionIsTheSmallestThatIsSaidInWhateverForm) {
  const auto load = [&](const std::string& in_link, const std::string& in_gazebo) {
    return LoadObjectModel(folder_.Write(
        "can.urdf",
        CanUrdf(kCanShape + in_link, "<gazebo reference='body'>" + in_gazebo +
                                         "</gazebo>"
                                         "<gazebo reference='other'><mu1>0.001</mu1></gazebo>")));
  };
  const std::string contact = "<contact><lateral_friction value='0.02'/></contact>";
  const std::vector<std::tuple<std::string, std::string, double>> cases{
      {"", "", 1.0},
      {contact, "", 0.02},
      {contact, "<mu1>0.3</mu1>", 0.02},
      {"", "<mu1>1.0</mu1><mu2>0.05</mu2>", 0.05},
      {"", "<mu2>0.05</mu2>", 0.05},
      {"", "<mu1 value='0.3'/>", 0.3},
      {"", "<mu1 value='0.3'/><mu2 value='0.2'/>", 0.2},
      {"",
       "<collision><surface><friction><ode><mu>0.05</mu></ode></friction></surface></collision>",
       0.05}};
  for (const auto& [in_link, in_gazebo, wanted] : cases) {
    const ObjectModel can = load(in_link, in_gazebo);
    EXPECT_EQ(can.collisions.at(0).friction, wanted) << in_link << in_gazebo;
    EXPECT_THAT(can.notes, testing::IsEmpty()) << in_link << in_gazebo;
  }
  for (const std::string endless : {"inf", "-1"}) {
    const ObjectModel can = load("", "<mu1>" + endless + "</mu1>");
    EXPECT_EQ(can.collisions.at(0).friction, 1000.0);
    EXPECT_THAT(can.notes, ElementsAre(AllOf(HasSubstr("<mu1>"), HasSubstr("can.urdf:6"))));
  }
}

TEST_F(ObjectModelTest, UrdfAndSdfOfOneObjectAgree) {
  const ObjectModel urdf = LoadObjectModel(folder_.Write(
      "cube.urdf",
      "<robot name='cube'><link name='body'><inertial><origin xyz='0 0 0.05'/><mass value='1'/>"
      "<inertia ixx='0.002' ixy='0' ixz='0' iyy='0.002' iyz='0' izz='0.002'/></inertial>"
      "<collision name='c'><origin xyz='0 0 0.05'/><geometry><box size='0.1 0.1 0.1'/></geometry>"
      "</collision></link></robot>"));
  const ObjectModel sdf = LoadObjectModel(folder_.Write("cube.sdf", ModelFile(LooseCube("cube"))));
  EXPECT_EQ(WithModel({}, urdf).hash, WithModel({}, sdf).hash);
}

TEST_F(ObjectModelTest, UrdfMeshIsFound) {
  folder_.Write("cube.obj", kCubeObj);
  const ObjectModel thing = LoadObjectModel(folder_.Write(
      "thing.urdf", CanUrdf("<collision><geometry><mesh filename='cube.obj' scale='0.1 0.1 0.1'/>"
                            "</geometry></collision>")));
  EXPECT_EQ(std::get<MeshPtr>(thing.collisions.at(0).shape)->triangles.size(), 12u);
}

TEST_F(ObjectModelTest, AMeshThatIsHardlyInMetresIsANoteOfItsObject) {
  folder_.Write("cube.obj", kCubeObj);
  const ObjectModel urdf = LoadObjectModel(folder_.Write(
      "thing.urdf", CanUrdf("<collision><geometry><mesh filename='cube.obj' scale='60 60 240'/>"
                            "</geometry></collision>")));
  EXPECT_THAT(urdf.notes, testing::Contains(AllOf(HasSubstr("cube.obj is 60 x 60 x 240 m large"),
                                                  HasSubstr("scale=\"0.06 0.06 0.24\""))));
  const ObjectModel sdf =
      LoadObjectModel(folder_.Write("thing.sdf", WithShape(MeshShape("cube.obj", "60 60 240"))));
  EXPECT_THAT(sdf.notes, testing::Contains(AllOf(HasSubstr("cube.obj is 60 x 60 x 240 m large"),
                                                 HasSubstr("<scale>0.06 0.06 0.24</scale>"))));
}

TEST_F(ObjectModelTest, AMissingMeshIsNoOtherKindOfFile) {
  const auto error_of = [&](const std::string& ending, const std::string& mesh) {
    return ending == ".sdf" ? ErrorOf("cup.sdf", WithShape(MeshShape(mesh)))
                            : ErrorOf("cup.urdf", CanUrdf("<collision><geometry><mesh filename='" +
                                                          mesh + "'/></geometry></collision>"));
  };
  for (const char* ending : {".sdf", ".urdf"}) {
    for (const char* mesh : {"cup.stl", "cup.obj", "cup.dae", "cups.stl"}) {
      EXPECT_THAT(error_of(ending, mesh),
                  AllOf(HasSubstr("is not there"), testing::Not(HasSubstr("did you mean"))))
          << ending << mesh;
    }
  }
  folder_.Write("cap.stl", "");
  EXPECT_THAT(error_of(".sdf", "cup.stl"), HasSubstr("did you mean '" + folder_.path("cap.stl")));
}

TEST_F(ObjectModelTest, RefusesUrdfThatIsNoObject) {
  const auto error_of = [&](const std::string& text) { return ErrorOf("a.urdf", text); };
  EXPECT_THAT(error_of("<robot name='a'><link name='b'>"), HasSubstr("a.urdf:1"));
  EXPECT_THAT(error_of("<sdf/>"), HasSubstr("no valid URDF"));
  EXPECT_THAT(error_of(CanUrdf("")), AllOf(HasSubstr("link 'body'"), HasSubstr("no <collision>")));
  EXPECT_THAT(error_of("<robot name='a'><link name='b'/></robot>"), HasSubstr("no <inertial>"));
  EXPECT_THAT(error_of(CanUrdf(kCanShape,
                               "<link name='lid'/><joint name='j' type='fixed'><parent "
                               "link='body'/><child link='lid'/></joint>")),
              AllOf(HasSubstr("2 links"), HasSubstr("merge")));
  EXPECT_THAT(
      error_of(CanUrdf("<collision><geometry><sphere radius='-1'/></geometry></collision>")),
      HasSubstr("size of -1 m"));
  EXPECT_THAT(error_of(CanUrdf("<collision><origin xyz='5000 0 0'/><geometry><sphere radius='1'/>"
                               "</geometry></collision>")),
              HasSubstr("farther than 1000 m"));
  EXPECT_THAT(error_of(CanUrdf(kCanShape, "<gazebo reference='body'><mu1>x</mu1></gazebo>")),
              AllOf(HasSubstr("a.urdf:6"), HasSubstr("<mu1>")));
  std::string heavy = CanUrdf(kCanShape);
  heavy.replace(heavy.find("izz='0.001'"), 11, "izz='0.100'");
  EXPECT_THAT(error_of(heavy), HasSubstr("triangle inequality"));
}

/// A can that is 0.24 m high and 0.04 m thick, as URDF and as SDF.
std::string TallUrdf(const std::string& moment_x, const std::string& moment_z) {
  return "<robot name='tall'><link name='l'><inertial><origin xyz='0 0 0.12'/><mass value='0.3'/>"
         "<inertia ixx='" +
         moment_x + "' ixy='0' ixz='0' iyy='" + moment_x + "' iyz='0' izz='" + moment_z +
         "'/></inertial><collision><origin xyz='0 0 0.12'/><geometry><cylinder radius='0.02' "
         "length='0.24'/></geometry></collision></link></robot>";
}
std::string TallSdf(const std::string& moment_x, const std::string& moment_z) {
  return "<model name='tall'><link name='l'><inertial><pose>0 0 0.12 0 0 0</pose><mass>0.3</mass>"
         "<inertia><ixx>" +
         moment_x + "</ixx><iyy>" + moment_x + "</iyy><izz>" + moment_z +
         "</izz></inertia></inertial><collision name='c'><pose>0 0 0.12 0 0 0</pose><geometry>"
         "<cylinder><radius>0.02</radius><length>0.24</length></cylinder></geometry></collision>"
         "</link></model>";
}

TEST_F(ObjectModelTest, AnInertiaThatNoSuchBodyHasBecomesTheSolidsAndIsSaid) {
  const Eigen::Matrix3d solid = geometry::SolidInertia(geometry::Cylinder{0.02, 0.24}, 0.3);
  for (const std::string wrong : {"1", "1e-7", "0.03"}) {
    const ObjectModel urdf = LoadObjectModel(folder_.Write("tall.urdf", TallUrdf(wrong, wrong)));
    const ObjectModel sdf =
        LoadObjectModel(folder_.Write("tall.sdf", ModelFile(TallSdf(wrong, wrong))));
    const World world = LoadWorld(folder_.Write("tall.world", WorldText(TallSdf(wrong, wrong))));
    const ObjectModel& in_world = *world.ModelOf(world.initial.objects.at(0));
    for (const ObjectModel* tall : {&urdf, &sdf, &in_world}) {
      EXPECT_TRUE(tall->mass_properties.I_BBcm.isApprox(solid, 1e-9)) << wrong;
      EXPECT_EQ(tall->mass_properties.mass, 0.3);
      EXPECT_EQ(tall->mass_properties.p_BBcm, Eigen::Vector3d(0, 0, 0.12));
    }
    const auto says = ElementsAre(AllOf(HasSubstr("tall."), HasSubstr("principal moments"),
                                        HasSubstr("solid of its shapes is taken, 6e-05, 0.00147")));
    EXPECT_THAT(urdf.notes, says);
    EXPECT_THAT(sdf.notes, says);
    EXPECT_THAT(world.notes, says);
  }
}

TEST_F(ObjectModelTest, AMassWithoutInertiaTakesTheSolidsAndSaysSo) {
  const Eigen::Matrix3d solid = geometry::SolidInertia(geometry::Cylinder{0.02, 0.24}, 0.3);
  const auto without_inertia = [](std::string text, const std::string& end) {
    const std::size_t at = text.find("<inertia "),
                      from = at < text.size() ? at : text.find("<inertia>");
    return text.erase(from, text.find(end, from) + end.size() - from);
  };
  const std::string sdf = without_inertia(TallSdf("1", "1"), "</inertia>");
  for (const std::string& path :
       {folder_.Write("tall.urdf", without_inertia(TallUrdf("1", "1"), "/>")),
        folder_.Write("tall.sdf", ModelFile(sdf))}) {
    const ObjectModel tall = LoadObjectModel(path);
    EXPECT_TRUE(tall.mass_properties.I_BBcm.isApprox(solid, 1e-9)) << path;
    EXPECT_EQ(tall.mass_properties.mass, 0.3);
    EXPECT_EQ(tall.mass_properties.p_BBcm, Eigen::Vector3d(0, 0, 0.12));
    EXPECT_THAT(
        tall.notes,
        ElementsAre(HasSubstr("without <inertia>: that of a solid of its shapes is taken, 6e-05")));
  }
  std::string none = sdf;
  none.replace(none.find("<mass>0.3"), 9, "<mass>0");
  EXPECT_THAT(ErrorOf("none.sdf", ModelFile(none)), HasSubstr("mass"));
}

TEST_F(ObjectModelTest, AnInertiaThatABodyMayHaveStaysToTheBit) {
  for (const std::string right : {"0.00147", "0.0005", "0.004"}) {
    const ObjectModel urdf = LoadObjectModel(folder_.Write("tall.urdf", TallUrdf(right, "0.0001")));
    EXPECT_EQ(urdf.mass_properties.I_BBcm(0, 0), std::stod(right));
    EXPECT_EQ(urdf.mass_properties.I_BBcm(2, 2), 0.0001);
    EXPECT_THAT(urdf.notes, testing::IsEmpty());
    const ObjectModel sdf =
        LoadObjectModel(folder_.Write("tall.sdf", ModelFile(TallSdf(right, "0.0001"))));
    EXPECT_EQ(sdf.mass_properties.I_BBcm, urdf.mass_properties.I_BBcm);
    EXPECT_THAT(sdf.notes, testing::IsEmpty());
  }
}

/// A can of 0.12 m whose middle is at this height over its origin, as URDF and as SDF.
std::string CanWithMiddleAt(double z, bool is_urdf) {
  if (is_urdf) {
    return fmt::format(
        "<robot name='can'><link name='l'><inertial><origin xyz='0 0 {0}'/><mass value='0.3'/>"
        "<inertia ixx='0.0005' ixy='0' ixz='0' iyy='0.0005' iyz='0' izz='0.0002'/></inertial>"
        "<collision><origin xyz='0 0 {0}'/><geometry><cylinder radius='0.03' length='0.12'/>"
        "</geometry></collision></link></robot>",
        z);
  }
  return fmt::format(
      "<model name='can'><pose>1 2 3 0 0 0</pose><link name='l'><pose>0 0 {} 0 0 0</pose><inertial>"
      "<mass>0.3</mass><inertia><ixx>0.0005</ixx><iyy>0.0005</iyy><izz>0.0002</izz></inertia>"
      "</inertial><collision name='c'><geometry><cylinder><radius>0.03</radius><length>0.12"
      "</length></cylinder></geometry></collision></link></model>",
      z);
}

TEST_F(ObjectModelTest, NamesThatRequestsDoNotKnowBecomePlainOnesAndAreSaid) {
  const std::vector<std::pair<std::string, std::string>> names{
      {"can", "can"},           {"can_2", "can_2"}, {"a__b", "a__b"},      {"Coke Can", "Coke_Can"},
      {"can.urdf", "can_urdf"}, {"can-2", "can_2"}, {"can (1)", "can_1_"}, {"T\u00fcte", "T_te"}};
  for (const auto& [name, plain] : names) {
    for (const bool is_urdf : {true, false}) {
      std::string text = CanWithMiddleAt(0.06, is_urdf);
      text.replace(text.find("name='can'"), 10, "name='" + name + "'");
      const std::string path =
          folder_.Write(is_urdf ? "can.urdf" : "can.sdf", is_urdf ? text : ModelFile(text));
      const ObjectModel can = LoadObjectModel(path);
      EXPECT_EQ(can.name, plain);
      EXPECT_EQ(ObjectNameIn(path), plain);
      if (name == plain) {
        EXPECT_THAT(can.notes, testing::IsEmpty()) << name;
      } else {
        EXPECT_THAT(can.notes,
                    ElementsAre(AllOf(HasSubstr("it is " + plain), HasSubstr("'" + name + "'"))));
      }
    }
  }
}

TEST_F(ObjectModelTest, AFileOfSeveralModelsIsRefusedWithTheirNumber) {
  for (int count = 2; count < 5; ++count) {
    std::string models;
    for (int i = 0; i < count; ++i) {
      std::string text = CanWithMiddleAt(0.06, false);
      models += text.replace(text.find("'can'"), 5, fmt::format("'can{}'", i));
    }
    try {
      LoadObjectModel(folder_.Write("cans.sdf", ModelFile(models)));
      ADD_FAILURE() << count;
    } catch (const base::ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(fmt::format("has {} <model> elements", count)));
    }
  }
}

/// A can as high as it is wide, all lengths and the mass times a factor.
std::string CanTimes(double length, double mass, double com_height, bool is_urdf) {
  const double moment = 0.12 * mass * length * length;
  if (is_urdf) {
    return fmt::format(
        "<robot name='can'><link name='l'><inertial><origin xyz='0 0 {0}'/><mass value='{1}'/>"
        "<inertia ixx='{2}' ixy='0' ixz='0' iyy='{2}' iyz='0' izz='{2}'/></inertial><collision>"
        "<origin xyz='0 0 {3}'/><geometry><cylinder radius='{3}' length='{4}'/></geometry>"
        "</collision></link></robot>",
        com_height, mass, moment, 0.5 * length, length);
  }
  return fmt::format(
      "<model name='can'><link name='l'><inertial><pose>0 0 {0} 0 0 "
      "0</pose><mass>{1}</mass><inertia>"
      "<ixx>{2}</ixx><iyy>{2}</iyy><izz>{2}</izz></inertia></inertial><collision name='c'>"
      "<pose>0 0 {3} 0 0 0</pose><geometry><cylinder><radius>{3}</radius><length>{4}</length>"
      "</cylinder></geometry></collision></link></model>",
      com_height, mass, moment, 0.5 * length, length);
}

TEST_F(ObjectModelTest, WhatSuggestsOtherUnitsOrAMassElsewhereIsSaidAndStays) {
  struct Case {
    double length, mass, com_height;
    std::string said;  // "": nothing
  };
  const std::vector<Case> cases{{0.1, 0.3, 0.05, ""},
                                {0.1, 15.0, 0.05, ""},  // gold
                                {0.1, 300.0, 0.05, "in grams it would be 0.3 kg"},
                                {10.0, 0.3, 5.0, "in mm it would be 0.01 x 0.01 x 0.01 m"},
                                {0.1, 0.3, 0.105, ""},
                                {0.1, 0.3, 0.5, "lies 0.4 m outside"},
                                {0.1, 0.3, -0.2, "lies 0.2 m outside"}};
  for (const Case& each : cases) {
    for (const bool is_urdf : {true, false}) {
      const std::string text = CanTimes(each.length, each.mass, each.com_height, is_urdf);
      const ObjectModel can = LoadObjectModel(
          folder_.Write(is_urdf ? "can.urdf" : "can.sdf", is_urdf ? text : ModelFile(text)));
      EXPECT_EQ(can.mass_properties.mass, each.mass);
      if (each.said.empty()) {
        EXPECT_THAT(can.notes, testing::IsEmpty()) << each.mass << " " << each.com_height;
      } else {
        EXPECT_THAT(can.notes, testing::Contains(AllOf(HasSubstr(each.said), HasSubstr("'can'"))));
      }
    }
  }
  const World world =
      LoadWorld(folder_.Write("can.world", WorldText(CanTimes(0.1, 300.0, 0.05, false))));
  EXPECT_THAT(world.notes,
              ElementsAre(AllOf(HasSubstr("1 model whose 300 kg"), HasSubstr("'can'"))));
}

TEST_F(ObjectModelTest, AnObjectOfAFileStandsOnItsLowestPointWhereverItsOriginIs) {
  for (const bool is_urdf : {true, false}) {
    for (const double middle : {-0.3, -0.06, 0.0, 0.0595, 0.06, 0.0600001, 0.11, 5.0}) {
      const std::string text = CanWithMiddleAt(middle, is_urdf);
      const ObjectModel can = LoadObjectModel(
          folder_.Write(is_urdf ? "can.urdf" : "can.sdf", is_urdf ? text : ModelFile(text)));
      const geometry::Collision& shape = can.collisions.at(0);
      EXPECT_NEAR(geometry::BoundsOf(shape.shape, shape.X_BS).lower.z(), 0.0, 1e-6) << middle;
      EXPECT_TRUE(can.mass_properties.p_BBcm.isApprox(shape.X_BS.translation, 1e-9)) << middle;
      const double off = middle - 0.06;
      if (std::abs(off) < 1e-3) {
        EXPECT_THAT(can.notes, testing::IsEmpty()) << middle;
      } else {
        EXPECT_THAT(can.notes, ElementsAre(AllOf(HasSubstr(fmt::format("{:.3f} m", std::abs(off))),
                                                 HasSubstr(off < 0.0 ? "above" : "below"),
                                                 HasSubstr("'can'"))))
            << middle;
      }
    }
  }
}

TEST_F(ObjectModelTest, AModelOfAWorldKeepsItsOrigin) {
  const World world = LoadWorld(folder_.Write("w.world", WorldText(CanWithMiddleAt(0.0, false))));
  const ObjectState& can = world.initial.objects.at(0);
  EXPECT_EQ(can.X_MO.translation.z(), 3.0);
  EXPECT_EQ(world.ModelOf(can)->collisions.at(0).X_BS.translation.z(), 0.0);
}

TEST_F(ObjectModelTest, ObjectsOfTheCatalogueStandOnTheirOriginToTheBit) {
  for (const auto& [instance, model] :
       LoadCatalogueModels(HIRES_SOURCE_DIR "/worlds/objects.yaml")) {
    geometry::Aabb bounds;
    for (const geometry::Collision& shape : model->collisions)
      bounds.Include(geometry::BoundsOf(shape.shape, shape.X_BS));
    EXPECT_EQ(bounds.lower.z(), 0.0) << instance;
    EXPECT_THAT(model->notes, testing::IsEmpty()) << instance;
  }
}

TEST_F(ObjectModelTest, UrdfErrorsAreNotPrinted) {
  testing::internal::CaptureStderr();
  ErrorOf("a.urdf", "<robot name='a'/>");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// --- the catalogue -----------------------------------------------------------------------------

class CatalogueTest : public ObjectModelTest {
 protected:
  CatalogueTest() {
    folder_.Write("models/coffee_cup/model.sdf", ModelFile(LooseCube("coffee_cup")));
    Catalogue("mug1: coffee_cup\nlost1: gone\n");
  }
  void Catalogue(const std::string& text) { path_ = folder_.Write("objects.yaml", text); }
  std::string CatalogueError(const std::string& text) {
    Catalogue(text);
    return MessageOf<base::ConfigError>([&] { LoadObjectCatalogue(path_); });
  }
  std::string path_;
};

TEST_F(CatalogueTest, NamesFoldersAndPathsLeadToTheSameModel) {
  for (const std::string& name :
       {std::string("mug1"), std::string("MUG1"), std::string("coffee_cup"),
        folder_.path("models/coffee_cup/model.sdf")}) {
    EXPECT_EQ(FindObjectModel(name, path_).name, "coffee_cup") << name;
  }
}

TEST_F(CatalogueTest, ModelsKnowTheConceptThatStandsForTheirFolder) {
  EXPECT_EQ(FindObjectModel("mug1", path_).concept_name, "") << "the file names none";
  Catalogue("mug1: coffee_cup\nconcepts: {Coffee_Cup: Mug}\n");
  EXPECT_EQ(LoadObjectCatalogue(path_).size(), 1u) << "the block is no instance";
  EXPECT_EQ(FindObjectModel("mug1", path_).concept_name, "Mug");
  EXPECT_EQ(LoadCatalogueModels(path_).at("mug1")->concept_name, "Mug");
  Catalogue("mug1: coffee_cup\nconcepts: {coffee_mug: Mug}\n");
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadCatalogueModels(path_); }),
              AllOf(HasSubstr("coffee_mug"), HasSubstr("'coffee_cup'")));
}

TEST_F(CatalogueTest, ModelsKnowTheLiquidInTheirFolder) {
  Catalogue("mug1: coffee_cup\nliquids: {Coffee_Cup: {radius: 0.036, fill: 0.07, rim: 0.08}}\n");
  EXPECT_EQ(LoadObjectCatalogue(path_).size(), 1u);
  EXPECT_EQ(FindObjectModel("mug1", path_).liquid.value().fill, 0.07);
  EXPECT_EQ(LoadCatalogueModels(path_).at("mug1")->liquid.value().rim, 0.08);
  Catalogue("mug1: coffee_cup\nliquids: {coffee_cup: {radius: 0.036, fill: 0.09, rim: 0.08}}\n");
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadCatalogueModels(path_); }),
              AllOf(HasSubstr("liquids.coffee_cup.fill is '0.09'"), HasSubstr("line 2")));
}

TEST_F(CatalogueTest, UnknownNamesGetTheNearestOnes) {
  const auto error_of = [&](const std::string& name) {
    return MessageOf<base::ConfigError>([&] { FindObjectModel(name, path_); });
  };
  EXPECT_THAT(error_of("mug"), AllOf(HasSubstr("object 'mug' is unknown"), HasSubstr("'mug1'")));
  EXPECT_THAT(error_of("lost1"), AllOf(HasSubstr("lost1"), HasSubstr("'gone'")));
}

TEST_F(CatalogueTest, RefusesWhatIsNoMapOfNamesToFolders) {
  EXPECT_THAT(CatalogueError("- mug1\n"), HasSubstr("wanted a map"));
  EXPECT_THAT(CatalogueError("mug1: [a, b]\n"), HasSubstr("mug1"));
  EXPECT_THAT(CatalogueError("mug1: ../secret\n"), HasSubstr("folder in models/"));
  EXPECT_THAT(CatalogueError("mug1: a\nMug1: b\n"), AllOf(HasSubstr("Mug1"), HasSubstr("mug1")));
  EXPECT_THAT(CatalogueError("mug1: a\nmug1: b\n"), HasSubstr("twice"));
  EXPECT_THAT(CatalogueError("mug1: {\n"), HasSubstr("objects.yaml"));
}

}  // namespace
}  // namespace hires::world::object_model_test
