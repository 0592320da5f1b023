// Joints of worlds as people have them: what they hold, and those that join what is not there.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hires/base/text.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/wild_world.h"

namespace hires::world::wild_joints_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class WildJointsTest : public WildWorld {};

TEST_F(WildJointsTest, WhatHasJointsStandsAtJointZeroAndIsSaidOnce) {
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

TEST_F(WildJointsTest, JointsThatJoinWhatIsNotThereLetTheModelStandStill) {
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

TEST_F(WildJointsTest, EndsOfJointsMayBeOtherThanLinks) {
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

/// As SDF has it, which has no attribute name of an <include>.
TEST_F(WildJointsTest, AnIncludeIsCalledByItsNameElementAndNotByAnAttribute) {
  WriteModel("finger", Model("finger", "<link name='tip'/>"));
  const std::string base = Link("base", "0 0 0 0 0 0", Inertial(1, 0.2));
  for (const std::string own : {"", "thumb"}) {
    const std::string name = own.empty() ? "finger" : own;
    WriteModel("wrist",
               Model("wrist", "<include name='odd'><uri>model://finger</uri>" +
                                  (own.empty() ? "" : "<name>" + own + "</name>") + "</include>"));
    const auto load = [&](const std::string& end) {
      return Load(Model("bot", base + "<include><uri>model://wrist</uri></include>" +
                                   Joint("fixed", "base", "wrist::" + end)),
                  "1.9");
    };
    const World world = load(name);
    EXPECT_EQ(world.initial.objects.size(), 1u) << own;
    EXPECT_THAT(world.notes, IsEmpty()) << own;
    EXPECT_THAT(load("odd").notes, ElementsAre(HasSubstr("<child> 'wrist::odd' is not there")));
  }
}

TEST_F(WildJointsTest, OfWhatIsStaticByItsIncludeBrokenJointsNeedNoWord) {
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

TEST_F(WildJointsTest, JointsOfTheWorldHoldModels) {
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

TEST_F(WildJointsTest, JointsOfWhatStandsAreNotLookedAt) {
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

}  // namespace
}  // namespace hires::world::wild_joints_test
