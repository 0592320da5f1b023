#include "robot/urdf/seen_shapes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/robot/load_robot.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::robot::seen_shapes_test {
namespace {

using hires::test_support::Rounds;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

const std::string kRoot = HIRES_SOURCE_DIR;
constexpr char kSeen[] = "shapes: seen, but with no <collision> there";

std::string InUrdf(const std::string& links) { return "<robot name='r'>" + links + "</robot>"; }

std::string Fixed(const std::string& parent, const std::string& child,
                  const std::string& xyz = "0 0 0") {
  return fmt::format(
      "<joint name='to_{1}' type='fixed'><origin xyz='{2}'/><parent link='{0}'/><child "
      "link='{1}'/></joint>",
      parent, child, xyz);
}

std::string Shown(const std::string& shape) {
  return "<visual><geometry>" + shape + "</geometry></visual>";
}

/// 0.4 x 0.3 m, from 0 to 0.2 m over the floor.
const std::string kBase =
    "<link name='base'><collision><origin xyz='0 0 0.1'/><geometry><box size='0.4 0.3 0.2'/>"
    "</geometry></collision></link>";

std::vector<std::string> AssumedOf(const std::string& links, const std::string& profile = "") {
  const TemporaryFolder folder;
  const std::string urdf = folder.Write("r.urdf", InUrdf(links));
  return profile.empty() ? LoadRobotFromUrdf(urdf).assumed
                         : LoadRobot(folder.Write("r.yaml", "urdf: r.urdf\n" + profile)).assumed;
}

TEST(SeenShapesTest, OfEachLinkWhatHasASizeAndMeshesByTheirFile) {
  const auto seen = ShapesSeen(InUrdf(
      kBase + "<link name='frame'/><link name='both'>" + Shown("<box size='1 1 1'/>") +
      "<collision><geometry><sphere radius='1'/></geometry></collision></link><link name='bare'>" +
      Shown("<box size='1 2 3'/>") + Shown("<mesh filename='nowhere.dae' scale='1 2 3'/>") +
      "<collision/></link><link name='odd'>" + Shown("<box size='1 2'/>") + Shown("<cone/>") +
      Shown("<sphere radius='-1'/>") + Shown("<cylinder radius='1'/>") +
      "<visual/></link><link name='round'>" + Shown("<sphere radius='1'/>") +
      Shown("<cylinder radius='1' length='2'/>") + "</link>"));
  EXPECT_THAT(seen, UnorderedElementsAre(Pair("both", SizeIs(1)), Pair("bare", SizeIs(2)),
                                         Pair("round", SizeIs(2))));
  EXPECT_TRUE(seen.at("bare")[0].shape.has_value());
  EXPECT_FALSE(seen.at("bare")[1].shape.has_value());
  EXPECT_EQ(seen.at("bare")[1].mesh, "nowhere.dae");
  EXPECT_EQ(seen.at("bare")[1].scale, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(ShapesSeen("no XML").empty());
}

TEST(SeenShapesTest, WhatIsSeenBeyondWhatCollidesIsAssumedAndNothingElse) {
  base::Rng rng(31);
  for (int round = 0; round < Rounds(200); ++round) {
    const double x = rng.Uniform(-0.3, 0.3), y = rng.Uniform(-0.3, 0.3);
    const double length = rng.Uniform(0.01, 0.4), width = rng.Uniform(0.01, 0.4);
    const double z = rng.Uniform(0.05, 0.3), height = rng.Uniform(0.01, 0.1);
    double beyond = z + 0.5 * height - 0.2;
    for (const double sign_x : {-0.5, 0.5}) {
      for (const double sign_y : {-0.5, 0.5}) {
        const double ahead = std::max(std::abs(x + sign_x * length) - 0.2, 0.0);
        const double aside = std::max(std::abs(y + sign_y * width) - 0.15, 0.0);
        beyond = std::max(beyond, std::hypot(ahead, aside));
      }
    }
    if (std::abs(beyond - 0.05) < 1e-6) continue;
    const std::string box = fmt::format("<box size='{} {} {}'/>", length, width, height);
    const std::string joint = Fixed("base", "shelf", fmt::format("{} {} {}", x, y, z));
    const auto assumed = AssumedOf(kBase + joint + "<link name='shelf'>" + Shown(box) + "</link>");
    if (beyond > 0.05) {
      EXPECT_THAT(assumed, Contains(AllOf(HasSubstr(kSeen), HasSubstr("shelf"),
                                          HasSubstr(fmt::format("{:.2f} m beyond", beyond)))))
          << box << joint;
    } else {
      EXPECT_THAT(assumed, Not(Contains(HasSubstr(kSeen)))) << box << joint;
    }
    const std::string collides = "<collision><geometry>" + box + "</geometry></collision>";
    EXPECT_THAT(
        AssumedOf(kBase + joint + "<link name='shelf'>" + Shown(box) + collides + "</link>"),
        Not(Contains(HasSubstr(kSeen))));
  }
}

TEST(SeenShapesTest, AMeshCountsWhereItsOriginIsBeyondOrWhereNothingOfTheBaseCollides) {
  const std::string mesh = Shown("<mesh filename='package://nowhere/a.dae'/>");
  const auto with_mast = [&](const std::string& xyz) {
    return AssumedOf(kBase + "<link name='mast'>" + mesh + "</link>" + Fixed("base", "mast", xyz));
  };
  EXPECT_THAT(with_mast("0 0 0.1"), Not(Contains(HasSubstr(kSeen))));
  EXPECT_THAT(with_mast("0 0 0.9"), Contains(AllOf(HasSubstr(kSeen), HasSubstr("0.70 m beyond"))));
  EXPECT_THAT(with_mast("0.5 0 0.1"),
              Contains(AllOf(HasSubstr("0.30 m beyond"), HasSubstr("some may reach farther"))));
  const std::string wheel =
      "<link name='wheel'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>"
      "<joint name='turns' type='continuous'><origin xyz='0 0 0.1'/><parent link='body'/><child "
      "link='wheel'/><axis xyz='0 1 0'/></joint>";
  EXPECT_THAT(AssumedOf("<link name='body'>" + mesh + "</link>" + wheel),
              Contains(AllOf(HasSubstr(kSeen), HasSubstr("are body;"), HasSubstr("meshes"))));
  EXPECT_THAT(
      AssumedOf("<link name='body'>" + mesh + "</link>" + kBase + Fixed("body", "base") + wheel),
      Not(Contains(HasSubstr(kSeen))));
}

/// Two wheels of radius 0.1 m at y 0.15 m and -0.15 m.
std::string WheelsOf(const std::string& parent) {
  std::string links;
  for (const char* y : {"0.15", "-0.15"}) {
    links += fmt::format(
        "<link name='wheel{1}'><collision><origin rpy='1.5708 0 0'/><geometry><cylinder "
        "radius='0.1' length='0.04'/></geometry></collision></link><joint name='turns{1}' "
        "type='continuous'><origin xyz='0 {1} 0.1'/><parent link='{0}'/><child link='wheel{1}'/>"
        "<axis xyz='0 1 0'/></joint>",
        parent, y);
  }
  return links;
}

std::string Collides(const std::string& shape) {
  return "<collision><geometry>" + shape + "</geometry></collision>";
}

TEST(SeenShapesTest, ACollisionShapeSmallerThanTheBodyHidesNothingOfIt) {
  const std::string body = Shown("<box size='0.45 0.38 0.2'/>");
  for (const char* size : {"0.01 0.01 0.01", "0 0 0", "0.2 0.2 0.2"}) {
    const std::string box = fmt::format("<box size='{}'/>", size);
    EXPECT_THAT(
        AssumedOf("<link name='body'>" + body + Collides(box) + "</link>" + WheelsOf("body")),
        Contains(AllOf(HasSubstr(kSeen), HasSubstr("'body' reaches 0.13 m beyond"))))
        << size;
  }
  EXPECT_THAT(AssumedOf("<link name='body'>" + body + Collides("<box size='0.45 0.38 0.2'/>") +
                        "</link>" + WheelsOf("body")),
              Not(Contains(HasSubstr(kSeen))));
}

TEST(SeenShapesTest, AMeshOfALinkWithoutARealShapeIsMeasured) {
  const TemporaryFolder folder;
  folder.Write("chassis.obj", "v -0.3 -0.2 0\nv 0.5 -0.2 0\nv 0.5 0.2 0.1\nf 1 2 3\n");
  const auto assumed_of = [&](const std::string& own, double scale = 1.0) {
    const std::string look =
        Shown(fmt::format("<mesh filename='chassis.obj' scale='{0} {0} {0}'/>", scale));
    return LoadRobotFromUrdf(folder.Write("r.urdf", InUrdf("<link name='body'>" + look + own +
                                                           "</link>" + WheelsOf("body"))))
        .assumed;
  };
  const auto told = Contains(AllOf(HasSubstr(kSeen), HasSubstr("'body' reaches 0.40 m beyond")));
  EXPECT_THAT(assumed_of(""), told);
  EXPECT_THAT(assumed_of(Collides("<box size='0.01 0.01 0.01'/>")), told);
  EXPECT_THAT(assumed_of("", 0.1), Not(Contains(HasSubstr(kSeen)))) << "all of it within";
  EXPECT_THAT(assumed_of(Collides("<box size='0.6 0.4 0.1'/>")), Not(Contains(HasSubstr(kSeen))))
      << "a link with a real shape is taken to have the right one";
}

TEST(SeenShapesTest, ASensorOnTheBaseDoesNotCoverItsMesh) {
  const std::string mesh = Shown("<mesh filename='package://nowhere/a.dae'/>");
  const auto with_box = [&](const std::string& size) {
    return AssumedOf("<link name='base'/><link name='chassis'>" + mesh + "</link>" +
                     Fixed("base", "chassis") + "<link name='laser'>" +
                     Collides("<box size='" + size + "'/>") + "</link>" +
                     Fixed("base", "laser", "0 0 0.3") + WheelsOf("base"));
  };
  EXPECT_THAT(with_box("0.05 0.05 0.05"),
              Contains(AllOf(HasSubstr(kSeen), HasSubstr("are chassis;"), HasSubstr("meshes"))));
  EXPECT_THAT(with_box("0.3 0.2 0.05"), Not(Contains(HasSubstr(kSeen))));
}

TEST(SeenShapesTest, MeshesOfLooksAreReadWhileThatCostsLittle) {
  const TemporaryFolder folder;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  folder.Write("small.obj", triangle);
  folder.Write("large.obj", triangle + std::string(LookMeshes::kMostBytes, '\n'));
  const auto look = [](const std::string& file) { return SeenShape{{}, std::nullopt, file}; };
  LookMeshes meshes(folder.path());
  EXPECT_FALSE(meshes.Read(look("large.obj")));
  EXPECT_TRUE(meshes.Read(look("small.obj")));
  for (int i = 0; i < LookMeshes::kMostFailed; ++i)
    EXPECT_FALSE(meshes.Read(look(fmt::format("missing{}.obj", i))));
  folder.Write("later.obj", triangle);
  EXPECT_FALSE(meshes.Read(look("later.obj"))) << "it gave up";
  EXPECT_TRUE(meshes.Read(look("small.obj"))) << "known from before";
}

TEST(SeenShapesTest, AFootprintWithRoomForItIsEnoughButNotForWhatIsHigher) {
  const std::string low = kBase + "<link name='skirt'>" + Shown("<box size='0.8 0.6 0.1'/>") +
                          "</link>" + Fixed("base", "skirt", "0 0 0.1");
  const std::string room = "footprint: [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]]\n";
  EXPECT_THAT(AssumedOf(low), Contains(HasSubstr(kSeen)));
  EXPECT_THAT(AssumedOf(low, room), Not(Contains(HasSubstr(kSeen))));
  const std::string high = kBase + "<link name='mast'>" + Shown("<box size='0.1 0.1 1'/>") +
                           "</link>" + Fixed("base", "mast", "0 0 0.5");
  EXPECT_THAT(AssumedOf(high, room), Contains(HasSubstr("'mast' reaches 0.80 m beyond")));
}

TEST(SeenShapesTest, OfManyAFewAreNamed) {
  std::string links = kBase;
  for (int i = 0; i < 20; ++i) {
    const std::string name = fmt::format("part{:02}", i);
    links += "<link name='" + name + "'>" + Shown("<sphere radius='1'/>") + "</link>" +
             Fixed("base", name);
  }
  EXPECT_THAT(AssumedOf(links), Contains(AllOf(HasSubstr(kSeen), HasSubstr("and 14 more"))));
}

TEST(SeenShapesTest, OurRobotsAreQuiet) {
  for (const char* name : {"cart", "car", "pr2_tray", "fetch"}) {
    EXPECT_THAT(LoadRobotFromUrdf(kRoot + "/urdf/" + name + ".urdf").assumed,
                Not(Contains(HasSubstr(kSeen))))
        << name;
  }
  for (const char* name : {"cart", "car", "pr2", "fetch"}) {
    EXPECT_THAT(LoadRobot(kRoot + "/config/robots/" + name + ".yaml").assumed,
                Not(Contains(HasSubstr(kSeen))))
        << name;
  }
}

}  // namespace
}  // namespace hires::robot::seen_shapes_test
