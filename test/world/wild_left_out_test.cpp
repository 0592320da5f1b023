// What is left out of worlds as people have them is said, unless it cannot stand in the way.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hires/base/rng.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/wild_world.h"

namespace hires::world::wild_left_out_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class WildLeftOutTest : public WildWorld {};

TEST_F(WildLeftOutTest, WhatCouldStandInTheWayAndIsLeftOutIsSaidOnce) {
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

TEST_F(WildLeftOutTest, WhatCannotStandInTheWayNeedsNoWord) {
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

TEST_F(WildLeftOutTest, WhatStandsBesideTheWorldIsNamedWithTheRemedy) {
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

TEST_F(WildLeftOutTest, WhatHasNoShapeIsLeftOutAndCounted) {
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

TEST_F(WildLeftOutTest, WhatNothingCollidesWithIsLeftOutAndSaid) {
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

TEST_F(WildLeftOutTest, AStateThatSaysOtherwiseIsNamed) {
  const std::string box = StaticModel("a", "<pose>1 2 0 0 0 0</pose>" + LinkWithShape(kUnitBox));
  const std::string state =
      "<state world_name='w'><model name='a'><pose>{} 2 0 0 0 0</pose></model>"
      "</state>";
  EXPECT_THAT(Load(box + fmt::format(state, 1)).notes, IsEmpty());
  EXPECT_THAT(
      Load(box + fmt::format(state, 3)).notes,
      ElementsAre(AllOf(HasSubstr("1 model that <state> has elsewhere"), HasSubstr("'a'"))));
}

TEST_F(WildLeftOutTest, AStateOfOtherLinksOrSizesIsNamed) {
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

}  // namespace
}  // namespace hires::world::wild_left_out_test
