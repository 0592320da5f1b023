#include <gmock/gmock.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/robot/robot_model.h"
#include "support/temporary_folder.h"

namespace hires::robot::robot_meshes_test {
namespace {

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

  test_support::TemporaryFolder folder_;
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

}  // namespace
}  // namespace hires::robot::robot_meshes_test
