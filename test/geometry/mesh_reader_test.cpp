#include "hires/geometry/mesh_reader.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "geometry/mesh_units.h"
#include "hires/base/error.h"

namespace hires::geometry::mesh_reader_test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

/// A tetrahedron with corners at the origin and at 1 m on each axis: volume 1/6 m^3.
constexpr char kTetrahedronStl[] = R"(solid tetrahedron
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 1 0
vertex 1 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 0 1
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 1
vertex 0 1 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 1 0 0
vertex 0 1 0
vertex 0 0 1
endloop
endfacet
endsolid tetrahedron
)";

constexpr char kTetrahedronObj[] = R"(mtllib colours.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
usemtl red
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
)";

/// The same in millimetres, y up, and below a node that lifts it by 2000 mm along z.
constexpr char kTetrahedronDae[] = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis></asset>
  <library_geometries><geometry id="g" name="g"><mesh>
    <source id="p"><float_array id="pa" count="12">0 0 0 1000 0 0 0 1000 0 0 0 1000</float_array>
      <technique_common><accessor source="#pa" count="4" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
      <p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n">
    <translate>0 0 2000</translate><instance_geometry url="#g"/>
  </node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";

class MeshReader : public ::testing::Test {
 protected:
  MeshReader()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ("hires_mesh_reader_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~MeshReader() override { std::filesystem::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  std::filesystem::path folder_;
};

/// Signed volume: positive when all triangles are counter-clockwise seen from outside [m^3].
double VolumeOf(const TriangleMesh& mesh) {
  double sixfold = 0.0;
  for (const auto& t : mesh.triangles) {
    sixfold += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  return sixfold / 6.0;
}

Aabb BoxOf(const TriangleMesh& mesh) {
  Aabb box;
  for (const Eigen::Vector3d& p : mesh.vertices) box.Include(p);
  return box;
}

TEST_F(MeshReader, ReadsStlAndJoinsCorners) {
  const TriangleMesh mesh = ReadMesh(Write("a.STL", kTetrahedronStl));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(VolumeOf(mesh), 1.0 / 6.0, 1e-12);
}

TEST_F(MeshReader, ReadsBinaryStl) {
  std::string bytes(80, ' ');
  const auto add = [&bytes](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  add(std::uint32_t{1});
  for (const float x : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f}) add(x);
  add(std::uint16_t{0});
  const TriangleMesh mesh = ReadMesh(Write("a.stl", bytes));
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(BoxOf(mesh).upper, Eigen::Vector3d(2.0, 3.0, 0.0));
}

TEST_F(MeshReader, ReadsObjWithoutItsMaterials) {
  const TriangleMesh mesh = ReadMesh(Write("a.obj", kTetrahedronObj));
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(VolumeOf(mesh), 1.0 / 6.0, 1e-12);
}

TEST_F(MeshReader, ColladaUnitCountsAndUpAxisDoesNot) {
  const TriangleMesh mesh = ReadMesh(Write("a.dae", kTetrahedronDae));
  EXPECT_NEAR(VolumeOf(mesh), 1.0 / 6.0, 1e-6);
  EXPECT_TRUE(BoxOf(mesh).lower.isApprox(Eigen::Vector3d(0.0, 0.0, 2.0), 1e-6));
  EXPECT_TRUE(BoxOf(mesh).upper.isApprox(Eigen::Vector3d(1.0, 1.0, 3.0), 1e-6));
}

TEST_F(MeshReader, ScaleMultipliesEachAxis) {
  const TriangleMesh mesh = ReadMesh(Write("a.stl", kTetrahedronStl), {2.0, 3.0, 0.5});
  EXPECT_EQ(BoxOf(mesh).upper, Eigen::Vector3d(2.0, 3.0, 0.5));
  EXPECT_NEAR(VolumeOf(mesh), 0.5, 1e-12);
}

TEST_F(MeshReader, MirroredMeshKeepsItsOutsideOut) {
  const TriangleMesh mesh = ReadMesh(Write("a.stl", kTetrahedronStl), {1.0, -1.0, 1.0});
  EXPECT_EQ(BoxOf(mesh).lower, Eigen::Vector3d(0.0, -1.0, 0.0));
  EXPECT_NEAR(VolumeOf(mesh), 1.0 / 6.0, 1e-12);
}

TEST_F(MeshReader, SplitsPolygons) {
  const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  EXPECT_EQ(ReadMesh(Write("a.obj", quad)).triangles.size(), 2u);
}

TEST_F(MeshReader, DropsTrianglesWithoutArea) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\n";
  EXPECT_EQ(ReadMesh(Write("a.obj", text)).triangles.size(), 1u);
}

TEST_F(MeshReader, SameFileSameBits) {
  const std::string path = Write("a.stl", kTetrahedronStl);
  const TriangleMesh one = ReadMesh(path), two = ReadMesh(path);
  EXPECT_EQ(one.vertices, two.vertices);
  EXPECT_EQ(one.triangles, two.triangles);
}

TEST_F(MeshReader, RefusesMissingFile) {
  const std::string path = (folder_ / "none.stl").string();
  EXPECT_THAT([&] { ReadMesh(path); },
              ThrowsMessage<base::ConfigError>(AllOf(HasSubstr(path), HasSubstr("no such file"))));
}

TEST_F(MeshReader, RefusesOtherFormats) {
  EXPECT_THAT([&] { ReadMesh(Write("a.blend", "x")); },
              ThrowsMessage<base::ConfigError>(AllOf(
                  HasSubstr("'.blend'"), HasSubstr("convert it to .stl, .dae, .obj or .glb"))));
}

TEST_F(MeshReader, RefusesMalformedFiles) {
  for (const char* name : {"a.stl", "a.dae", "a.obj"}) {
    EXPECT_THROW(ReadMesh(Write(name, "<rubbish")), base::ConfigError) << name;
    EXPECT_THROW(ReadMesh(Write(name, "")), base::ConfigError) << name;
  }
}

TEST_F(MeshReader, EmptyFilesAndPointersOfGitLfsAreCalledSo) {
  for (const char* name : {"a.stl", "b.STL", "c.dae", "d.obj"}) {
    for (const char* empty : {"", "\n", " \r\n\t"}) {
      EXPECT_THAT([&] { ReadMesh(Write(name, empty)); },
                  ThrowsMessage<base::ConfigError>(AllOf(HasSubstr(name), HasSubstr("is empty"))));
    }
    EXPECT_THAT(
        [&] {
          ReadMesh(
              Write(name, "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 7\n"));
        },
        ThrowsMessage<base::ConfigError>(
            AllOf(HasSubstr(name), HasSubstr("pointer of Git LFS"), HasSubstr("git lfs pull"))));
    EXPECT_THAT([&] { ReadMesh(Write(name, "rubbish")); },
                ThrowsMessage<base::ConfigError>(AllOf(HasSubstr(name), Not(HasSubstr("magic")))));
  }
}

TEST_F(MeshReader, UnknownSubmeshListsEachNameOnce) {
  const std::string path =
      Write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\no left\nf 1 2 3\no right\nf 1 3 2\n");
  const auto wanted = [&] { ReadMesh(path, {1.0, 1.0, 1.0}, {"middle", false}); };
  EXPECT_THAT(wanted, ThrowsMessage<base::ConfigError>(AllOf(
                          HasSubstr("submesh 'middle' is unknown"), ContainsRegex("left.*right"),
                          Not(ContainsRegex("left.*left")), Not(ContainsRegex("right.*right")))));
}

TEST_F(MeshReader, RefusesIndexBeyondTheCorners) {
  EXPECT_THROW(ReadMesh(Write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")), base::ConfigError);
}

TEST_F(MeshReader, RefusesBinaryStlThatClaimsMoreThanItHas) {
  std::string bytes(80, ' ');
  const std::uint32_t count = 4000000000u;
  bytes.append(reinterpret_cast<const char*>(&count), sizeof(count));
  EXPECT_THROW(ReadMesh(Write("a.stl", bytes)), base::ConfigError);
}

TEST_F(MeshReader, RefusesLinesOnly) {
  EXPECT_THROW(ReadMesh(Write("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), base::ConfigError);
}

TEST_F(MeshReader, RefusesFarCoordinates) {
  EXPECT_THAT(
      [&] {
        ReadMesh(Write("a.stl", kTetrahedronStl), {2e4, 1.0, 1.0});
      },
      ThrowsMessage<base::ConfigError>(HasSubstr("beyond 10000 m")));
}

TEST_F(MeshReader, RefusesZeroAndInfiniteScale) {
  const std::string path = Write("a.stl", kTetrahedronStl);
  EXPECT_THAT(
      [&] {
        ReadMesh(path, {1.0, 0.0, 1.0});
      },
      ThrowsMessage<base::ConfigError>(HasSubstr("scale is (1, 0, 1)")));
  EXPECT_THROW(ReadMesh(path, {1.0, INFINITY, 1.0}), base::ConfigError);
}

std::string Wide(const std::string& text, bool is_big_endian) {
  std::string wide;
  for (const char letter : text) {
    wide += is_big_endian ? '\0' : letter;
    wide += is_big_endian ? letter : '\0';
  }
  return wide;
}

TEST_F(MeshReader, TellsTextInUtf16) {
  for (const bool is_big_endian : {true, false}) {
    const std::string mark = is_big_endian ? "\xFE\xFF" : "\xFF\xFE";
    for (const char* name : {"a.obj", "a.dae", "a.stl"}) {
      const std::string text = name == std::string("a.dae")   ? kTetrahedronDae
                               : name == std::string("a.obj") ? kTetrahedronObj
                                                              : kTetrahedronStl;
      EXPECT_THAT([&] { ReadMesh(Write(name, mark + Wide(text, is_big_endian))); },
                  ThrowsMessage<base::ConfigError>(HasSubstr("UTF-16, wanted UTF-8")))
          << name;
    }
    EXPECT_THAT([&] { ReadMesh(Write("b.dae", Wide(kTetrahedronDae, is_big_endian))); },
                ThrowsMessage<base::ConfigError>(HasSubstr("UTF-16, wanted UTF-8")));
  }
}

TEST(DoubtedUnitTest, AFileThatSaysItsUnitIsDoubtedWhereItIsLargerThanABuilding) {
  const auto doubt = [](double size) {
    TriangleMesh mesh;
    mesh.vertices = {{0.0, 0.0, 0.0}, {size, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    mesh.triangles = {{0, 1, 2}};
    return DoubtedUnit("a.dae", mesh, {1.0, 1.0, 1.0}, {}, "<scale>{}</scale>");
  };
  EXPECT_EQ(doubt(99.0), "");
  EXPECT_THAT(doubt(3000.0), AllOf(HasSubstr("3000 x 1 x 0 m"), HasSubstr("<unit>"),
                                   HasSubstr("<scale>0.001 0.001 0.001</scale>")));
}

}  // namespace
}  // namespace hires::geometry::mesh_reader_test
