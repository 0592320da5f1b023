#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/robot/robot_model.h"
#include "hires/robot/robot_profile.h"
#include "support/glb.h"
#include "support/log_catcher.h"
#include "support/messages.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::robot::robot_meshes_test {
namespace {

using hires::test_support::Rounds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr char kTriangle[] = "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n";

std::string UrdfWith(const std::string& mesh, const std::string& scale = "1 1 1") {
  return "<robot name=\"r\">\n<link name=\"hand\"><collision><geometry><mesh filename=\"" + mesh +
         "\" scale=\"" + scale + "\"/></geometry></collision></link>\n</robot>";
}

using MeshPtr = std::shared_ptr<const geometry::TriangleMesh>;

MeshPtr MeshOf(const RobotModel& model, int link = 0) {
  return std::get<MeshPtr>(model.links[link].collisions[0].shape);
}

class RobotMeshes : public ::testing::Test {
 protected:
  RobotMeshes() { ::unsetenv("ROS_PACKAGE_PATH"); }
  ~RobotMeshes() override { ::unsetenv("ROS_PACKAGE_PATH"); }

  static void SetPackagePath(const std::string& path) {
    ::setenv("ROS_PACKAGE_PATH", path.c_str(), 1);
  }

  hires::test_support::TemporaryFolder folder_;
};

TEST_F(RobotMeshes, RelativeToTheUrdf) {
  folder_.Write("meshes/hand.obj", kTriangle);
  const std::string urdf = folder_.Write("urdf/r.urdf", UrdfWith("../meshes/hand.obj", "1 3 1"));
  const MeshPtr mesh = MeshOf(LoadRobotModel(urdf));
  EXPECT_EQ(mesh->triangles.size(), 1u);
  geometry::Aabb box;
  for (const Eigen::Vector3d& p : mesh->vertices) box.Include(p);
  EXPECT_EQ(box.upper, Eigen::Vector3d(2.0, 6.0, 0.0));
}

TEST_F(RobotMeshes, GltfAsOneFile) {
  folder_.Write("hand.glb", test_support::GlbOf(test_support::TetrahedronGltf()));
  const MeshPtr mesh = MeshOf(LoadRobotModel(folder_.Write("r.urdf", UrdfWith("hand.glb"))));
  EXPECT_EQ(mesh->triangles.size(), 4u);
  geometry::Aabb box;
  for (const Eigen::Vector3d& p : mesh->vertices) box.Include(p);
  EXPECT_EQ(box.upper, Eigen::Vector3d(1.0, 2.0, 13.0));
}

TEST_F(RobotMeshes, FileUri) {
  const std::string mesh = folder_.Write("hand.obj", kTriangle);
  EXPECT_EQ(MeshOf(ParseRobotModel(UrdfWith("file://" + mesh), "r.urdf"))->triangles.size(), 1u);
}

TEST_F(RobotMeshes, PackageOnTheRosPackagePath) {
  folder_.Write("ws/src/stack/arm_description/package.xml", "<package/>");
  folder_.Write("ws/src/stack/arm_description/meshes/hand.obj", kTriangle);
  SetPackagePath("/nowhere:" + (folder_.path() / "ws/src").string());
  const std::string urdf = UrdfWith("package://arm_description/meshes/hand.obj");
  EXPECT_EQ(MeshOf(ParseRobotModel(urdf, "r.urdf"))->triangles.size(), 1u);
}

TEST_F(RobotMeshes, PackageNamedItselfOnTheRosPackagePath) {
  folder_.Write("arm_description/package.xml", "<package/>");
  folder_.Write("arm_description/hand.obj", kTriangle);
  SetPackagePath((folder_.path() / "arm_description").string());
  const std::string urdf = UrdfWith("package://arm_description/hand.obj");
  EXPECT_EQ(MeshOf(ParseRobotModel(urdf, "r.urdf"))->triangles.size(), 1u);
}

TEST_F(RobotMeshes, PackageThatHoldsTheUrdf) {
  folder_.Write("arm_description/meshes/hand.obj", kTriangle);
  const std::string urdf = folder_.Write("arm_description/urdf/r.urdf",
                                         UrdfWith("package://arm_description/meshes/hand.obj"));
  EXPECT_EQ(MeshOf(LoadRobotModel(urdf))->triangles.size(), 1u);
}

TEST_F(RobotMeshes, AProfileMayNameItsUrdfInAPackage) {
  const std::string urdf =
      "<robot name='cart'><link name='base'><collision><origin xyz='0 0 0.1'/><geometry><box "
      "size='0.4 0.3 0.2'/></geometry></collision></link></robot>";
  folder_.Write("ws/cart_description/package.xml", "<package/>");
  folder_.Write("ws/cart_description/urdf/cart.urdf", urdf);
  const auto named = [](const std::string& name) { return "urdf: package://" + name + "\n"; };
  SetPackagePath((folder_.path() / "ws").string());
  const std::string elsewhere =
      folder_.Write("mine/cart.yaml", named("cart_description/urdf/cart.urdf"));
  EXPECT_EQ(LoadRobot(elsewhere).model.name, "cart");
  SetPackagePath("");
  const std::string inside = folder_.Write("ws/cart_description/config/cart.yaml",
                                           named("cart_description/urdf/cart.urdf"));
  EXPECT_EQ(LoadRobot(inside).model.name, "cart");
  for (const char* missing : {"cart_description/urdf/cat.urdf", "cat_description/urdf/cart.urdf"}) {
    const std::string profile = folder_.Write("ws/cart_description/config/c.yaml", named(missing));
    EXPECT_THAT([&] { LoadRobot(profile); },
                ThrowsMessage<base::ConfigError>(
                    AllOf(HasSubstr("c.yaml: urdf"), HasSubstr(missing), HasSubstr("line 1"))));
  }
}

TEST_F(RobotMeshes, SeveralSlashesAreOne) {
  folder_.Write("arm_description/package.xml", "<package/>");
  folder_.Write("arm_description/meshes/hand.obj", kTriangle);
  SetPackagePath(folder_.path().string());
  for (const char* inside : {"//meshes/hand.obj", "///meshes//hand.obj", "/meshes//./hand.obj"}) {
    const std::string urdf = UrdfWith(std::string("package://arm_description") + inside);
    EXPECT_EQ(MeshOf(ParseRobotModel(urdf, "r.urdf"))->triangles.size(), 1u) << inside;
  }
  for (const char* none : {"", "/", "//", "//../secret.obj", "/meshes/../../secret.obj"}) {
    const std::string urdf = UrdfWith(std::string("package://arm_description") + none);
    EXPECT_THAT([&] { ParseRobotModel(urdf, "r.urdf"); },
                ThrowsMessage<base::ConfigError>(HasSubstr("no file inside a package")))
        << none;
  }
}

TEST_F(RobotMeshes, AModelIsFoundAsWorldsFindItOrAsAPackage) {
  const std::string text = UrdfWith("model://arm/meshes/hand.obj");
  EXPECT_EQ(::unsetenv("GAZEBO_MODEL_PATH"), 0);
  for (const char* urdf : {"beside/r.urdf", "models_beside/r.urdf", "above/urdf/r.urdf",
                           "itself/arm/urdf/r.urdf", "package/r.urdf", "variable/r.urdf"})
    folder_.Write(urdf, text);
  for (const char* mesh : {"beside/arm/meshes/hand.obj", "models_beside/models/arm/meshes/hand.obj",
                           "above/models/arm/meshes/hand.obj", "itself/arm/meshes/hand.obj",
                           "packages/arm/meshes/hand.obj", "gazebo/arm/meshes/hand.obj"})
    folder_.Write(mesh, kTriangle);
  folder_.Write("packages/arm/package.xml", "<package/>");
  const auto load = [&](const char* urdf) {
    return MeshOf(LoadRobotModel((folder_.path() / urdf).string()))->triangles.size();
  };
  for (const char* urdf :
       {"beside/r.urdf", "models_beside/r.urdf", "above/urdf/r.urdf", "itself/arm/urdf/r.urdf"})
    EXPECT_EQ(load(urdf), 1u) << urdf;
  EXPECT_THAT([&] { load("variable/r.urdf"); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("'model://arm/meshes/hand.obj' is not there"),
                        HasSubstr("GAZEBO_MODEL_PATH"), HasSubstr("line 2"))));
  SetPackagePath((folder_.path() / "packages").string());
  EXPECT_EQ(load("package/r.urdf"), 1u);
  ::unsetenv("ROS_PACKAGE_PATH");
  ::setenv("GAZEBO_MODEL_PATH", (folder_.path() / "gazebo").c_str(), 1);
  EXPECT_EQ(load("variable/r.urdf"), 1u);
  ::unsetenv("GAZEBO_MODEL_PATH");
  EXPECT_THAT([&] { ParseRobotModel(UrdfWith("model://../secret.obj"), "r.urdf"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("names no file inside a model")));
}

TEST_F(RobotMeshes, MissingFileNamesLinkAndPlace) {
  const std::string urdf = folder_.Write("r.urdf", UrdfWith("meshes/none.stl"));
  EXPECT_THAT([&] { LoadRobotModel(urdf); },
              ThrowsMessage<base::ConfigError>(AllOf(
                  HasSubstr(urdf), HasSubstr("link 'hand'"), HasSubstr("'meshes/none.stl'"),
                  HasSubstr((folder_.path() / "meshes/none.stl").string()), HasSubstr("line 2"))));
}

TEST_F(RobotMeshes, MissingPackageNamesThePackagePath) {
  SetPackagePath(folder_.path().string());
  EXPECT_THAT([] { ParseRobotModel(UrdfWith("package://absent/hand.stl"), "r.urdf"); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("no package of that name"), HasSubstr("'absent'"),
                        HasSubstr("ROS_PACKAGE_PATH"), HasSubstr(folder_.path().string()))));
}

TEST_F(RobotMeshes, PackagePathStaysInItsPackage) {
  folder_.Write("pkg/package.xml", "<package/>");
  folder_.Write("secret.obj", kTriangle);
  SetPackagePath(folder_.path().string());
  EXPECT_THAT([] { ParseRobotModel(UrdfWith("package://pkg/a/../../secret.obj"), "r.urdf"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("no file inside a package")));
}

TEST_F(RobotMeshes, OtherSchemesAreRefused) {
  EXPECT_THAT([] { ParseRobotModel(UrdfWith("http://example.org/hand.stl"), "r.urdf"); },
              ThrowsMessage<base::ConfigError>(HasSubstr("wanted package://")));
}

TEST_F(RobotMeshes, BrokenMeshNamesTheLink) {
  folder_.Write("hand.stl", "rubbish");
  const std::string urdf = folder_.Write("r.urdf", UrdfWith("hand.stl"));
  EXPECT_THAT([&] { LoadRobotModel(urdf); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("link 'hand'"), HasSubstr("no valid mesh"))));
}

TEST_F(RobotMeshes, OneMeshIsReadOnceAndHashedByContent) {
  folder_.Write("hand.obj", kTriangle);
  const std::string two =
      "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"hand.obj\"/>"
      "</geometry></collision></link><link name=\"b\"><collision><geometry>"
      "<mesh filename=\"hand.obj\"/></geometry></collision></link><joint name=\"j\" "
      "type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>";
  const std::string urdf = folder_.Write("r.urdf", two);
  const RobotModel model = LoadRobotModel(urdf);
  EXPECT_EQ(MeshOf(model, 0), MeshOf(model, 1));
  EXPECT_EQ(LoadRobotModel(urdf).hash, model.hash);
  folder_.Write("hand.obj", "v 0 0 0\nv 2 0 0\nv 0 2.5 0\nf 1 2 3\n");
  EXPECT_NE(LoadRobotModel(urdf).hash, model.hash);
}

/// A folder name that has nothing to do with a package's.
std::string DrawFolder(base::Rng* rng) {
  const std::string words[] = {"checkout-main", "src copy", "robots.git", "v2", "UPPER"};
  return words[rng->Index(5)];
}

TEST_F(RobotMeshes, PackagesAreCalledWhatTheirPackageXmlSaysWhateverTheirFolderIs) {
  base::Rng rng(24);
  for (int round = 0; round < Rounds(60); ++round) {
    const hires::test_support::TemporaryFolder folder;
    const std::string name = fmt::format("bot{}_description", rng.Index(1000));
    const std::string package =
        rng.Bernoulli(0.5) ? "ws/" + DrawFolder(&rng) : "ws/deep/" + DrawFolder(&rng);
    const std::string blank = rng.Bernoulli(0.5) ? "\n  " : "";
    folder.Write(package + "/package.xml",
                 "<?xml version=\"1.0\"?><!-- <name>other</name> -->\n<package format=\"2\">" +
                     blank + "<name>" + blank + name + blank + "</name></package>");
    folder.Write(package + "/meshes/hand.obj", kTriangle);
    const std::string text = UrdfWith("package://" + name + "/meshes/hand.obj");
    const int how = rng.Index(3);
    SetPackagePath(how == 0 ? (folder.path() / "ws").string() : "");
    const std::string inside = package + "/urdf/r.urdf";
    std::string beside = "ws/deep/gazebo/urdf/r.urdf";
    if (how == 2) {  // in a package beside it
      folder.Write(package + "_gazebo/package.xml", "<package><name>beside</name></package>");
      beside = package + "_gazebo/r.urdf";
    }
    const std::string urdf = folder.Write(how == 1 ? inside : beside, text);
    EXPECT_EQ(MeshOf(LoadRobotModel(urdf))->triangles.size(), 1u) << how << ' ' << package;
  }
}

TEST_F(RobotMeshes, APackageOfManifestXmlIsCalledWhatItsFolderIs) {
  folder_.Write("old/arm_stack/manifest.xml", "<package><name>other</name></package>");
  folder_.Write("old/arm_stack/hand.obj", kTriangle);
  SetPackagePath((folder_.path() / "old").string());
  EXPECT_EQ(
      MeshOf(ParseRobotModel(UrdfWith("package://arm_stack/hand.obj"), "r.urdf"))->triangles.size(),
      1u);
}

/// A name that was mistyped: a letter less, more, another, or another case.
std::string Mistyped(const std::string& name, base::Rng* rng) {
  std::string other = name;
  switch (rng->Index(4)) {
    case 0:
      return other.erase(1 + rng->Index(3), 1);
    case 1:
      return other.insert(1 + rng->Index(3), "q");
    case 2:
      other[0] = static_cast<char>(std::toupper(other[0]));
      return other;
    default:
      other[2] = 'q';
      return other;
  }
}

TEST_F(RobotMeshes, AllThatAreMissingAreToldAtOnceWithLineNearestAndRemedy) {
  base::Rng rng(25);
  const std::vector<std::string> known{"torso_lower", "gripper_left", "headplate", "wheelcap"};
  for (int round = 0; round < Rounds(80); ++round) {
    const hires::test_support::TemporaryFolder folder;
    folder.Write("pkg/bot/package.xml", "<package><name>my_bot</name></package>");
    for (const std::string& name : known)
      folder.Write("pkg/bot/meshes/" + name + ".obj", kTriangle);
    SetPackagePath((folder.path() / "pkg").string());
    std::string text = "<robot name=\"r\">\n<link name=\"base\"/>\n";
    std::vector<std::vector<std::string>> wanted;
    const int num_links = 2 + rng.Index(5);
    int line = 3;
    for (int i = 0; i < num_links; ++i) {
      const std::string& name = known[rng.Index(static_cast<int>(known.size()))];
      const std::string wrong = Mistyped(name, &rng);
      std::string uri = "package://my_bot/meshes/" + name + ".obj";
      const int what = rng.Index(4);
      if (what == 1) uri = "package://my_bot/meshes/" + wrong + ".obj";
      if (what == 2) uri = fmt::format("package://absent{}/x.stl", i);
      if (what == 3) uri = "pkg/bot/meshes/" + wrong + ".obj";
      text += fmt::format(
          "<link name=\"l{0}\"><collision><geometry>\n<mesh filename=\"{1}\"/></geometry>"
          "</collision></link>\n<joint name=\"j{0}\" type=\"fixed\"><parent link=\"base\"/><child "
          "link=\"l{0}\"/></joint>\n",
          i, uri);
      if (what == 1)
        wanted.push_back({uri, fmt::format("line {}", line + 1), "did you mean", name + ".obj"});
      if (what == 2) {
        wanted.push_back({uri, fmt::format("line {}", line + 1), "no package of that name",
                          fmt::format("add the folder of package 'absent{}'", i)});
      }
      if (what == 3)
        wanted.push_back({uri, fmt::format("line {}", line + 1), "did you mean", name + ".obj"});
      line += 3;
    }
    const std::string urdf = folder.Write("r.urdf", text + "</robot>");
    if (wanted.empty()) {
      EXPECT_EQ(LoadRobotModel(urdf).links.size(), num_links + 1u);
      continue;
    }
    const std::string error = hires::test_support::ConfigErrorOf([&] { LoadRobotModel(urdf); });
    const std::vector<std::string> lines = base::Split(error, '\n');
    for (const std::vector<std::string>& words : wanted) {
      const bool is_told = std::any_of(lines.begin(), lines.end(), [&](const std::string& told) {
        return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
          return told.find(word) != std::string::npos;
        });
      });
      EXPECT_TRUE(is_told) << base::Join(words, " | ") << "\nin\n" << error;
    }
    EXPECT_EQ(lines.size(), wanted.size() == 1 ? 1u : wanted.size() + 1) << error;
  }
}

TEST_F(RobotMeshes, WhereThePackageIsFoundItIsNotAskedFor) {
  folder_.Write("pkg/my_bot/package.xml", "<package><name>my_bot</name></package>");
  SetPackagePath((folder_.path() / "pkg").string());
  EXPECT_THAT(hires::test_support::ConfigErrorOf(
                  [] { ParseRobotModel(UrdfWith("package://my_bot/meshes/hand.obj"), "r.urdf"); }),
              AllOf(HasSubstr("package 'my_bot' is '"), HasSubstr("has no 'meshes/hand.obj'"),
                    ::testing::Not(HasSubstr("ROS_PACKAGE_PATH"))));
  EXPECT_THAT(hires::test_support::ConfigErrorOf(
                  [] { ParseRobotModel(UrdfWith("package://my_bto/meshes/hand.obj"), "r.urdf"); }),
              AllOf(HasSubstr("did you mean package 'my_bot'?"), HasSubstr("ROS_PACKAGE_PATH")));
}

TEST_F(RobotMeshes, MeshesInMillimetresAreAskedAboutNeverScaled) {
  const std::string box =
      "v -150 -200 0\nv 150 -200 0\nv 150 200 0\nv -150 200 0\nv -150 -200 9000\nv 150 -200 9000\n"
      "v 150 200 9000\nv -150 200 9000\nf 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n"
      "f 3 4 8\nf 3 8 7\n";
  folder_.Write("hand.obj", box);
  const std::string urdf = folder_.Write("r.urdf", UrdfWith("hand.obj"));
  const hires::test_support::LogCatcher log(base::LogLevel::kWarn);
  const Robot robot = LoadRobotFromUrdf(urdf);
  EXPECT_THAT(log.lines,
              ::testing::ElementsAre(AllOf(HasSubstr("hand.obj is 300 x 400 x 9000 m large"),
                                           HasSubstr("in mm it would be 0.3 x 0.4 x 9 m"),
                                           HasSubstr("scale=\"0.001 0.001 0.001\""))));
  geometry::Aabb bounds = geometry::BoundsOf(robot.model.links[0].collisions[0].shape, {});
  EXPECT_EQ(bounds.upper.x(), 150.0);
  // Where it is why there is no footprint, it is in that message.
  const std::string high = folder_.Write(
      "high.urdf",
      "<robot name=\"r\"><link name=\"a\"><collision><origin xyz=\"0 0 500\"/><geometry><mesh "
      "filename=\"hand.obj\"/></geometry></collision></link></robot>");
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { LoadRobotFromUrdf(high); }),
              AllOf(HasSubstr("no footprint"), HasSubstr("hand.obj is 300 x 400 x 9000 m"),
                    HasSubstr("0.001")));
}

TEST_F(RobotMeshes, RobotsOfFiftyMetresAreAskedAbout) {
  const std::string urdf = folder_.Write(
      "r.urdf",
      "<robot name=\"r\"><link name=\"a\"><collision><geometry><box size=\"50 40 1\"/></geometry>"
      "</collision></link></robot>");
  const hires::test_support::LogCatcher log(base::LogLevel::kWarn);
  LoadRobotFromUrdf(urdf);
  EXPECT_THAT(log.lines, ::testing::ElementsAre(AllOf(HasSubstr("50 x 40 m large from above"),
                                                      HasSubstr("in cm 0.5 x 0.4 m"))));
}

}  // namespace
}  // namespace hires::robot::robot_meshes_test
