#include "robot/urdf/clean_urdf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/robot/robot_model.h"
#include "support/log_catcher.h"
#include "support/messages.h"
#include "support/rounds.h"

namespace hires::robot::clean_urdf_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::LogCatcher;
using hires::test_support::Rounds;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A way to write an <inertial>, and what becomes of it.
struct Kind {
  const char* text;
  bool is_told;
  bool is_kept;
};

const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds{
      {"", false, false},
      {"<mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>", false, true},
      {"<mass value='0'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>", true, false},
      {"<mass value='-3'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>", true, false},
      {"<mass value='nan'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>", true,
       false},
      {"<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>", true, false},
      {"<mass value='1'/>", true, false},
      {"<mass value='1'/><inertia ixx='1' iyy='1' izz='1'/>", true, false},
      {"<mass value='1'/><inertia ixx='much' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>", true,
       false},
      {"<mass value='1'/><inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/>", true, false},
      {"<mass value='1'/><inertia ixx='1' ixy='2' ixz='0' iyy='1' iyz='0' izz='1'/>", true, false},
      {"<origin xyz='0 9e9 0'/><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
       "izz='1'/>",
       true, false},
      {"<mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='5'/>", true, true}};
  return kinds;
}

TEST(CleanUrdfTest, RobotsWithAnyInertialsLoadAndAllThatAreImpossibleAreTold) {
  base::Rng rng(57);
  for (int round = 0; round < Rounds(200); ++round) {
    const int num_links = 1 + rng.Index(7);
    std::string links, joints;
    std::vector<int> kinds;
    std::vector<std::string> told;
    for (int i = 0; i < num_links; ++i) {
      kinds.push_back(rng.Index(static_cast<int>(Kinds().size())));
      const Kind& kind = Kinds()[kinds.back()];
      const std::string name = fmt::format("part{}", i);
      if (kind.is_told) told.push_back(name);
      links += fmt::format(
          "<link name='{}'>{}</link>\n", name,
          kind.text[0] == '\0' ? "" : fmt::format("<inertial>{}</inertial>", kind.text));
      if (i == 0) continue;
      joints += fmt::format(
          "<joint name='j{0}' type='fixed'><parent link='part{1}'/><child "
          "link='part{0}'/></joint>\n",
          i, rng.Index(i));
    }
    const LogCatcher log(base::LogLevel::kWarn);
    const RobotModel model =
        ParseRobotModel("<robot name='r'>\n" + links + joints + "</robot>", "drawn.urdf");
    for (int i = 0; i < num_links; ++i) {
      const auto link = model.FindLink(fmt::format("part{}", i));
      EXPECT_EQ(model.links[*link].inertial.has_value(), Kinds()[kinds[i]].is_kept) << kinds[i];
    }
    if (told.empty()) {
      EXPECT_THAT(log.lines, IsEmpty());
      continue;
    }
    ASSERT_THAT(log.lines, SizeIs(1));
    EXPECT_THAT(log.lines[0],
                AllOf(HasSubstr("impossible_inertia=" + base::Join(told, ",") + " "),
                      HasSubstr(fmt::format("count={}", told.size())), HasSubstr("first=\"line ")));
  }
}

TEST(CleanUrdfTest, WhatOnlyLooksOrMovesElsewhereIsNoReason) {
  const LogCatcher log(base::LogLevel::kWarn);
  const RobotModel model = ParseRobotModel(R"(<robot name="r" version="1.1">
<material name="empty"/>
<link name="a"><visual><geometry><cone/></geometry><material name="nowhere"/></visual>
 <collision><geometry><box size="1 1 1"/></geometry></collision></link>
<link name="b"><visual/></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
 <calibration rising="high"/><safety_controller/><dynamics damping="x"/></joint>
<transmission name="t"><type/></transmission><sensor name="s" type="ray"/>
</robot>)",
                                           "r.urdf");
  EXPECT_EQ(model.links.size(), 2u);
  EXPECT_EQ(model.links[0].collisions.size(), 1u);
  EXPECT_THAT(log.lines, IsEmpty());
}

TEST(CleanUrdfTest, FloatingPlanarAndUnlimitedJointsAreToldByKind) {
  const LogCatcher log(base::LogLevel::kWarn);
  const auto joint = [](int i, const char* type) {
    return fmt::format(
        "<link name='l{0}'/><joint name='j{0}' type='{1}'><parent link='base'/><child "
        "link='l{0}'/></joint>\n",
        i, type);
  };
  const RobotModel model = ParseRobotModel(
      "<robot name='r'><link name='base'/>\n" + joint(1, "floating") + joint(2, "planar") +
          joint(3, "revolute") + joint(4, "prismatic") + "</robot>",
      "r.urdf");
  EXPECT_EQ(FindJoint(model, "j1")->type, JointType::kFixed);
  EXPECT_EQ(FindJoint(model, "j2")->type, JointType::kFixed);
  EXPECT_EQ(FindJoint(model, "j3")->limits->upper, 0.0);
  ASSERT_THAT(log.lines, SizeIs(2));
  EXPECT_THAT(log.lines[0], AllOf(HasSubstr("taken_as_fixed=j1,j2"), HasSubstr("line 2")));
  EXPECT_THAT(log.lines[1], AllOf(HasSubstr("held_at_0=j3,j4"), HasSubstr("line 4")));
}

/// A joint as files have it, its range, and the key of the warning that tells of it.
struct JointKind {
  const char* type;
  const char* inside;
  std::string key;  ///< "": it is as it should be
  JointType becomes;
  double lower, upper;
};

TEST(CleanUrdfTest, JointsThatNoDriveNeedsRefuseNoRobotAndAreToldByKind) {
  const std::vector<JointKind> all{
      {"revolute", "<limit lower='-1' upper='2' effort='1' velocity='3'/>", "",
       JointType::kRevolute, -1.0, 2.0},
      {"revolute", "<limit lower='0' upper='-1.5' effort='1' velocity='3'/>", "limits_swapped",
       JointType::kRevolute, -1.5, 0.0},
      {"prismatic", "<limit lower='0.5' effort='1' velocity='3'/>", "limits_swapped",
       JointType::kPrismatic, 0.0, 0.5},
      {"revolute", "<limit lower='-inf' upper=' +Inf ' effort='1' velocity='3'/>", "without_end",
       JointType::kContinuous, -1e16, 1e16},
      {"prismatic", "<limit lower='-inf' upper='2' effort='1' velocity='3'/>", "without_end",
       JointType::kPrismatic, -1e16, 2.0},
      {"revolute", "<limit lower='-1e16' upper='1e16' effort='1' velocity='3'/>", "",
       JointType::kContinuous, -1e16, 1e16},
      {"revolute", "<limit lower='-6.28' upper='1e16' effort='1' velocity='3'/>", "",
       JointType::kRevolute, -6.28, 1e16},
      {"revolute", "<limit lower='-pi' upper='pi' effort='1' velocity='3'/>", "unreadable_limits",
       JointType::kRevolute, 0.0, 0.0},
      {"prismatic", "<limit lower='' upper='1' effort='1' velocity='3'/>", "unreadable_limits",
       JointType::kPrismatic, 0.0, 0.0},
      {"revolute", "<limit lower='0' upper='nan' effort='1' velocity='3'/>", "unreadable_limits",
       JointType::kRevolute, 0.0, 0.0},
      {"revolute", "<limit lower='-1' upper='1' effort='-1' velocity='-1'/>", "unusable_limits",
       JointType::kRevolute, -1.0, 1.0},
      {"revolute", "<limit lower='-1' upper='1' effort='' velocity='fast'/>", "unusable_limits",
       JointType::kRevolute, -1.0, 1.0},
      {"continuous", "<limit lower='1' upper='-1' effort='1' velocity='3'/>", "",
       JointType::kContinuous, 0.0, 0.0},
      {"continuous", "<limit lower='-inf' upper='inf' effort='1' velocity='3'/>", "",
       JointType::kContinuous, 0.0, 0.0},
      {"continuous", "<axis xyz='0 0 0'/>", "without_axis", JointType::kFixed, 0.0, 0.0},
      {"revolute", "<axis/><limit lower='-1' upper='1' effort='1' velocity='3'/>", "without_axis",
       JointType::kFixed, 0.0, 0.0},
      {"fixed", "<axis xyz='up'/><limit lower='low'/><mimic joint='nobody' offset='x'/>", "",
       JointType::kFixed, 0.0, 0.0},
      {"floating", "<axis xyz=''/><limit effort=''/>", "taken_as_fixed", JointType::kFixed, 0.0,
       0.0}};
  base::Rng rng(41);
  for (int round = 0; round < Rounds(200); ++round) {
    std::string xml = "<robot name='r'>\n<link name='base'/>\n";
    std::map<std::string, std::vector<std::string>> told;  // by key
    std::vector<const JointKind*> drawn;
    for (int i = 0, number = 1 + rng.Index(6); i < number; ++i) {
      drawn.push_back(&all[rng.Index(static_cast<int>(all.size()))]);
      xml += fmt::format(
          "<link name='l{0}'/><joint name='j{0}' type='{1}'><parent link='base'/><child "
          "link='l{0}'/>{2}</joint>\n",
          i, drawn[i]->type, drawn[i]->inside);
      if (!drawn[i]->key.empty()) told[drawn[i]->key].push_back(fmt::format("j{}", i));
    }
    const LogCatcher log(base::LogLevel::kWarn);
    const RobotModel model = ParseRobotModel(xml + "</robot>", "r.urdf");
    EXPECT_THAT(log.lines, SizeIs(told.size())) << xml;
    for (const auto& [key, names] : told) {
      EXPECT_THAT(log.lines, Contains(AllOf(HasSubstr(key + "=" + base::Join(names, ",") + " "),
                                            HasSubstr("first=\"line "))))
          << xml;
    }
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const Joint& joint = *FindJoint(model, fmt::format("j{}", i));
      EXPECT_EQ(joint.type, drawn[i]->becomes) << drawn[i]->inside;
      EXPECT_EQ(joint.limits.has_value(), joint.type != JointType::kFixed) << drawn[i]->inside;
      if (!joint.limits) continue;
      EXPECT_EQ(joint.limits->lower, drawn[i]->lower) << drawn[i]->inside;
      EXPECT_EQ(joint.limits->upper, drawn[i]->upper) << drawn[i]->inside;
      EXPECT_EQ(joint.limits->velocity, drawn[i]->key == "unusable_limits" ? 0.0 : 3.0);
    }
  }
}

TEST(CleanUrdfTest, ChainsOfFollowersLeadToTheJointThatLeads) {
  const auto joint = [](int i, const std::string& type, const std::string& mimic) {
    return fmt::format(
        "<link name='l{0}'/><joint name='j{0}' type='{1}'><parent link='base'/><child link='l{0}'/>"
        "<axis xyz='0 0 1'/><limit lower='-9' upper='9' effort='1' velocity='1'/>{2}</joint>\n",
        i, type, mimic);
  };
  const auto follow = [](int leader, double multiplier, double offset) {
    return fmt::format("<mimic joint='j{}' multiplier='{}' offset='{}'/>", leader, multiplier,
                       offset);
  };
  base::Rng rng(43);
  for (int round = 0; round < Rounds(100); ++round) {
    const int number = 2 + rng.Index(5);
    const bool is_led = rng.Bernoulli(0.5);  // by a joint that moves
    const double led = is_led ? rng.Uniform(-1.0, 1.0) : 0.0;
    std::string xml =
        "<robot name='r'>\n<link name='base'/>\n" + joint(0, is_led ? "prismatic" : "fixed", "");
    std::vector<double> wanted{led};
    for (int i = 1; i < number; ++i) {
      const double multiplier = rng.Uniform(-1.1, 1.1), offset = rng.Uniform(-0.2, 0.2);
      xml += joint(i, "prismatic", follow(i - 1, multiplier, offset));
      wanted.push_back(multiplier * wanted.back() + offset);
    }
    const LogCatcher log(base::LogLevel::kWarn);
    const RobotModel model = ParseRobotModel(xml + "</robot>", "r.urdf");
    EXPECT_THAT(log.lines, SizeIs(is_led ? 0 : 1)) << xml;
    const auto X_R =
        ForwardKinematics(model, is_led ? JointPositions{{"j0", led}} : JointPositions{});
    for (int i = 0; i < number; ++i) {
      EXPECT_NEAR(X_R[*model.FindLink(fmt::format("l{}", i))].translation.z(), wanted[i], 1e-9)
          << i << xml;
    }
  }
}

TEST(CleanUrdfTest, FollowersOfThemselvesAreHeldAndThoseOutOfTheirLimitsAreTold) {
  const auto joint = [](const char* name, const char* limit, const char* mimic) {
    return fmt::format(
        "<link name='l_{0}'/><joint name='{0}' type='revolute'><parent link='base'/><child "
        "link='l_{0}'/><axis xyz='0 1 0'/><limit {1} effort='1' velocity='1'/>{2}</joint>\n",
        name, limit, mimic);
  };
  const char* wide = "lower='-2' upper='2'";
  const LogCatcher log(base::LogLevel::kWarn);
  const RobotModel model = ParseRobotModel(
      "<robot name='r'>\n<link name='base'/>\n" +
          joint("self", wide, "<mimic joint='self' offset='1'/>") +
          joint("a", wide, "<mimic joint='b'/>") + joint("b", wide, "<mimic joint='a'/>") +
          joint("lead", "lower='0.2' upper='0.8'", "") +
          joint("out", "lower='0' upper='0.8'", "<mimic joint='lead' multiplier='-1'/>") +
          "</robot>",
      "r.urdf");
  for (const char* name : {"self", "a", "b"})
    EXPECT_EQ(FindJoint(model, name)->type, JointType::kFixed) << name;
  EXPECT_NO_THROW(ForwardKinematics(model, {}));
  EXPECT_THAT(log.lines,
              ::testing::ElementsAre(
                  AllOf(HasSubstr("follow_nothing_that_moves=a,b,self "), HasSubstr("line 4")),
                  AllOf(HasSubstr("stopped_at_limits=out "), HasSubstr("line 7"))));
}

TEST(CleanUrdfTest, ACapsuleReachesAsFarAsItShould) {
  base::Rng rng(3);
  for (int round = 0; round < Rounds(100); ++round) {
    const double radius = rng.Uniform(0.02, 0.5);
    const double length = rng.Bernoulli(0.1) ? 0.0 : rng.Uniform(0.0, 2.0);
    const Eigen::Vector3d p(rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-1, 1));
    const double r = rng.Uniform(-3, 3), t = rng.Uniform(-1, 1), y = rng.Uniform(-3, 3);
    const RobotModel model = ParseRobotModel(
        fmt::format("<robot name='r'><link name='a'><collision name='c'><origin xyz='{} {} {}' "
                    "rpy='{} {} {}'/><geometry><capsule radius='{}' length='{}'/></geometry>"
                    "</collision><collision><geometry><box size='9 9 9'/></geometry></collision>"
                    "</link></robot>",
                    p.x(), p.y(), p.z(), r, t, y, radius, length),
        "r.urdf");
    ASSERT_EQ(model.links[0].collisions.size(), 4u);
    geometry::Aabb bounds;
    for (int i = 0; i < 3; ++i) {
      const geometry::Collision& part = model.links[0].collisions[i];
      bounds.Include(geometry::BoundsOf(part.shape, part.X_BS));
    }
    const Eigen::Vector3d along =
        geometry::RotationFromRpy(r, t, y) * Eigen::Vector3d(0.0, 0.0, 0.5 * length);
    const Eigen::Vector3d reach = along.cwiseAbs() + Eigen::Vector3d::Constant(radius);
    EXPECT_TRUE(bounds.upper.isApprox(p + reach, 1e-6)) << bounds.upper.transpose();
    EXPECT_TRUE(bounds.lower.isApprox(p - reach, 1e-6)) << bounds.lower.transpose();
  }
}

TEST(CleanUrdfTest, ShapesThatNobodyKnowsAreToldAllAtOnce) {
  const std::string error = ConfigErrorOf([] {
    ParseRobotModel(
        "<robot name='r'>\n<link name='a'><collision><geometry><cone/></geometry></collision>\n"
        "<collision><geometry><torus/></geometry></collision></link></robot>",
        "r.urdf");
  });
  EXPECT_THAT(error,
              AllOf(HasSubstr("link 'a': the collision shape <cone>"), HasSubstr("; line 2"),
                    HasSubstr("<torus>"), HasSubstr("; line 3"), HasSubstr("capsule or mesh")));
}

/// Shapes, how many of them stay, and the word that says why one is left out.
struct Shaped {
  const char* text;
  int num_kept;
  const char* key;
};

TEST(CleanUrdfTest, CollisionsThatOccupyNothingAreLeftOutAndToldByKind) {
  const std::vector<Shaped> all{
      {"<geometry><box size='1 0.5 2'/></geometry>", 1, ""},
      {"<geometry><capsule radius='0.1' length='1'/></geometry>", 3, ""},
      {"<geometry><sphere radius='1e-9'/></geometry>", 1, ""},
      {"", 0, "without_shape"},
      {"<geometry/>", 0, "without_shape"},
      {"<origin xyz='1 0 0'/><geometry>\n</geometry>", 0, "without_shape"},
      {"<geometry><box size='0 0 0'/></geometry>", 0, "without_size"},
      {"<geometry><box size='0 2.5 0.0'/></geometry>", 0, "without_size"},
      {"<geometry><sphere radius='0'/></geometry>", 0, "without_size"},
      {"<geometry><cylinder radius='0.0' length='0'/></geometry>", 0, "without_size"},
      {"<geometry><cylinder radius='0' length='3'/></geometry>", 0, "without_size"},
      {"<geometry><capsule radius='0' length='1'/></geometry>", 0, "without_size"}};
  base::Rng rng(9);
  for (int round = 0; round < Rounds(200); ++round) {
    std::string xml = "<robot name='r'>\n<link name='a'>\n";
    std::map<std::string, std::pair<int, int>> told;  // by key: first line, how many
    std::size_t num_kept = 0;
    int line = 3;
    for (int i = rng.Index(8); i > 0; --i) {
      const Shaped& one = all[rng.Index(static_cast<int>(all.size()))];
      num_kept += one.num_kept;
      if (one.num_kept == 0) ++told.emplace(one.key, std::make_pair(line, 0)).first->second.second;
      const std::string text = fmt::format("<collision>{}</collision>\n", one.text);
      line += static_cast<int>(std::count(text.begin(), text.end(), '\n'));
      xml += text;
    }
    const LogCatcher log(base::LogLevel::kWarn);
    const RobotModel model = ParseRobotModel(xml + "</link></robot>", "r.urdf");
    EXPECT_EQ(model.links[0].collisions.size(), num_kept) << xml;
    ASSERT_THAT(log.lines, SizeIs(told.size()));
    for (const auto& [key, place] : told) {
      EXPECT_THAT(
          log.lines,
          Contains(AllOf(HasSubstr(key + "=a"), HasSubstr(fmt::format("count={} ", place.second)),
                         HasSubstr(fmt::format("first=\"line {}", place.first)))))
          << xml;
    }
  }
}

TEST(CleanUrdfTest, LinesOfShapesAreThoseOfTheFile) {
  UrdfProblems problems("r.urdf");
  const CleanUrdf clean = CleanedUrdf(
      "<robot name='r'>\n<link name='a'>\n<collision><geometry>\n<capsule radius='1' length='2'/>"
      "</geometry></collision>\n<collision/>\n<collision><geometry><sphere "
      "radius='1'/></geometry></collision></link></robot>",
      {}, "r.urdf", &problems);
  EXPECT_THAT(clean.shape_lines.at("a"), ::testing::ElementsAre(4, 4, 4, 6));
}

}  // namespace
}  // namespace hires::robot::clean_urdf_test
