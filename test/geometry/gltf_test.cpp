// Meshes of glTF 2: read as Gazebo reads them, and what is wrong or too much is refused.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cctype>
#include <filesystem>
#include <fstream>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/geometry/mesh_reader.h"
#include "support/glb.h"

namespace hires::geometry::gltf_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using nlohmann::json;
using test_support::GlbOf;
using test_support::SmallGltf;
using test_support::TetrahedronGltf;

class GltfTest : public ::testing::Test {
 protected:
  GltfTest()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ("hires_gltf_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~GltfTest() override { std::filesystem::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }
  TriangleMesh Read(const SmallGltf& gltf, const Submesh& submesh = {}) const {
    return ReadMesh(Write("a.glb", GlbOf(gltf)), Eigen::Vector3d::Ones(), submesh);
  }
  void ExpectRefused(const std::string& name, const std::string& bytes,
                     const std::string& why) const {
    const std::string path = Write(name, bytes);
    EXPECT_THAT([&] { ReadMesh(path); },
                ThrowsMessage<base::ConfigError>(AllOf(HasSubstr(path), HasSubstr(why))));
  }
  void ExpectRefused(const SmallGltf& gltf, const std::string& why) const {
    ExpectRefused("a.glb", GlbOf(gltf), why);
  }

 private:
  std::filesystem::path folder_;
};

Aabb BoxOf(const TriangleMesh& mesh) {
  Aabb box;
  for (const Eigen::Vector3d& p : mesh.vertices) box.Include(p);
  return box;
}

double VolumeOf(const TriangleMesh& mesh) {
  double sixfold = 0.0;
  for (const auto& t : mesh.triangles)
    sixfold += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  return sixfold / 6.0;
}

void ExpectBox(const TriangleMesh& mesh, const Eigen::Vector3d& lower,
               const Eigen::Vector3d& upper) {
  EXPECT_TRUE((BoxOf(mesh).lower - lower).norm() < 1e-6) << BoxOf(mesh).lower.transpose();
  EXPECT_TRUE((BoxOf(mesh).upper - upper).norm() < 1e-6) << BoxOf(mesh).upper.transpose();
}

TEST_F(GltfTest, AxesAndMetresAreThoseOfTheFile) {
  const TriangleMesh mesh = Read(TetrahedronGltf());
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(VolumeOf(mesh), 1.0, 1e-6) << "counter-clockwise from outside";
  ExpectBox(mesh, {0, 0, 10}, {1, 2, 13});
  const std::string upper = Write("A.GLB", GlbOf(TetrahedronGltf()));
  ExpectBox(ReadMesh(upper, {2.0, 1.0, -1.0}), {0, 0, -13}, {2, 2, -10});
}

TEST_F(GltfTest, RotationsOfNodesCountThatOfTheOutermostToo) {
  SmallGltf turned = TetrahedronGltf();
  turned.json["nodes"] = json::parse(R"([{"children": [1], "rotation": [0.70710678, 0, 0,
    0.70710678]}, {"mesh": 0, "translation": [0, 1, 0]}])");  // y up becomes z up
  ExpectBox(Read(turned), {0, -3, 1}, {1, 0, 3});
}

TEST_F(GltfTest, PartsAreNamedByNodeOrMeshAndPlacedAsOftenAsNodesSay) {
  SmallGltf two = TetrahedronGltf();
  two.json["scenes"][0]["nodes"] = {0, 1};
  two.json["nodes"] = json::parse(R"([{"mesh": 0, "name": "left"},
    {"mesh": 0, "name": "right", "translation": [5, 0, 0]}])");
  ExpectBox(Read(two), {0, 0, 0}, {6, 2, 3});
  ExpectBox(Read(two, {"right", false}), {5, 0, 0}, {6, 2, 3});
  ExpectBox(Read(two, {"right", true}), {-0.5, -1, -1.5}, {0.5, 1, 1.5});
  EXPECT_EQ(Read(two, {"tetra", false}).triangles.size(), 8u);
  EXPECT_THROW(Read(two, {"middle", false}), base::ConfigError);
}

TEST_F(GltfTest, LooksAnimationsAndTheirExtensionsArePassedOver) {
  SmallGltf painted = TetrahedronGltf();
  json& primitive = painted.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = 99;
  primitive["material"] = 99;
  primitive["targets"] = json::parse(R"([{"POSITION": 99}])");
  painted.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  painted.json["animations"] = json::parse(R"([{"channels": [{"sampler": 99}]}])");
  painted.json["images"] = json::parse(R"([{"uri": "../secret.png"}])");
  painted.json["skins"] = json::parse(R"([{"joints": [99]}])");
  ExpectBox(Read(painted), {0, 0, 10}, {1, 2, 13});
}

TEST_F(GltfTest, DataMayStandInTheTextAndNotInAnotherFile) {
  SmallGltf gltf = TetrahedronGltf();
  gltf.json["buffers"][0]["uri"] =
      "data:application/"
      "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAA"
      "AAAAAEBAAAACAAEAAAABAAMAAAADAAIAAQACAAMA";
  ExpectBox(ReadMesh(Write("a.gltf", gltf.json.dump())), {0, 0, 10}, {1, 2, 13});
  gltf.json["buffers"][0]["uri"] = "a.bin";
  Write("a.bin", gltf.data);
  ExpectRefused("a.gltf", gltf.json.dump(), "another file, \"a.bin\"");
  ExpectRefused(gltf, "wanted .glb");
}

TEST_F(GltfTest, WhatIsReadWronglyWithoutItsExtensionIsRefused) {
  for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                "KHR_mesh_quantization", "OF_tomorrow"}) {
    SmallGltf gltf = TetrahedronGltf();
    gltf.json["extensionsRequired"] = {"KHR_materials_unlit", extension};
    ExpectRefused(gltf, extension);
  }
}

TEST_F(GltfTest, AccessorsReachNoFartherThanTheirData) {
  const auto refused = [&](const char* place, const json& value, const char* why) {
    SmallGltf gltf = TetrahedronGltf();
    gltf.json[json::json_pointer(place)] = value;
    SCOPED_TRACE(place);
    ExpectRefused(gltf, why);
  };
  const char corners[] = "its corners", triangles[] = "its triangles";
  refused("/accessors/0/count", 5, corners);
  refused("/accessors/0/count", 0, corners);
  refused("/accessors/0/count", -1, corners);
  refused("/accessors/0/byteOffset", 1, corners);
  refused("/accessors/0/componentType", 5122, corners);
  refused("/accessors/0/type", "VEC2", corners);
  refused("/accessors/0/bufferView", 7, corners);
  refused("/accessors/0/sparse", json::object(), corners);
  refused("/accessors/1/count", 13, triangles);
  refused("/accessors/1/count", 4000000000u, triangles);
  refused("/accessors/1/componentType", 5125, triangles);
  refused("/bufferViews/0/byteLength", 1ull << 40, corners);
  refused("/bufferViews/0/byteStride", 16, corners);
  refused("/bufferViews/0/byteStride", 0, corners);
  refused("/bufferViews/1/byteOffset", 49, triangles);
  refused("/buffers/0/byteLength", 71, triangles);
  refused("/meshes/0/primitives/0/attributes/POSITION", 77, corners);
  refused("/meshes/0/primitives/0/indices", "x", triangles);
  SmallGltf cut = TetrahedronGltf();
  cut.data.resize(68);
  ExpectRefused(cut, triangles);
}

TEST_F(GltfTest, WhatWouldGrowOrGoDownWithoutEndIsRefused) {
  SmallGltf deep = TetrahedronGltf();
  deep.json["nodes"] = json::array();
  for (int i = 1; i < 201; ++i) deep.json["nodes"].push_back({{"children", {i}}});
  deep.json["nodes"].push_back({{"mesh", 0}});
  ExpectRefused(deep, "nested more than 200 deep");
  deep.json["nodes"][0] = {{"children", {2}}};
  deep.json["nodes"][1] = json::object();
  EXPECT_EQ(Read(deep).triangles.size(), 4u);
  deep.json["nodes"][5]["children"] = {6, 6};
  ExpectRefused(deep, "node 6 stands in two places");
  deep.json["nodes"][5]["children"] = {0};
  ExpectRefused(deep, "node 0 stands in two places");
  const std::string text = TetrahedronGltf().json.dump(), data = TetrahedronGltf().data;
  const std::string nested = text.substr(0, text.size() - 1) +
                             ",\"extras\":" + std::string(100000, '[') + std::string(100000, ']') +
                             "}";
  ExpectRefused("a.glb", GlbOf(nested, data), "nested more than 200 deep");
  SmallGltf many = TetrahedronGltf();
  many.json["nodes"] = json::array();
  many.json["scenes"][0]["nodes"] = json::array();
  for (int i = 0; i < 20001; ++i) {
    many.json["scenes"][0]["nodes"].push_back(i);
    many.json["nodes"].push_back({{"mesh", 0}});
  }
  ExpectRefused(many, "has 20001 nodes");
}

TEST_F(GltfTest, MeshesCountAsOftenAsTheyArePlaced) {
  SmallGltf gltf = TetrahedronGltf();
  json& primitives = gltf.json["meshes"][0]["primitives"];
  primitives = json::array();
  for (int i = 0; i < 100; ++i)
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  gltf.json["nodes"] = json::array();
  gltf.json["scenes"][0]["nodes"] = json::array();
  for (int i = 0; i < 1251; ++i) {
    gltf.json["scenes"][0]["nodes"].push_back(i);
    gltf.json["nodes"].push_back({{"mesh", 0}});
  }
  ExpectRefused(gltf, "has 500400 triangles, at most 500000");
}

TEST_F(GltfTest, OtherVersionsAndWhatIsNoneAreRefused) {
  SmallGltf old = TetrahedronGltf();
  old.json["asset"]["version"] = "1.0";
  ExpectRefused(old, "version \"1.0\", wanted 2.0");
  const std::string glb = GlbOf(TetrahedronGltf());
  for (const std::string& bytes : {glb.substr(0, 3), glb.substr(0, 20), glb.substr(0, 200)})
    ExpectRefused("a.glb", bytes, "no whole .glb");
  for (const char* text : {"rubbish", "[]", "{\"asset\":", "3"}) {
    ExpectRefused("a.gltf", text, "no valid JSON");
    ExpectRefused("a.glb", GlbOf(text, ""), "no valid JSON");
  }
  ExpectRefused("a.glb", "", "is empty");
  SmallGltf lines = TetrahedronGltf();
  lines.json["meshes"][0]["primitives"][0]["mode"] = 1;
  EXPECT_THROW(Read(lines), base::ConfigError);
}

TEST_F(GltfTest, DamagedFilesAreReadOrRefused) {
  const std::string sound = GlbOf(TetrahedronGltf());
  const base::Rng seeds(7);
  int num_read = 0, num_refused = 0;
  for (std::uint64_t round = 0; round < 300; ++round) {
    base::Rng rng = seeds.Fork(round);
    std::string bytes = sound;
    for (int i = 1 + rng.Index(3); i > 0; --i) {
      char& byte = bytes[rng.Index(static_cast<int>(bytes.size()))];
      byte = std::isdigit(static_cast<unsigned char>(byte)) ? static_cast<char>('0' + rng.Index(10))
             : rng.Bernoulli(0.3)                           ? static_cast<char>(rng.Index(256))
                                                            : byte;
    }
    try {
      ReadMesh(Write("a.glb", bytes));
      ++num_read;
    } catch (const base::ConfigError&) {
      ++num_refused;
    }
  }
  EXPECT_GT(num_read, 25);
  EXPECT_GT(num_refused, 25);
}

}  // namespace
}  // namespace hires::geometry::gltf_test
