// Worlds as people have them: what no question needs refuses nothing, and what is left out is said.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/inertia.h"
#include "hires/world/occupancy_grid.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::wild_world_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const char kBadInertial[] =
    "<inertial><mass>10</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>9</izz></inertia>"
    "</inertial>";

std::string Inertial(double mass, double moment) {
  return fmt::format(
      "<inertial><mass>{}</mass><inertia><ixx>{}</ixx><iyy>{}</iyy><izz>{}</izz></inertia>"
      "</inertial>",
      mass, moment, moment, moment);
}

std::string Link(const std::string& name, const std::string& pose, const std::string& more,
                 const std::string& shape = kUnitBox) {
  return fmt::format(
      "<link name='{}'><pose>{}</pose>{}<collision name='c'><geometry>{}</geometry></collision>"
      "</link>",
      name, pose, more, shape);
}

std::string Joint(const std::string& type, const std::string& parent, const std::string& child) {
  return fmt::format("<joint name='j_{}' type='{}'><parent>{}</parent><child>{}</child></joint>",
                     child.substr(0, 1), type, parent, child);
}

std::string Model(const std::string& name, const std::string& content) {
  return fmt::format("<model name='{}'>{}</model>\n", name, content);
}

class WildWorldTest : public testing::Test {
 protected:
  WildWorldTest() {
    base::SetLogSink([this](base::LogLevel, const std::string& line) { log_ += line + "\n"; });
  }
  ~WildWorldTest() override { base::SetLogSink({}); }

  World Load(const std::string& content, const std::string& version = "1.7") const {
    std::string text = WorldText(content);
    text.replace(text.find("1.7"), 3, version);
    return LoadWorld(folder_.Write("test.world", text));
  }
  std::string ErrorOf(const std::string& content, const std::string& version = "1.7") const {
    return MessageOf<base::ConfigError>([&] { Load(content, version); });
  }
  void WriteModel(const std::string& name, const std::string& model,
                  const std::string& folder = "models") const {
    folder_.Write(folder + "/" + name + "/model.sdf", ModelFile(model));
    folder_.Write(folder + "/" + name + "/model.config", ModelConfig(name));
  }

  TempFolder folder_;
  std::string log_;
};

// --- URDFs that are included ---------------------------------------------------------------------

/// A rack of two links, and what its links have beside their shapes.
std::string RackUrdf(const std::string& joint_type, const std::string& in_foot,
                     const std::string& in_board) {
  return "<robot name='rack'><link name='base'/><link name='foot'>" + in_foot +
         "<collision><origin xyz='0 0 0.5'/><geometry><box size='0.1 0.1 "
         "1'/></geometry></collision>"
         "</link><link name='board'>" +
         in_board +
         "<collision><geometry><box size='0.5 0.5 0.02'/></geometry></collision></link>"
         "<joint name='j' type='fixed'><parent link='base'/><child link='foot'/></joint>"
         "<joint name='k' type='" +
         joint_type +
         "'><parent link='foot'/><child link='board'/><origin xyz='0 0 1'/><axis xyz='0 0 1'/>"
         "<limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>";
}

TEST_F(WildWorldTest, LinksOfUrdfsWithoutMassStandWithTheOthers) {
  const std::string mass =
      "<inertial><mass value='2'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/>"
      "</inertial>";
  const std::string none =
      "<inertial><mass value='0'/><inertia ixx='0' ixy='0' ixz='0' iyy='0' "
      "iyz='0' izz='0'/></inertial>";
  folder_.Write("models/rack/model.config",
                "<model><name>rack</name><version>1.0</version><sdf version='1.7'>model.urdf</sdf>"
                "</model>");
  for (const std::string joint : {"fixed", "revolute"}) {
    for (const std::string& in_foot : {std::string(), none, mass}) {
      for (const std::string& in_board : {std::string(), none, mass}) {
        folder_.Write("models/rack/model.urdf", RackUrdf(joint, in_foot, in_board));
        const World world = Load("<include><uri>model://rack</uri><static>true</static></include>");
        ASSERT_EQ(world.statics.size(), 1u) << joint << in_foot << in_board;
        EXPECT_EQ(world.statics[0].collisions.size(), 2u) << joint << in_foot << in_board;
        EXPECT_THAT(world.notes, IsEmpty());
      }
    }
  }
}

TEST_F(WildWorldTest, AUrdfOfNoMassThatIsNotStaticStandsStillForThatReason) {
  folder_.Write("models/rack/model.config",
                "<model><name>rack</name><version>1.0</version><sdf version='1.7'>model.urdf</sdf>"
                "</model>");
  folder_.Write("models/rack/model.urdf", RackUrdf("fixed", "", ""));
  const World world = Load("<include><uri>model://rack</uri></include>");
  ASSERT_EQ(world.statics.size(), 1u);
  EXPECT_THAT(world.notes, ElementsAre(HasSubstr("without mass or inertia")));
}

// --- what stands still ---------------------------------------------------------------------------

TEST_F(WildWorldTest, InertialsOfWhatStandsStillAreNotRead) {
  for (const std::string& bad :
       {std::string(kBadInertial), Inertial(0, 0), Inertial(-1, std::nan("")),
        std::string("<inertial><mass>heavy</mass></inertial>"), std::string("<inertial/>")}) {
    const std::string link = Link("l", "0 0 0 0 0 0", bad);
    WriteModel("rug", Model("rug", link));
    const World world = Load(
        StaticModel("by_itself", link) + Model("by_joint", link + Joint("fixed", "world", "l")) +
        Model("by_joint_turned", link + Joint("fixed", "l", "world")) +
        StaticModel("by_wrapper", Model("inner", link)) +
        "<include><uri>model://rug</uri><name>by_include</name><static>true</static></include>" +
        Model("by_what_it_holds", "<include><uri>model://rug</uri><static>1</static></include>"));
    EXPECT_EQ(world.statics.size(), 6u) << bad;
    EXPECT_THAT(world.notes, IsEmpty()) << bad;
    EXPECT_THAT(ErrorOf(Model("rug", Link("l", "0 0 0 0 0 0", kBadInertial))),
                AllOf(HasSubstr("test.world:3"), HasSubstr("triangle inequality")));
  }
}

TEST_F(WildWorldTest, AWrapperStandsWhereItsPosesPutIt) {
  WriteModel("crate", StaticModel("crate", Link("l", "0 0 0.5 0 0 0", "")));
  const World world =
      Load(Model("crate_1",
                 "<pose>2 1 0 0 0 1.5707963267948966</pose><include><uri>model://crate</uri>"
                 "<pose>1 0 0 0 0 0</pose></include>"));
  ASSERT_EQ(world.statics.size(), 1u);
  EXPECT_EQ(world.statics[0].name, "crate_1");
  const auto X_MS = world.statics[0].X_MB * world.statics[0].collisions[0].X_BS;
  EXPECT_TRUE(X_MS.translation.isApprox(Eigen::Vector3d(2, 2, 0.5), 1e-12));
  EXPECT_THAT(world.notes, IsEmpty());
}

TEST_F(WildWorldTest, AWrapperRoundALooseModelIsALooseThingOfItsName) {
  WriteModel("mug", LooseCube("mug"));
  const World world = Load(Model("my_mug",
                                 "<pose>2 1 0 0 0 0</pose><include><uri>model://mug</uri>"
                                 "<pose>0 0 1 0 0 0</pose></include>"));
  ASSERT_EQ(world.initial.objects.size(), 1u);
  EXPECT_EQ(world.initial.objects[0].name, "my_mug");
  const ObjectModel& mug = *world.ModelOf(world.initial.objects[0]);
  EXPECT_EQ(mug.mass_properties.mass, 1.0);
  EXPECT_TRUE(mug.mass_properties.p_BBcm.isApprox(Eigen::Vector3d(0, 0, 1.05), 1e-12));
}

TEST_F(WildWorldTest, LinksThatFixedJointsHoldTogetherAreOneThing) {
  const World world =
      Load(Model("desk", Link("top", "0 0 1 0 0 0", Inertial(3, 1)) +
                             Model("cabinet", "<pose>0 2 0 0 0 0</pose>" +
                                                  Link("box", "0 0 0 0 0 0", Inertial(1, 0.5))) +
                             "<link name='mark'/>" + Joint("fixed", "top", "cabinet::box")));
  ASSERT_EQ(world.initial.objects.size(), 1u);
  const geometry::MassProperties& mass = world.ModelOf(world.initial.objects[0])->mass_properties;
  EXPECT_EQ(mass.mass, 4.0);
  EXPECT_TRUE(mass.p_BBcm.isApprox(Eigen::Vector3d(0, 0.5, 0.75), 1e-12));
  // Steiner: 3 kg at (0, -0.5, 0.25) and 1 kg at (0, 1.5, -0.75) from the centre of both.
  EXPECT_NEAR(mass.I_BBcm(0, 0), 1.5 + 3 * (0.25 + 0.0625) + 2.25 + 0.5625, 1e-12);
  EXPECT_NEAR(mass.I_BBcm(1, 1), 1.5 + 3 * 0.0625 + 0.5625, 1e-12);
  EXPECT_NEAR(mass.I_BBcm(2, 2), 1.5 + 3 * 0.25 + 2.25, 1e-12);
  EXPECT_NEAR(mass.I_BBcm(1, 2), 3 * 0.125 + 1.125, 1e-12);
  EXPECT_EQ(world.ModelOf(world.initial.objects[0])->collisions.size(), 2u);
  EXPECT_THAT(world.notes, IsEmpty());
}

TEST_F(WildWorldTest, WhatHasJointsStandsAtJointZeroAndIsSaidOnce) {
  const auto door = [](const std::string& name, const std::string& type) {
    return Model(name, "<pose>2 2 0 0 0 0</pose>" + Link("frame", "0 0 0 0 0 0", kBadInertial) +
                           Link("leaf", "0 1 0 0 0 0", "") + Joint("fixed", "world", "frame") +
                           Joint(type, "frame", "leaf"));
  };
  const World world = Load(door("a", "revolute") + door("b", "prismatic") + door("c", "screw") +
                           door("d", "gearbox") + door("e", "universal"));
  EXPECT_TRUE(world.initial.objects.empty());
  ASSERT_EQ(world.statics.size(), 5u);
  const StaticBody& first = world.statics[0];
  ASSERT_EQ(first.collisions.size(), 2u);
  EXPECT_EQ(first.collisions[1].name, "leaf::c");
  EXPECT_EQ((first.X_MB * first.collisions[1].X_BS).translation, Eigen::Vector3d(2, 3, 0));
  ASSERT_EQ(world.notes.size(), 1u);
  EXPECT_THAT(world.notes[0], AllOf(HasSubstr("5 models with joints"), HasSubstr("joint zero"),
                                    HasSubstr("test.world:3 'a'")));
  EXPECT_THAT(log_, HasSubstr(world.notes[0]));
}

TEST_F(WildWorldTest, JointsThatJoinWhatIsNotThereLetTheModelStandStill) {
  const std::string links =
      Link("base", "0 0 0 0 0 0", Inertial(1, 1)) + "\n" + Link("camera", "0 0 1 0 0 0", "");
  const auto expect = [&](const std::string& joints, const std::string& said, int line) {
    for (const char* version : {"1.4", "1.6", "1.7", "1.9", "1.11"}) {
      const World world = Load(Model("bot", links + joints), version);
      EXPECT_TRUE(world.initial.objects.empty()) << joints;
      ASSERT_EQ(world.statics.size(), 1u) << joints;
      EXPECT_EQ(world.statics[0].collisions.size(), 2u);
      EXPECT_EQ(base::Split(base::Join(world.notes, "\n"), '\n').size(),
                version == std::string("1.11") ? 2u : 1u);
      EXPECT_THAT(base::Join(world.notes, "\n"),
                  AllOf(HasSubstr(said), HasSubstr("stands still where it is at joint zero"),
                        HasSubstr(fmt::format("test.world:{} 'bot'", line))));
    }
  };
  const std::string good = Joint("fixed", "base", "camera");
  expect(good + "\n" + Joint("fixed", "camera", "rgb_camera"),
         "1 model with a joint 'j_r' whose <child> 'rgb_camera' is not there (was 'camera' meant?)",
         5);
  expect(Joint("revolute", "bsae", "camera"), "whose <parent> 'bsae' is not there (was 'base'", 4);
  expect("<joint name='j' type='fixed'><child>camera</child></joint>",
         "with a joint 'j' without a <parent>", 4);
  expect("<joint type='fixed'><child>camera</child></joint>", "with a joint without a <parent>", 4);
  expect(Joint("fixed", "base", "base"), "from 'base' to 'base' itself", 4);
  expect(Joint("fixed", "base", "x") + Joint("fixed", "base", "y") + Joint("fixed", "z", "base"),
         "<child> 'x' is not there and 2 more such joints", 4);
  expect("<model name='arm'><link name='tip'/></model>" + Joint("fixed", "base", "arm::tp"),
         "<child> 'arm::tp' is not there", 4);
  WriteModel("hand", Model("hand", "<link name='palm'/>"));
  expect("<include><uri>model://hand</uri></include>" + Joint("fixed", "base", "hand::plam"),
         "<child> 'hand::plam' is not there", 4);
}

TEST_F(WildWorldTest, EndsOfJointsMayBeOtherThanLinks) {
  const std::string hand = Model("hand", "<link name='palm'/>");
  WriteModel("finger", Model("finger", "<link name='tip'/>"));
  WriteModel("wrist", Model("wrist", "<include><uri>model://finger</uri></include>"));
  const std::string base = Link("base", "0 0 0 0 0 0", Inertial(1, 0.2));
  for (const std::string& joints :
       {hand + Joint("fixed", "base", "hand::palm"),
        "<include><uri>model://finger</uri></include>" + Joint("fixed", "base", "finger::tip"),
        "<include merge='true'><uri>model://finger</uri></include>" + Joint("fixed", "base", "tip"),
        "<frame name='mark'/><link name='knob'/>" + Joint("fixed", "mark", "knob"),
        "<include><uri>model://wrist</uri></include>" +
            Joint("fixed", "base", "wrist::finger::tip"),
        hand + Joint("fixed", "__model__", "hand")}) {
    const World world = Load(Model("bot", base + joints), "1.9");
    EXPECT_EQ(world.initial.objects.size(), 1u) << joints;
    EXPECT_THAT(world.notes, IsEmpty()) << joints;
  }
}

TEST_F(WildWorldTest, OfWhatIsStaticByItsIncludeBrokenJointsNeedNoWord) {
  WriteModel("bot", Model("bot", Link("base", "0 0 0 0 0 0", "") + Joint("fixed", "base", "x")));
  const std::string include = "<include><uri>model://bot</uri>{}<name>b{}</name></include>\n";
  const World still = Load(fmt::format(fmt::runtime(include), "<static>true</static>", 1));
  EXPECT_EQ(still.statics.size(), 1u);
  EXPECT_THAT(still.notes, IsEmpty());
  const World loose =
      Load(fmt::format(fmt::runtime(include), "", 1) + fmt::format(fmt::runtime(include), "", 2));
  EXPECT_EQ(loose.statics.size(), 2u);
  EXPECT_THAT(loose.notes, ElementsAre(AllOf(HasSubstr("2 models with a joint 'j_x'"),
                                             HasSubstr("bot/model.sdf:2 'b1'"))));
}

TEST_F(WildWorldTest, JointsOfTheWorldHoldModels) {
  const std::string post = Link("l", "0 0 0 0 0 0", kBadInertial);
  const auto joint = [](const std::string& type, const std::string& a, const std::string& b) {
    return fmt::format("<joint name='{}{}' type='{}'><parent>{}</parent><child>{}</child></joint>",
                       a.substr(0, 1), b.substr(0, 1), type, a, b);
  };
  const World fixed = Load(Model("post", post) + joint("fixed", "world", "post::l"), "1.10");
  EXPECT_EQ(fixed.statics.size(), 1u);
  EXPECT_THAT(fixed.notes, ElementsAre(HasSubstr("1 file of SDF 1.10 read as 1.9")));
  const World hinged = Load(Model("post", post) + joint("revolute", "world", "post"), "1.11");
  EXPECT_EQ(hinged.statics.size(), 1u);
  EXPECT_THAT(hinged.notes, testing::Contains(HasSubstr("1 model with joints")));
}

TEST_F(WildWorldTest, WhatHasNoMassOrHangsTogetherByNothingStandsStill) {
  const World world =
      Load(Model("carton", Link("l", "0 0 0 0 0 0", "")) +
           Model("half", Link("l", "0 0 0 0 0 0",
                              "<inertial><mass>1</mass>"
                              "</inertial>")) +
           Model("pair", Link("a", "0 0 0 0 0 0", Inertial(1, 1)) +
                             Link("b", "1 0 0 0 0 0", Inertial(1, 1))) +
           Model("balloon", Link("l", "0 0 0 0 0 0", Inertial(1, 1) + "<gravity>0</gravity>")));
  EXPECT_EQ(world.statics.size(), 4u);
  EXPECT_THAT(
      world.notes,
      ElementsAre(AllOf(HasSubstr("2 models without mass or inertia (<inertial>): stands still"),
                        HasSubstr("first"), HasSubstr("test.world:3 'carton'")),
                  AllOf(HasSubstr("1 model of parts that no fixed joint holds together"),
                        HasSubstr("'pair'")),
                  AllOf(HasSubstr("without gravity"), HasSubstr("'balloon'"))));
}

TEST_F(WildWorldTest, WhatHasNoShapeIsLeftOutAndCounted) {
  const std::string visual =
      "<link name='l'><visual name='v'><geometry><box><size>1 1 1</size></box></geometry></visual>"
      "</link>";
  const World world =
      Load(Model("poster", visual) + Model("marks", "<link name='l'/>") + Model("nothing", "") +
           StaticModel("picture", visual) + StaticModel("empty", "<link name='l'/>") +
           StaticModel("hollow", LinkWithShape("<empty/>")));
  EXPECT_TRUE(world.statics.empty());
  EXPECT_TRUE(world.initial.objects.empty());
  EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("4 models without any <collision>"),
                                             HasSubstr("test.world:3 'poster'"))));
}

// --- shapes --------------------------------------------------------------------------------------

/// Whether something stands at a place, between 0.1 and 0.2 m.
bool StandsAt(const World& world, double x, double y) {
  const OccupancyGrid grid = SliceWorld(world, 0.1, 0.2, 0.02);
  const Eigen::Vector2d cell = (Eigen::Vector2d(x, y) - grid.origin) / grid.resolution;
  return grid.at(static_cast<int>(cell.x()), static_cast<int>(cell.y())) == Cell::kOccupied;
}

TEST_F(WildWorldTest, EveryShapeHasItsOwnOutline) {
  const auto bounds = [&](const std::string& shape) {
    const World world = Load(StaticModel("a", LinkWithShape(shape)), "1.11");
    geometry::Aabb box;
    for (const auto& part : world.statics.at(0).collisions)
      box.Include(geometry::BoundsOf(part.shape, part.X_BS));
    return box;
  };
  const auto expect = [](const geometry::Aabb& box, const Eigen::Vector3d& half, double slack) {
    EXPECT_TRUE((box.upper - half).cwiseAbs().maxCoeff() < slack) << box.upper.transpose();
    EXPECT_TRUE((box.lower + half).cwiseAbs().maxCoeff() < slack) << box.lower.transpose();
  };
  expect(bounds("<capsule><radius>0.1</radius><length>0.6</length></capsule>"), {0.1, 0.1, 0.4},
         1e-12);
  expect(bounds("<ellipsoid><radii>0.4 0.3 0.2</radii></ellipsoid>"), {0.4, 0.3, 0.2}, 0.004);
  expect(bounds("<ellipsoid><radii>0.3 0.3 0.3</radii></ellipsoid>"), {0.3, 0.3, 0.3}, 1e-12);
  expect(bounds("<cone><radius>0.2</radius><length>0.5</length></cone>"), {0.2, 0.2, 0.25}, 0.002);
}

TEST_F(WildWorldTest, LooseCapsulesConesAndPolylinesArePlayedAndEllipsoidsStandStill) {
  const auto load = [&](const std::string& shape) {
    return Load(Model("a", Link("l", "0 0 0 0 0 0", Inertial(1, 1), shape)), "1.11");
  };
  for (const std::string shape :
       {"<capsule><radius>0.1</radius><length>0.6</length></capsule>",
        "<cone><radius>0.2</radius><length>0.5</length></cone>",
        "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>0.5</height>"
        "</polyline>"}) {
    EXPECT_EQ(load(shape).initial.objects.size(), 1u) << shape;
  }
  const World world = load("<ellipsoid><radii>0.4 0.3 0.2</radii></ellipsoid>");
  EXPECT_EQ(world.statics.size(), 1u);
  EXPECT_THAT(world.notes, testing::Contains(HasSubstr("<ellipsoid>")));
}

TEST_F(WildWorldTest, APolylineKeepsItsBaysAndHoles) {
  const std::string bay =
      "<polyline><point>0 0</point><point>1 0</point><point>1 0.3</point><point>0.3 0.3</point>"
      "<point>0.3 1</point><point>0 1</point><height>0.8</height></polyline>";
  const World angle =
      Load(StaticModel("plinth", "<pose>2 1.5 0 0 0 0</pose>" + LinkWithShape(bay)));
  EXPECT_TRUE(StandsAt(angle, 2.8, 1.65));
  EXPECT_TRUE(StandsAt(angle, 2.15, 2.3));
  EXPECT_FALSE(StandsAt(angle, 2.7, 2.2)) << "in the bay";
  const World frame = Load(StaticModel(
      "frame", LinkWithShape(
                   "<polyline><point>0 0</point><point>0 2</point><point>2 2</point>"
                   "<point>2 0</point><height>1</height></polyline><polyline><point>0.5 0.5</point>"
                   "<point>1.5 0.5</point><point>1.5 1.5</point><point>0.5 1.5</point>"
                   "<height>1</height></polyline>")));
  EXPECT_TRUE(StandsAt(frame, 0.25, 1.0));
  EXPECT_TRUE(StandsAt(frame, 1.75, 1.0));
  EXPECT_FALSE(StandsAt(frame, 1.0, 1.0)) << "in the hole";
  for (const std::string bad :
       {"<polyline><point>0 0</point><point>1 1</point><point>1 0</point><point>0 1</point>"
        "<height>1</height></polyline>",
        "<polyline><point>0 0</point><point>1 1</point><height>1</height></polyline>",
        "<polyline><point>0 0</point><point>1 0</point><point>1 1</point></polyline>",
        "<polyline><point>0 0</point><point>1 x</point><point>1 1</point><height>1</height>"
        "</polyline>"}) {
    EXPECT_THAT(ErrorOf(StaticModel("a", LinkWithShape(bad))),
                AllOf(HasSubstr("test.world:3: collision 'c'"), HasSubstr("<polyline>")))
        << bad;
  }
}

const char kTwoCubes[] =
    "o left\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    "o right\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\nv 5 0 1\nv 6 0 1\nv 6 1 1\nv 5 1 1\n"
    "f 9 12 11 10\nf 13 14 15 16\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\n";

TEST_F(WildWorldTest, ASubmeshIsReadAlone) {
  folder_.Write("two.obj", kTwoCubes);
  const auto bounds = [&](const std::string& submesh) {
    const World world = Load(StaticModel(
        "a", LinkWithShape("<mesh><uri>two.obj</uri><scale>2 1 1</scale>" + submesh + "</mesh>")));
    const auto& part = world.statics.at(0).collisions.at(0);
    return geometry::BoundsOf(part.shape, part.X_BS);
  };
  EXPECT_NEAR(bounds("").upper.x(), 12.0, 1e-6);
  EXPECT_NEAR(bounds("<submesh><name>left</name></submesh>").upper.x(), 2.0, 1e-6);
  EXPECT_NEAR(bounds("<submesh><name>right</name></submesh>").lower.x(), 10.0, 1e-6);
  EXPECT_NEAR(bounds("<submesh><name>right</name><center>true</center></submesh>").lower.x(), -1.0,
              1e-6);
  EXPECT_THAT(ErrorOf(StaticModel("a", LinkWithShape("<mesh><uri>two.obj</uri><submesh><name>rigth"
                                                     "</name></submesh></mesh>"))),
              AllOf(HasSubstr("submesh 'rigth' is unknown"), HasSubstr("'right'")));
}

/// One triangle for each geometry, in the node of that name, `x` [cm] along x.
std::string Collada(const std::vector<std::pair<std::string, int>>& nodes) {
  std::string geometries, scene;
  for (const auto& [name, x] : nodes) {
    geometries += fmt::format(
        "<geometry id='g{0}' name='form_{0}'><mesh><source id='p{0}'><float_array id='a{0}' "
        "count='9'>{1} 0 0 {2} 0 0 {1} 100 0</float_array><technique_common><accessor "
        "source='#a{0}' count='3' stride='3'><param name='X' type='float'/><param name='Y' "
        "type='float'/><param name='Z' type='float'/></accessor></technique_common></source>"
        "<vertices id='v{0}'><input semantic='POSITION' source='#p{0}'/></vertices><triangles "
        "count='1'><input semantic='VERTEX' source='#v{0}' offset='0'/><p>0 1 2</p></triangles>"
        "</mesh></geometry>",
        name, x, x + 100);
    scene += fmt::format(
        "<node id='n{0}' name='{0}'><translate>0 200 0</translate><instance_geometry "
        "url='#g{0}'/></node>",
        name);
  }
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><unit meter='0.01'/><up_axis>Z_UP</up_axis></asset>"
         "<library_geometries>" +
         geometries + "</library_geometries><library_visual_scenes><visual_scene id='s'>" + scene +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
         "</COLLADA>";
}

TEST_F(WildWorldTest, ASubmeshOfColladaIsNamedByItsNodeAndPlacedByIt) {
  folder_.Write("two.dae", Collada({{"left", 0}, {"right", 300}}));
  for (const std::string name : {"right", "form_right"}) {
    const World world =
        Load(StaticModel("a", LinkWithShape("<mesh><uri>two.dae</uri><submesh><name>" + name +
                                            "</name></submesh></mesh>")));
    const auto& part = world.statics.at(0).collisions.at(0);
    const geometry::Aabb box = geometry::BoundsOf(part.shape, part.X_BS);
    EXPECT_TRUE(box.lower.isApprox(Eigen::Vector3d(3, 2, 0), 1e-5)) << box.lower.transpose();
    EXPECT_TRUE(box.upper.isApprox(Eigen::Vector3d(4, 3, 0), 1e-5)) << box.upper.transpose();
  }
}

TEST_F(WildWorldTest, ShapesOfSizeZeroAreLeftOutAndTheOthersStay) {
  for (const std::string nothing :
       {"<box><size>0 0 0</size></box>", "<box><size>2 0 0</size></box>",
        "<cylinder><radius>0</radius><length>1</length></cylinder>",
        "<sphere><radius>0</radius></sphere>",
        "<capsule><radius>0</radius><length>1</length></capsule>",
        "<ellipsoid><radii>1 0 0</radii></ellipsoid>"}) {
    const World world =
        Load(StaticModel("a", "<link name='l'><collision name='c'><geometry>" + nothing +
                                  "</geometry></collision><collision name='d'><geometry>" +
                                  kUnitBox + "</geometry></collision></link>"));
    EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("1 collision with a shape of size 0"),
                                               HasSubstr("test.world:3 'c'"))))
        << nothing;
    ASSERT_EQ(world.statics.size(), 1u) << nothing;
    EXPECT_EQ(world.statics[0].collisions.size(), 1u) << nothing;
  }
}

/// It stops what drives there, or carries what stands on it.
TEST_F(WildWorldTest, APlateWithoutThicknessIsNotLeftOut) {
  for (const std::string plate : {"<box><size>2 0 1</size></box>", "<box><size>2 1 0</size></box>",
                                  "<cylinder><radius>1</radius><length>0.0</length></cylinder>"}) {
    EXPECT_THROW(Load(StaticModel("a", "<link name='l'><collision name='c'><geometry>" + plate +
                                           "</geometry></collision></link>")),
                 base::ConfigError)
        << plate;
  }
}

// --- planes --------------------------------------------------------------------------------------

std::string Plane(const std::string& name, double z, double friction) {
  return StaticModel(
      name, fmt::format("<pose>0 0 {} 0 0 0</pose>", z) +
                LinkWithShape("<plane><normal>0 0 1</normal></plane>",
                              fmt::format("<surface><friction><ode><mu>{}</mu></ode></friction>"
                                          "</surface>",
                                          friction)));
}

TEST_F(WildWorldTest, TheHighestPlaneIsTheFloor) {
  const World same = Load(Plane("a", 0, 1) + Plane("b", 0, 1));
  EXPECT_THAT(same.notes, ElementsAre(HasSubstr("test.world:4")));
  const World rough = Load(Plane("a", 0, 0.5) + Plane("b", 0, 0.7));
  EXPECT_EQ(rough.floor_friction, 0.7);
  EXPECT_THAT(rough.notes, ElementsAre(AllOf(HasSubstr("0.7"), HasSubstr("0.5"))));
  for (const bool is_first : {true, false}) {
    const std::string upper = Plane("a", 0, 0.5), lower = Plane("b", -0.3, 0.7);
    const World world = Load(is_first ? upper + lower : lower + upper);
    EXPECT_EQ(world.floor_friction, 0.5);
    EXPECT_EQ(world.lowered_by, 0.0);
    EXPECT_THAT(world.notes, ElementsAre(HasSubstr(is_first ? "test.world:4" : "test.world:3")));
  }
  const World raised = Load(Plane("a", 1.5, 1) + StaticModel("box", "<pose>0 0 2 0 0 0</pose>" +
                                                                        LinkWithShape(kUnitBox)));
  EXPECT_EQ(raised.lowered_by, 1.5);
  EXPECT_NEAR(raised.statics.at(0).X_MB.translation.z(), 0.5, 1e-12);
  EXPECT_THAT(log_, HasSubstr("floor=1.500 m"));
}

// --- what is left out ----------------------------------------------------------------------------

TEST_F(WildWorldTest, WhatCouldStandInTheWayAndIsLeftOutIsSaidOnce) {
  const World world = Load(
      "<actor name='a'><pose>0 0 0 0 0 0</pose><skin><filename>none.dae</filename></skin></actor>\n"
      "<actor name='b'/>\n<population name='bins'><model name='bin'/><model_count>40</model_count>"
      "</population>\n<colision/><model name='m'><static>1</static><link name='l'><colision/>"
      "</link></model>");
  EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("2 actors"), HasSubstr("test.world:3 'a'")),
                                       AllOf(HasSubstr("40 models of a <population>"),
                                             HasSubstr("test.world:5")),
                                       HasSubstr("1 element <colision> in <world>"),
                                       AllOf(HasSubstr("1 element <colision> in <link>"),
                                             HasSubstr("<collision>"), HasSubstr("test.world:6"))));
}

TEST_F(WildWorldTest, WhatCannotStandInTheWayNeedsNoWord) {
  const World world = Load(
      "<light name='l' type='odd'><nonsense/></light><plugin name='p' filename='x.so'><a/></plugin>"
      "<physics type='none'><gravity>1 1 1</gravity></physics><scene><sky/></scene><gui><x/></gui>"
      "<spherical_coordinates/><wind/><audio/><atmosphere "
      "type='x'/><magnetic_field>a</magnetic_field>"
      "<gz:policies/>" +
      StaticModel("m",
                  "<plugin name='p' filename='x.so'/><link name='body'><sensor name='s'/>"
                  "<velocity_decay/><self_collide>x</self_collide><collision name='c'>"
                  "<laser_retro>x</laser_retro><max_contacts>x</max_contacts><geometry>" +
                      std::string(kUnitBox) +
                      "</geometry><surface><contact><ode><kp>x</kp></ode></contact></surface>"
                      "</collision></link>"));
  EXPECT_EQ(world.statics.size(), 1u);
  EXPECT_THAT(world.notes, IsEmpty());
  EXPECT_EQ(log_, "");
}

TEST_F(WildWorldTest, WhatStandsBesideTheWorldIsNamedWithTheRemedy) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)));
  const World world = LoadWorld(folder_.Write(
      "test.world",
      "<sdf version='1.6'>\n<model name='before'/>\n<world name='w'>" +
          StaticModel("inside", LinkWithShape(kUnitBox)) + "</world>\n" +
          StaticModel("crate", LinkWithShape(kUnitBox)) +
          "<include><uri>model://crate</uri></include><actor name='walker'/><light name='l'/>"
          "</sdf>"));
  ASSERT_EQ(world.statics.size(), 1u);
  EXPECT_EQ(world.statics[0].name, "inside");
  EXPECT_THAT(world.notes,
              ElementsAre(AllOf(HasSubstr("1 element <include> beside <world> left out"),
                                HasSubstr("move it into <world>"), HasSubstr("test.world:6")),
                          HasSubstr("1 actor left out"),
                          AllOf(HasSubstr("2 elements <model> beside <world> left out"),
                                HasSubstr("move it into <world>"), HasSubstr("first"),
                                HasSubstr("test.world:2 'before'"))));
}

TEST_F(WildWorldTest, AStateThatSaysOtherwiseIsNamed) {
  const std::string box = StaticModel("a", "<pose>1 2 0 0 0 0</pose>" + LinkWithShape(kUnitBox));
  const std::string state =
      "<state world_name='w'><model name='a'><pose>{} 2 0 0 0 0</pose></model>"
      "</state>";
  EXPECT_THAT(Load(box + fmt::format(state, 1)).notes, IsEmpty());
  EXPECT_THAT(
      Load(box + fmt::format(state, 3)).notes,
      ElementsAre(AllOf(HasSubstr("1 model that <state> has elsewhere"), HasSubstr("'a'"))));
}

TEST_F(WildWorldTest, AStateOfOtherLinksOrSizesIsNamed) {
  base::Rng rng(11);
  for (int i = 0; i < 30; ++i) {
    const double x = rng.Uniform(-3, 3), yaw = rng.Uniform(-3, 3), along = rng.Uniform(-2, 2);
    const std::string pose = fmt::format("<pose>{} 2 0 0 0 {}</pose>", x, yaw);
    const std::string box =
        Model("a", "<static>1</static>" + pose + Link("l", fmt::format("{} 0 0 0 0 0", along), ""));
    const double off = i % 2 == 0 ? 0.0 : rng.Uniform(0.02, 3.0);
    const double scale = i % 3 == 0 ? 1.0 : rng.Uniform(1.1, 3.0);
    const auto notes =
        Load(box + fmt::format("<state world_name='w'><model name='a'>{}<scale>1 {} 1</scale><link "
                               "name='l'><pose>{} {} 0 0 0 {}</pose></link></model></state>",
                               pose, scale, x + (along + off) * std::cos(yaw),
                               2 + (along + off) * std::sin(yaw), yaw))
            .notes;
    EXPECT_EQ(notes.size(), (off > 0.0 ? 1u : 0u) + (scale > 1.0 ? 1u : 0u)) << i;
    if (off > 0.0) {
      EXPECT_THAT(notes.at(0), HasSubstr("with links that <state> has elsewhere"));
    }
  }
}

TEST_F(WildWorldTest, WhatNothingCollidesWithIsLeftOutAndSaid) {
  base::Rng rng(12);
  for (int i = 0; i < 30; ++i) {
    const bool has_bits = i % 3 == 0, is_plain = i % 3 == 1;
    const std::string mask = has_bits     ? fmt::format("{:#x}", 1 + rng.Index(0xfffe))
                             : i % 2 == 0 ? "0"
                                          : "0x0000";
    const std::string contact =
        is_plain ? fmt::format("<collide_without_contact>{}</collide_without_contact>",
                               i % 2 == 0 ? "true" : "1")
                 : "<collide_bitmask>" + mask + "</collide_bitmask>";
    const World world =
        Load(StaticModel("zone", LinkWithShape(kUnitBox, "<surface><contact>" + contact +
                                                             "</contact></surface>")) +
             StaticModel("wall", LinkWithShape(kUnitBox)));
    ASSERT_EQ(world.statics.size(), has_bits ? 2u : 1u) << contact;
    EXPECT_EQ(world.statics[0].name, "wall");
    if (has_bits) {
      EXPECT_THAT(world.notes, IsEmpty());
    } else {
      EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("1 collision with"),
                                                 HasSubstr("left out, as nothing collides"))));
    }
  }
}

TEST_F(WildWorldTest, AllShapesOfACollisionAreTakenWhateverTheirNames) {
  base::Rng rng(13);
  for (int i = 0; i < 30; ++i) {
    std::string link;
    int num_shapes = 0, num_several = 0;
    for (int j = 1 + rng.Index(3); j > 0; --j) {
      std::string geometries;
      const int count = 1 + rng.Index(3);
      for (int k = 0; k < count; ++k) {
        const bool is_capsule = rng.Bernoulli(0.3);
        const std::string shape =
            is_capsule ? "<ellipsoid><radii>1 2 3</radii></ellipsoid>" : kUnitBox;
        geometries += k > 0 && rng.Bernoulli(0.5) ? shape : "</geometry><geometry>" + shape;
      }
      geometries = "<geometry>" + geometries + "</geometry>";
      const std::string empty = "<geometry></geometry>";
      if (geometries.rfind(empty, 0) == 0) geometries.erase(0, empty.size());
      link += fmt::format("<collision name='c'><pose>{} 0 0 0 0 0</pose>{}</collision>", num_shapes,
                          geometries);
      num_shapes += count;
      num_several += count > 1 ? 1 : 0;
    }
    const World world = Load(StaticModel("a", "<link name='l'>" + link + "</link>"));
    ASSERT_EQ(world.statics.size(), 1u) << link;
    EXPECT_EQ(world.statics[0].collisions.size(), static_cast<std::size_t>(num_shapes)) << link;
    EXPECT_EQ(world.notes.size(), num_several > 0 ? 1u : 0u) << link;
    std::set<std::string> names;
    for (const auto& shape : world.statics[0].collisions) names.insert(shape.name);
    EXPECT_EQ(names.size(), static_cast<std::size_t>(num_shapes)) << link;
  }
}

TEST_F(WildWorldTest, ObstaclesNeedNoNamesOfTheirOwn) {
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

TEST_F(WildWorldTest, JointsOfWhatStandsAreNotLookedAt) {
  const std::string joint = Joint("fixed", "l", "gone");
  EXPECT_EQ(
      Load(Model("a", "<static>1</static>" + Link("l", "0 0 0 0 0 0", "") + joint)).statics.size(),
      1u);
  EXPECT_THAT(
      ErrorOf(Model("a", Link("l", "0 0 0 0 0 0", Inertial(1, 1)) + joint +
                             "<frame name='f'><pose relative_to='j_g'>0 0 1 0 0 0</pose></frame>")),
      AllOf(HasSubstr("relative_to of a <pose>: name 'j_g' is unknown"), HasSubstr("'gone'")));
  const World world =
      Load(Model("a", "<static>1</static>" + Link("l", "0 0 0 0 0 0", "") +
                          "<joint name='j' type='fixed'><pose>3 0 0 0 0 0</pose>"
                          "<parent>world</parent><child>l</child></joint><link name='m'><pose "
                          "relative_to='j'>1 0 0 0 0 0</pose><collision name='c'><geometry>" +
                          kUnitBox + "</geometry></collision></link>"));
  ASSERT_EQ(world.statics.at(0).collisions.size(), 2u);
  EXPECT_NEAR(world.statics[0].collisions[1].X_BS.translation.x(), 4.0, 1e-9);
}

TEST_F(WildWorldTest, AllWrongValuesAndNamesAreToldWithTheirLines) {
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

TEST_F(WildWorldTest, OldFormatsAndNoneAreToldOrRead) {
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

TEST_F(WildWorldTest, EscapesInAddressesAreRead) {
  WriteModel("my crate (1)", StaticModel("crate", LinkWithShape(kUnitBox)));
  for (const char* uri : {"model://my crate (1)", "model://my%20crate%20%281%29",
                          "models/my%20crate (1)/model.sdf"}) {
    EXPECT_EQ(Load(fmt::format("<include><uri>{}</uri></include>", uri)).statics.size(), 1u);
  }
  const std::string file = "file://" + folder_.path("models/my crate (1)/model.sdf");
  EXPECT_EQ(Load("<include><uri>" + base::Join(base::Split(file, ' '), "%20") + "</uri></include>")
                .statics.size(),
            1u);
  EXPECT_THAT(ErrorOf("<include><uri>model://none%20</uri></include>"),
              HasSubstr("'model://none%20' is not there"));
  EXPECT_THAT(ErrorOf("<include><uri>model://%2e%2e/%2e%2e/x</uri></include>"),
              HasSubstr("is not there"));
}

TEST_F(WildWorldTest, FramesOfPosesCountUpToSdf16AndAreToldOfLater) {
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

TEST_F(WildWorldTest, GravityOfOldWorldsIsRead) {
  EXPECT_EQ(Load("<physics type='ode'><gravity>0 0 -1.6</gravity></physics>", "1.5").gravity, 1.6);
}

TEST_F(WildWorldTest, AnotherGravityThanTheEarthsIsSaid) {
  for (const char* earths : {"9.8", "9.81", "9.80665", "9.78", "9.83"}) {
    EXPECT_THAT(Load("<gravity>0 0 -" + std::string(earths) + "</gravity>", "1.7").notes,
                IsEmpty());
  }
  for (const char* other : {"0", "1.62", "3.7", "98.1"}) {
    EXPECT_THAT(Load("<gravity>0 0 -" + std::string(other) + "</gravity>", "1.7").notes,
                ElementsAre(HasSubstr("<gravity> is " + std::string(other) + " m/s^2")));
  }
}

// --- versions and XML ----------------------------------------------------------------------------

TEST_F(WildWorldTest, NewerVersionsAreReadAsFarAsTheirElementsAreKnown) {
  const std::string content =
      StaticModel("a", LinkWithShape(kUnitBox)) + LooseCube("cube", "3 0 0 0 0 0");
  const std::uint64_t hash = Load(content, "1.9").hash;
  for (const std::string version : {"1.10", "1.11", "1.12"}) {
    const World world = Load(content, version);
    EXPECT_EQ(world.hash, hash) << version;
    EXPECT_THAT(world.notes, ElementsAre(HasSubstr("SDF " + version + " read as 1.9")));
  }
}

TEST_F(WildWorldTest, CommentsAndBlanksMayStandWhereverXmlHasThem) {
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

// --- where things are looked for -----------------------------------------------------------------

/// Sets a variable as long as this is.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    const char* before = std::getenv(name);
    had_ = before != nullptr;
    if (had_) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  bool had_{false};
  std::string before_;
};

TEST_F(WildWorldTest, ModelsBesideWorldsAreFound) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)), "package/models");
  const std::string text = WorldText("<include><uri>model://crate</uri></include>");
  for (const std::string place :
       {"package/worlds/a.world", "package/worlds/indoor/a.world", "package/a.world"}) {
    EXPECT_EQ(LoadWorld(folder_.Write(place, text)).statics.size(), 1u) << place;
  }
  folder_.Write("package/inner/package.xml", "<package/>");
  const std::string other = folder_.Write("package/inner/worlds/a.world", text);
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadWorld(other); }),
              AllOf(HasSubstr("'model://crate' is not there"), HasSubstr("GZ_SIM_RESOURCE_PATH"),
                    HasSubstr("GAZEBO_MODEL_PATH")))
      << "models of another package";
}

TEST_F(WildWorldTest, AddressesThatBeginWithTheModelFolderAreFound) {
  folder_.Write("package/models/crate/meshes/two.obj", kTwoCubes);
  folder_.Write("package/secret/two.obj", kTwoCubes);
  for (const std::string place : {"package/worlds/a.world", "package/worlds/indoor/a.world"}) {
    const auto load = [&](const std::string& uri) {
      WriteModel("crate",
                 StaticModel("crate", LinkWithShape("<mesh><uri>\n" + uri + "\n</uri></mesh>")),
                 "package/models");
      return LoadWorld(
          folder_.Write(place, WorldText("<include><uri>model://crate</uri></include>")));
    };
    const std::uint64_t hash = load("model://crate/meshes/two.obj").hash;
    for (const char* uri : {"file://models/crate/meshes/two.obj", "models/crate/meshes/two.obj",
                            "file://crate/meshes/two.obj"}) {
      EXPECT_EQ(load(uri).hash, hash) << uri;
    }
    EXPECT_THAT(MessageOf<base::ConfigError>([&] { load("file://models/crate/meshes/tow.obj"); }),
                AllOf(HasSubstr("'file://models/crate/meshes/tow.obj' is not there"),
                      HasSubstr("two.obj'?")));
    for (const char* uri : {"file://secret/two.obj", "file://models/../secret/two.obj"})
      EXPECT_THROW(load(uri), base::ConfigError) << uri;
  }
}

TEST_F(WildWorldTest, GazebosVariablesAndCachesAreLookedThrough) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)), "elsewhere");
  WriteModel("2", StaticModel("seat", LinkWithShape(kUnitBox)),
             "home/.gz/fuel/fuel.gazebosim.org/openrobotics/models/office chair");
  WriteModel("10", StaticModel("seat", LinkWithShape("<sphere><radius>1</radius></sphere>")),
             "home/.gz/fuel/fuel.gazebosim.org/openrobotics/models/office chair");
  const std::string include = "<include><uri>model://crate</uri></include>";
  for (const char* variable : {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH",
                               "GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH"}) {
    const Variable set(variable, "/no/such:" + folder_.path("elsewhere"));
    EXPECT_EQ(Load(include).statics.size(), 1u) << variable;
  }
  const Variable home("HOME", folder_.path("home"));
  for (const std::string uri :
       {"https://fuel.gazebosim.org/1.0/OpenRobotics/models/Office%20Chair",
        "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Office_Chair/10",
        " https://fuel.ignitionrobotics.org/1.0/x/models/OFFICE CHAIR/tip/ "}) {
    const World world = Load("<include><name>seat</name><uri>" + uri + "</uri></include>");
    ASSERT_EQ(world.statics.size(), 1u) << uri;
    EXPECT_TRUE(std::holds_alternative<geometry::Sphere>(world.statics[0].collisions[0].shape))
        << "the newest version";
  }
}

TEST_F(WildWorldTest, AllThatIsMissingIsSaidAtOnceWithWhatComesNear) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)));
  folder_.Write("meshes/table.stl", "x");
  const std::string error = ErrorOf(
      "<include><uri>model://crates</uri></include>\n"
      "<include><uri>https://fuel.gazebosim.org/1.0/OpenRobotics/models/OfficeChairGrey</uri>"
      "</include>\n" +
      StaticModel("t", LinkWithShape("<mesh><uri>meshes/tabel.stl</uri></mesh>")) +
      "<actor name='x'/>");
  EXPECT_THAT(error, AllOf(HasSubstr("test.world:3: 'model://crates' is not there"),
                           HasSubstr("did you mean 'crate'?"), HasSubstr("test.world:4: 'https://"),
                           HasSubstr("nothing is fetched"), HasSubstr("OfficeChairGrey"),
                           HasSubstr("test.world:5")));
  EXPECT_THAT(error, AllOf(HasSubstr("table.stl'?"), HasSubstr("1 actor")));
}

// --- inertia of shapes and densities -------------------------------------------------------------

TEST_F(WildWorldTest, AutomaticInertiaIsThatOfSolidShapesOfTheirDensities) {
  base::Rng rng(11);
  for (int round = 0; round < 40; ++round) {
    const double density = rng.Uniform(100.0, 8000.0), of_link = rng.Uniform(100.0, 8000.0);
    const double x = rng.Uniform(0.1, 1.0), y = rng.Uniform(0.1, 1.0), z = rng.Uniform(0.1, 1.0);
    const bool says_own = rng.Bernoulli(0.5), says_link = rng.Bernoulli(0.5);
    const double used = says_own ? density : says_link ? of_link : 1000.0;
    std::string shape;
    geometry::MassProperties wanted;
    switch (rng.Index(3)) {
      case 0:
        shape = fmt::format("<box><size>{} {} {}</size></box>", x, y, z);
        wanted.mass = used * x * y * z;
        wanted.I_BBcm = geometry::SolidInertia(geometry::Box{{x, y, z}}, wanted.mass);
        break;
      case 1:
        shape = fmt::format("<cylinder><radius>{}</radius><length>{}</length></cylinder>", x, z);
        wanted.mass = used * M_PI * x * x * z;
        wanted.I_BBcm = geometry::SolidInertia(geometry::Cylinder{x, z}, wanted.mass);
        break;
      default:
        shape = fmt::format("<sphere><radius>{}</radius></sphere>", x);
        wanted.mass = used * 4.0 / 3.0 * M_PI * x * x * x;
        wanted.I_BBcm = geometry::SolidInertia(geometry::Sphere{x}, wanted.mass);
    }
    const std::string inertial =
        "<inertial auto='true'>" +
        (says_link ? fmt::format("<density>{}</density>", of_link) : std::string()) + "</inertial>";
    const World world = Load(
        Model("m",
              fmt::format("<link name='l'>{}<collision name='c'><pose>1 2 3 0 0 0</pose>{}"
                          "<geometry>{}</geometry></collision></link>",
                          inertial, says_own ? fmt::format("<density>{}</density>", density) : "",
                          shape)),
        "1.11");
    ASSERT_EQ(world.initial.objects.size(), 1u) << shape;
    const geometry::MassProperties& mass =
        world.RequireModel(world.initial.objects[0].model)->mass_properties;
    EXPECT_NEAR(mass.mass, wanted.mass, 1e-9 * wanted.mass);
    EXPECT_TRUE(mass.p_BBcm.isApprox(Eigen::Vector3d(1, 2, 3), 1e-12));
    EXPECT_TRUE(mass.I_BBcm.isApprox(wanted.I_BBcm, 1e-9)) << shape;
  }
}

TEST_F(WildWorldTest, AutomaticInertiaOfOtherShapesIsNotMadeUp) {
  const World world =
      Load(Model("m",
                 "<link name='l'><inertial auto='true'/><collision name='c'><geometry><capsule>"
                 "<radius>0.1</radius><length>1</length></capsule></geometry></collision></link>"),
           "1.11");
  EXPECT_TRUE(world.initial.objects.empty());
  EXPECT_THAT(base::Join(world.notes, "\n"), HasSubstr("boxes, cylinders and spheres alone"));
  EXPECT_THAT(ErrorOf(Model("m",
                            "<link name='l'><inertial auto='true'><density>-3</density>"
                            "</inertial><collision name='c'><geometry><sphere><radius>1</radius>"
                            "</sphere></geometry></collision></link>")),
              AllOf(HasSubstr("<density> is '-3'"), HasSubstr("kg/m^3")));
}

// --- files of other kinds ------------------------------------------------------------------------

TEST_F(WildWorldTest, AFileOfAnotherKindIsToldByItsKind) {
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
}  // namespace hires::world::wild_world_test
