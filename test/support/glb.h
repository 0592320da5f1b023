#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace hires::test_support {

/// The JSON and the data of a glTF 2 file: a tetrahedron `tetra` with corners at the origin and 1,
/// 2 and 3 m along x, y and z, in a node `part` that lifts it by 10 m along z.
struct SmallGltf {
  nlohmann::json json;
  std::string data;
};

template <typename Value>
void AppendBytes(Value value, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&value), sizeof(value));  // little-endian, as glTF
}

inline SmallGltf TetrahedronGltf() {
  SmallGltf gltf;
  for (const float x : {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}) AppendBytes(x, &gltf.data);
  for (const std::uint16_t i : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) AppendBytes(i, &gltf.data);
  gltf.json = nlohmann::json::parse(R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "part", "translation": [0, 0, 10]}],
    "meshes": [{"name": "tetra", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48},
                    {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
    "buffers": [{"byteLength": 72}]})");
  return gltf;
}

/// As one file.
inline std::string GlbOf(const std::string& json, std::string data) {
  std::string text = json;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  data.resize((data.size() + 3) / 4 * 4);
  std::string glb = "glTF";
  AppendBytes(std::uint32_t{2}, &glb);
  AppendBytes(static_cast<std::uint32_t>(28 + text.size() + data.size()), &glb);
  AppendBytes(static_cast<std::uint32_t>(text.size()), &glb);
  glb += "JSON" + text;
  AppendBytes(static_cast<std::uint32_t>(data.size()), &glb);
  return glb + std::string("BIN\0", 4) + data;
}

inline std::string GlbOf(const SmallGltf& gltf) { return GlbOf(gltf.json.dump(), gltf.data); }

}  // namespace hires::test_support
