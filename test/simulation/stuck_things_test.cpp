// Loose things of a world's file that stand in one another.
#include "hires/simulation/stuck_things.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.h"

namespace hires::simulation::stuck_things_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

std::string BoxOf(double edge) { return fmt::format("<box><size>{0} {0} {0}</size></box>", edge); }

/// One that can move, with its middle at x, y, z.
std::string Loose(const std::string& name, double x, double y, double z,
                  const std::string& shape = BoxOf(0.4)) {
  return fmt::format(
      "<model name='{}'><pose>{} {} {} 0 0 0</pose><link name='l'><inertial><mass>1</mass><inertia>"
      "<ixx>0.03</ixx><iyy>0.03</iyy><izz>0.03</izz></inertia></inertial><collision name='c'>"
      "<geometry>{}</geometry></collision></link></model>\n",
      name, x, y, z, shape);
}

std::string Static(const std::string& name, double x, double y, double z,
                   const std::string& shape) {
  return fmt::format(
      "<model name='{}'><static>true</static><pose>{} {} {} 0 0 0</pose><link name='l'><collision "
      "name='c'><geometry>{}</geometry></collision></link></model>\n",
      name, x, y, z, shape);
}

/// A room of four walls of two triangles each, 8 m wide and 2 m high, without floor and roof.
std::string RoomMesh() {
  std::string text = "solid room\n";
  const auto add = [&](const std::string& a, const std::string& b, const std::string& c) {
    text += fmt::format(
        "facet normal 0 0 0\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n", a,
        b, c);
  };
  const char* corners[] = {"4 4", "-4 4", "-4 -4", "4 -4"};
  for (int i = 0; i < 4; ++i) {
    const std::string a = corners[i], b = corners[(i + 1) % 4];
    add(a + " 0", b + " 0", b + " 2");
    add(a + " 0", b + " 2", a + " 2");
  }
  return text + "endsolid room\n";
}

class StuckThingsTest : public testing::Test {
 protected:
  world::World Load(const std::string& content) const {
    return HoldWhatIsStuck(
        world::LoadWorld(folder_.Write("test.world", "<sdf version='1.7'>\n<world name='test'>\n" +
                                                         content + "\n</world>\n</sdf>\n")));
  }
  static std::vector<std::string> NamesOf(const world::World& world) {
    std::vector<std::string> names;
    for (const world::ObjectState& object : world.initial.objects) names.push_back(object.name);
    return names;
  }

  hires::test_support::TemporaryFolder folder_;
};

TEST_F(StuckThingsTest, WhatPhysicsWouldThrowApartStandsStillAndIsSaidOnce) {
  const world::World world =
      Load(Loose("a1", 10, 10, 0.2) + Loose("a2", 10.2, 10, 0.2) + Loose("free", 0, 0, 0.2) +
           Static("wall", 5, 0, 0.5, "<box><size>0.2 4 1</size></box>") + Loose("b", 5, 0, 0.2));
  EXPECT_THAT(NamesOf(world), ElementsAre("free"));
  EXPECT_THAT(world.statics, SizeIs(4));
  EXPECT_THAT(
      world.notes,
      ElementsAre(AllOf(HasSubstr("3 loose things in one another"),
                        HasSubstr("stay where the file has them, as obstacles"), HasSubstr("first"),
                        HasSubstr("test.world:"), HasSubstr("'a1', 0.200 m deep in 'a2'"))));
}

TEST_F(StuckThingsTest, WhatReachesLittleIntoAnotherStaysLooseAndItIsSaid) {
  const world::World world =
      Load(Loose("lower", 0, 0, 0.2) + Loose("upper", 0, 0, 0.59) + Loose("beside", 0.402, 0, 0.2));
  EXPECT_THAT(NamesOf(world), ElementsAre("beside", "lower", "upper"));
  EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("2 loose things at most 0.02 m deep"),
                                             HasSubstr("'lower', 0.010 m deep in 'upper'"))));
}

TEST_F(StuckThingsTest, WhatReachesIntoTheFloorBeginsOnItAndItIsSaid) {
  const world::World world = Load(Loose("pot", 1, 1, 0.1) + Loose("box", 3, 1, 0.0));
  EXPECT_THAT(NamesOf(world), ElementsAre("box", "pot"));
  EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("2 loose things in the floor"),
                                             HasSubstr("'box', 0.200 m deep in the floor"))));
}

TEST_F(StuckThingsTest, WithinWhatAMeshGoesRoundIsFree) {
  folder_.Write("room.stl", RoomMesh());
  const std::string mesh = "<mesh><uri>room.stl</uri></mesh>";
  const world::World world = Load(Static("room", 0, 0, 0, mesh) + Loose("crate", 2, 2, 0.2) +
                                  Loose("at_wall", 3.9, 0, 0.2));
  EXPECT_THAT(NamesOf(world), ElementsAre("crate"));
  EXPECT_THAT(world.notes, ElementsAre(HasSubstr("'at_wall', 0.")));
}

}  // namespace
}  // namespace hires::simulation::stuck_things_test
