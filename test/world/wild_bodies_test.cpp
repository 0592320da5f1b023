// What stands still in worlds as people have them, and what is a loose thing with which mass.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/geometry/inertia.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/wild_world.h"

namespace hires::world::wild_bodies_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class WildBodiesTest : public WildWorld {};

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

TEST_F(WildBodiesTest, LinksOfUrdfsWithoutMassStandWithTheOthers) {
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

TEST_F(WildBodiesTest, AUrdfOfNoMassThatIsNotStaticStandsStillForThatReason) {
  folder_.Write("models/rack/model.config",
                "<model><name>rack</name><version>1.0</version><sdf version='1.7'>model.urdf</sdf>"
                "</model>");
  folder_.Write("models/rack/model.urdf", RackUrdf("fixed", "", ""));
  const World world = Load("<include><uri>model://rack</uri></include>");
  ASSERT_EQ(world.statics.size(), 1u);
  EXPECT_THAT(world.notes, ElementsAre(HasSubstr("without mass or inertia")));
}

TEST_F(WildBodiesTest, InertialsOfWhatStandsStillAreNotRead) {
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

TEST_F(WildBodiesTest, AWrapperStandsWhereItsPosesPutIt) {
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

TEST_F(WildBodiesTest, AWrapperRoundALooseModelIsALooseThingOfItsName) {
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

TEST_F(WildBodiesTest, LinksThatFixedJointsHoldTogetherAreOneThing) {
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

TEST_F(WildBodiesTest, WhatHasNoMassOrHangsTogetherByNothingStandsStill) {
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

TEST_F(WildBodiesTest, AutomaticInertiaIsThatOfSolidShapesOfTheirDensities) {
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

TEST_F(WildBodiesTest, AutomaticInertiaOfOtherShapesIsNotMadeUp) {
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

}  // namespace
}  // namespace hires::world::wild_bodies_test
