#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "hires/robot/robot_model.h"
#include "support/log_catcher.h"

namespace hires::robot::urdf_errors_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// One way to write a URDF wrong, and what the message must say.
struct BadUrdf {
  std::string name;
  std::string body;  ///< inside <robot>, from line 2 on
  std::vector<std::string> says;
};

std::string Joint(const std::string& type, const std::string& inside) {
  return "<link name=\"a\"/>\n<link name=\"b\"/>\n<joint name=\"j\" type=\"" + type +
         "\"><parent link=\"a\"/><child link=\"b\"/>" + inside + "</joint>\n";
}

std::string Inertial(const std::string& mass, const std::string& inertia) {
  return "<link name=\"a\"><inertial><mass value=\"" + mass + "\"/><inertia " + inertia +
         "/></inertial></link>";
}

std::string Collision(const std::string& inside) {
  return "<link name=\"a\"><collision>" + inside + "</collision></link>";
}

constexpr char kLimit[] = R"(<limit lower="-1" upper="1" velocity="1" effort="1"/>)";

std::vector<BadUrdf> BadUrdfs() {
  return {
      {"NoLinks", "", {"no <link>", "add"}},
      {"LinkWithoutName", "<link/>", {"<link>", "'name'", "line 2"}},
      {"TwoLinksOfOneName",
       "<link name=\"a\"/>\n<link name=\"a\"/>",
       {"'a' is there twice", "line 2; rename", "line 3"}},
      {"TwoJointsOfOneName",
       Joint("fixed", "") +
           "<link name=\"c\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/>"
           "<child link=\"c\"/></joint>",
       {"joint 'j' is there twice", "line 6"}},
      {"UnknownParent",
       "<link name=\"arm\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"armm\"/>"
       "<child link=\"arm\"/></joint>",
       {"joint 'j'", "parent link 'armm' is unknown", "did you mean 'arm'", "line 3"}},
      {"UnknownChild",
       "<link name=\"a\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/>"
       "<child link=\"b\"/></joint>",
       {"child link 'b' is unknown", "line 3"}},
      {"JointWithoutChild",
       "<link name=\"a\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/></joint>",
       {"'j' has no <child>", "add <child link"}},
      {"TwoRoots",
       "<link name=\"a\"/>\n<link name=\"b\"/>",
       {"2 links hang on no joint: 'a', 'b'", "keep one root", "line 3"}},
      {"LoopOfAll",
       Joint("fixed", "") +
           "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>",
       {"loop", "remove the joint"}},
      {"LoopBesideTheTree",
       Joint("fixed", "") +
           "<link name=\"c\"/><joint name=\"k\" type=\"fixed\"><parent link=\"d\"/>"
           "<child link=\"c\"/></joint>\n"
           "<link name=\"d\"/><joint name=\"l\" type=\"fixed\"><parent link=\"c\"/>"
           "<child link=\"d\"/></joint>",
       {"link 'c' is part of a loop", "remove the joint"}},
      {"TwoParents",
       Joint("fixed", "") +
           "<link name=\"c\"/>\n<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/>"
           "<child link=\"c\"/></joint>\n<joint name=\"l\" type=\"fixed\"><parent link=\"b\"/>"
           "<child link=\"c\"/></joint>",
       {"'c' is the child of joint 'k' and of joint 'l'", "line 7"}},
      {"UnknownJointType", Joint("hinge", ""), {"no valid URDF", "hinge"}},
      {"AxisOfTwoNumbers",
       Joint("revolute", std::string(kLimit) + "<axis xyz=\"0 1\"/>"),
       {"no valid URDF", "axis"}},
      {"NumberThatIsNone", Joint("fixed", "<origin xyz=\"0 zero 0\"/>"), {"no valid URDF"}},
      {"NotANumber", Joint("fixed", "<origin xyz=\"0 nan 0\"/>"), {"bad.urdf"}},
      {"FarOrigin",
       Joint("fixed", "<origin xyz=\"0 5000 0\"/>"),
       {"joint 'j'", "5000", "lengths are metres"}},
      {"MimicsNobody",
       Joint("revolute", std::string(kLimit) + "<mimic joint=\"k\"/>"),
       {"joint 'j'", "mimics a joint that is not there", "'k' is unknown"}},
      {"UnknownShape", Collision("<geometry><cone/></geometry>"), {"no valid URDF", "cone"}},
      {"BoxWithoutHeight",
       Collision("<geometry><box size=\"1 1 0\"/></geometry>"),
       {"link 'a'", "height is 0", "above 0"}},
      {"NegativeRadius",
       Collision("<geometry><sphere radius=\"-1\"/></geometry>"),
       {"link 'a'", "radius is -1"}},
      {"HugeCylinder",
       Collision("<geometry><cylinder radius=\"1\" length=\"2000\"/></geometry>"),
       {"link 'a'", "length is 2000", "at most 1000"}},
      {"WordForFriction",
       "<link name=\"a\"/>\n<gazebo reference=\"a\"><mu2 value=\"much\"/></gazebo>",
       {"<mu2>", "finite number", "line 3"}},
  };
}

class UrdfErrors : public ::testing::TestWithParam<BadUrdf> {};

TEST_P(UrdfErrors, NameFileElementAndRemedy) {
  const std::string xml = "<robot name=\"bad\">\n" + GetParam().body + "\n</robot>";
  ::testing::internal::CaptureStderr();
  try {
    ParseRobotModel(xml, "bad.urdf");
    ADD_FAILURE() << "was accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bad.urdf: "));
    for (const std::string& words : GetParam().says) EXPECT_THAT(error.what(), HasSubstr(words));
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "printed past the caller";
}

INSTANTIATE_TEST_SUITE_P(All, UrdfErrors, ::testing::ValuesIn(BadUrdfs()),
                         [](const auto& info) { return info.param.name; });

TEST(UrdfFile, MalformedXmlNamesTheLine) {
  EXPECT_THAT([] { ParseRobotModel("<robot name=\"r\">\n<link name=\"a\">\n</robot>", "x.urdf"); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("x.urdf: no valid XML"), HasSubstr("line 2"))));
  EXPECT_THROW(ParseRobotModel("", "x.urdf"), base::ConfigError);
}

TEST(UrdfFile, OtherXmlIsNoRobot) {
  EXPECT_THAT([] { ParseRobotModel("<sdf version=\"1.7\"/>", "x.urdf"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("no <robot> element")));
}

TEST(UrdfFile, RobotWithoutNameIsRefused) {
  EXPECT_THROW(ParseRobotModel("<robot><link name=\"a\"/></robot>", "x.urdf"), base::ConfigError);
}

TEST(UrdfFile, DeepNestingIsRefused) {
  std::string xml = "<robot name=\"r\"><link name=\"a\"/>";
  for (int i = 0; i < 100000; ++i) xml += "<x>";
  EXPECT_THAT([&] { ParseRobotModel(xml, "x.urdf"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("nest too deep")));
}

TEST(UrdfFile, TooManyLinksAreRefusedByNumber) {
  std::string xml = "<robot name='r'><link name='base'/>";
  for (int i = 0; i < 3000; ++i) {
    xml += "<link name='l" + std::to_string(i) + "'/><joint name='j" + std::to_string(i) +
           "' type='fixed'><parent link='base'/><child link='l" + std::to_string(i) + "'/></joint>";
  }
  EXPECT_THAT([&] { ParseRobotModel(xml + "</robot>", "x.urdf"); },
              ThrowsMessage<base::ConfigError>(AllOf(HasSubstr("3001 links"), HasSubstr("2000"))));
}

TEST(UrdfFile, EntitiesAreNamed) {
  EXPECT_THAT(
      [] {
        ParseRobotModel(
            "<!DOCTYPE r [<!ENTITY w '0.4'>]>\n<robot name='r'><link name='a'>\n"
            "<collision><geometry><sphere radius='&w;'/></geometry></collision></link>"
            "</robot>",
            "x.urdf");
      },
      ThrowsMessage<base::ConfigError>(
          AllOf(HasSubstr("x.urdf:3: uses entities"), HasSubstr("&w;"))));
}

TEST(UrdfFile, AllThatIsWrongIsToldAtOnceInTheOrderOfLines) {
  const std::string xml =
      "<robot name='r'>\n<link name='a'/>\n<link name='a'/>\n"
      "<joint name='j' type='hinge'><parent link='a'/><child link='b'/></joint>\n"
      "<joint name='k' type='fixed'><parent link='a'/><child link='c'/></joint>\n"
      "<link name='b'><collision><geometry><box size='1 1 -1'/></geometry></collision>\n"
      "<collision><geometry><mesh filename='gone.stl'/></geometry></collision></link></robot>";
  try {
    ParseRobotModel(xml, "x.urdf");
    ADD_FAILURE() << "was accepted";
  } catch (const base::ConfigError& error) {
    const std::string what = error.what();
    std::size_t at = 0;
    for (const char* wanted :
         {"x.urdf: 5 things are wrong", "'a' is there twice", "its type is 'hinge'",
          "child link 'c' is unknown", "height is -1", "gone.stl"}) {
      const std::size_t found = what.find(wanted, at);
      EXPECT_NE(found, std::string::npos) << wanted << " in\n" << what;
      at = found == std::string::npos ? at : found;
    }
    EXPECT_THAT(what, ::testing::Not(HasSubstr("hang on no joint")));
  }
}

TEST(UrdfFile, MissingFileIsNamed) {
  EXPECT_THAT([] { LoadRobotModel("no/such.urdf"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("no/such.urdf: no such file")));
}

TEST(UrdfWarnings, ImpossibleInertiaIsKeptAndTold) {
  const hires::test_support::LogCatcher log(base::LogLevel::kWarn);
  const RobotModel model = ParseRobotModel(
      "<robot name=\"r\">" +
          Inertial("0.01", R"(ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.01")") +
          "</robot>",
      "frame.urdf");
  EXPECT_EQ(model.links[0].inertial->I_BBcm(2, 2), 0.01);
  EXPECT_THAT(log.lines,
              ElementsAre(AllOf(HasSubstr("urdf=frame.urdf"), HasSubstr("impossible_inertia=a"))));
}

TEST(UrdfWarnings, OurRobotsLoadWithoutAny) {
  for (const char* file : {"/urdf/pr2_tray.urdf", "/urdf/cart.urdf", "/urdf/car.urdf"}) {
    const hires::test_support::LogCatcher log(base::LogLevel::kWarn);
    LoadRobotModel(std::string(HIRES_SOURCE_DIR) + file);
    EXPECT_THAT(log.lines, IsEmpty()) << file;
  }
}

}  // namespace
}  // namespace hires::robot::urdf_errors_test
