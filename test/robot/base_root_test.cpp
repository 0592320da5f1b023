#include "robot/urdf/base_root.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "hires/base/rng.h"
#include "hires/robot/load_robot.h"
#include "hires/robot/robot_model.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::robot::base_root_test {
namespace {

using hires::test_support::Rounds;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kBox[] =
    "<collision><origin xyz='0.1 0 0.2'/><geometry><box size='0.6 0.3 0.2'/></geometry>"
    "</collision>";

/// x, y, z and yaw of a joint.
struct Origin {
  double x{0.0}, y{0.0}, z{0.0}, yaw{0.0};
};

std::string Link(const std::string& name, const std::string& shape = "") {
  return fmt::format("<link name='{}'>{}</link>", name, shape);
}

std::string Joint(const std::string& parent, const std::string& child, const Origin& at = {},
                  const std::string& type = "fixed") {
  return fmt::format(
      "<joint name='{0}_{1}' type='{2}'><parent link='{0}'/><child link='{1}'/><origin xyz='{3} "
      "{4} {5}' rpy='0 0 {6}'/><axis xyz='0 1 0'/></joint>",
      parent, child, type, at.x, at.y, at.z, at.yaw);
}

/// A base with two wheels and a plate on a mast.
std::string Body(const std::string& base) {
  return Link(base, kBox) + Link("left") + Link("right") + Link("mast") + Link("plate", kBox) +
         Joint(base, "left", {0, 0.2, 0.05}, "continuous") +
         Joint(base, "right", {0, -0.2, 0.05}, "continuous") +
         Joint(base, "mast", {0.1, 0.05, 0.3, 0.4}) + Joint("mast", "plate", {0, 0.1, 0.3});
}

std::string Urdf(const std::string& parts) { return "<robot name='r'>" + parts + "</robot>"; }

RobotModel Parse(const std::string& parts) { return ParseRobotModel(Urdf(parts), "r.urdf"); }

Origin Drawn(base::Rng* rng) {
  Origin at{rng->Uniform(-3, 3), rng->Uniform(-3, 3), rng->Uniform(-1, 1), rng->Uniform(-3, 3)};
  const int kind = rng->Index(3);
  if (kind == 0) at.yaw = 0.0;
  if (kind == 1) at.x = at.y = 0.0;
  return at;
}

/// All links stand to the base as they do in the model without what lies above.
void ExpectSameRobot(const RobotModel& model, const RobotModel& alone) {
  ASSERT_EQ(model.links.front().name, alone.links.front().name);
  const auto X_R = ForwardKinematics(model, {}), X_A = ForwardKinematics(alone, {});
  for (std::size_t i = 0; i < alone.links.size(); ++i) {
    const auto same = model.FindLink(alone.links[i].name);
    ASSERT_TRUE(same);
    EXPECT_TRUE(X_R[*same].translation.isApprox(X_A[i].translation, 1e-9) ||
                X_A[i].translation.norm() < 1e-12);
    EXPECT_LT(X_R[*same].rotation.angularDistance(X_A[i].rotation), 1e-6);
    EXPECT_EQ(model.links[*same].collisions.size(), alone.links[i].collisions.size());
  }
  for (std::size_t i = 1; i < model.links.size(); ++i) {
    ASSERT_TRUE(model.links[i].joint);
    EXPECT_LT(model.links[i].joint->parent, static_cast<int>(i));
  }
}

TEST(RootAtBaseTest, ARootThatIsNoBaseMakesRoomForIt) {
  base::Rng rng(4);
  for (int round = 0; round < Rounds(60); ++round) {
    const Origin at = Drawn(&rng), up{0, 0, rng.Uniform(-0.2, 0.2)};
    const std::string under = Link("base_footprint") + Joint("base_footprint", "base_link", up);
    for (const std::string root : {"world", "map", "odom", "World", "gantry"}) {
      ExpectSameRobot(
          Parse(Link(root) + Joint(root, "base_footprint", at) + under + Body("base_link")),
          Parse(under + Body("base_link")));
      ExpectSameRobot(Parse(Link(root) + Joint(root, "base_link", at) + Body("base_link")),
                      Parse(Body("base_link")));
      ExpectSameRobot(Parse(Link(root) + Joint(root, "chassis", at) + Body("chassis")),
                      Parse(Body("chassis")));
    }
    // A chain, and a root with a shape.
    ExpectSameRobot(Parse(Link("torso", kBox) + Link("waist", kBox) + Joint("torso", "waist", at) +
                          Joint("waist", "base_link", up) + Body("base_link")),
                    Parse(Body("base_link")));
  }
}

TEST(RootAtBaseTest, ARootThatLiesOverOrUnderItsBaseStays) {
  base::Rng rng(5);
  for (int round = 0; round < Rounds(40); ++round) {
    const Origin up{0, 0, rng.Uniform(-1, 1)};
    for (const std::string root : {"world", "torso", "chassis", "base_footprint"}) {
      const RobotModel model = Parse(Link(root, rng.Bernoulli(0.5) ? kBox : "") +
                                     Joint(root, "base_link", up) + Body("base_link"));
      EXPECT_EQ(model.links.front().name, root);
      EXPECT_DOUBLE_EQ(model.links[1].joint->X_PJ.translation.z(), up.z);
    }
  }
}

TEST(RootAtBaseTest, ABaseStaysAndAnArmsBaseLinkIsNone) {
  const Origin beside{0.3, 0.1, 0.4, 1.0};
  for (const std::string root : {"base", "base_footprint", "mobile_base"}) {
    EXPECT_EQ(Parse(Body(root) + Link("base_link", kBox) + Joint(root, "base_link", beside))
                  .links.front()
                  .name,
              root);
  }
  const std::string arm = Link("base_link", kBox) + Joint("chassis", "base_link", beside);
  EXPECT_EQ(Parse(Body("chassis") + arm).links.front().name, "chassis");
  EXPECT_EQ(Parse(Link("world") + Joint("world", "chassis", beside) + Body("chassis") + arm)
                .links.front()
                .name,
            "chassis");
  // What moves is no mount.
  EXPECT_EQ(
      Parse(Link("odom") + Joint("odom", "base_link", beside, "continuous") + Body("base_link"))
          .links.front()
          .name,
      "odom");
}

TEST(RootAtBaseTest, IsSaidAmongWhatIsAssumed) {
  const TemporaryFolder folder;
  const Origin beside{1.0, 2.0, 0.0, 1.5707963};
  const std::string urdf = folder.Write(
      "r.urdf", Urdf(Link("world") + Joint("world", "base_link", beside) + Body("base_link")));
  const auto said = Contains(AllOf(HasSubstr("'base_link' is the base, not the root 'world'"),
                                   HasSubstr("x 1.000 m, y 2.000 m, yaw 90.0 degrees")));
  const Robot robot = LoadAnyRobot(urdf);
  EXPECT_THAT(robot.assumed, said);
  EXPECT_EQ(robot.profile.base_link, "base_link");
  const Robot by_profile = LoadAnyRobot(folder.Write("a.yaml", "urdf: r.urdf\n"));
  EXPECT_THAT(by_profile.assumed, said);
  EXPECT_EQ(by_profile.profile.footprint.size(), robot.profile.footprint.size());
  EXPECT_THAT(LoadAnyRobot(folder.Write("b.yaml", "urdf: r.urdf\nbase_link: base_link\n")).assumed,
              Not(said));
  const std::string still = folder.Write(
      "s.urdf",
      Urdf(Link("torso", kBox) + Link("base_link", kBox) + Joint("torso", "base_link", beside)));
  EXPECT_THAT(LoadAnyRobot(still).assumed, Contains(HasSubstr("the root 'torso' is taken")));
}

}  // namespace
}  // namespace hires::robot::base_root_test
