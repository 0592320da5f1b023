#include "geometry/plain_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "hires/base/error.h"

namespace hires::geometry {
namespace {

using nlohmann::json;

constexpr int kMostNested = 200;              // Assimp goes down by calling itself
constexpr std::size_t kMostNodes = 20000;     // which take it 0.2 s, ten times as many 20 s
constexpr std::size_t kMostValues = 4000000;  // of 500,000 triangles, each with corners of its own
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
// A .glb: its header, then chunks of a length, a type and data; the first is JSON.
constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;

[[noreturn]] void Refuse(const std::string& path, const std::string& what) {
  throw base::ConfigError(path + ": " + what + "; export it again");
}

std::size_t NumberAt(std::string_view bytes, std::size_t at) {
  std::size_t number = 0;  // little-endian
  for (int i = 3; i >= 0; --i) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

std::string Number(std::size_t number) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> 8 * i & 0xff);
  return bytes;
}

/// Of the brackets of a JSON text.
int DepthOf(std::string_view text) {
  int depth = 0, deepest = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_string = !is_string;
    if (is_string && c == '\\') ++i;  // the next one is no end
    if (is_string) continue;
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

/// null where it has none of that name.
const json& Member(const json& object, const char* name) {
  static const json none;
  if (!object.is_object()) return none;
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

/// Empty where it has none of that name.
const json& ArrayOf(const json& object, const char* name) {
  static const json none = json::array();
  const json& member = Member(object, name);
  return member.is_array() ? member : none;
}

/// `missing` where there is none. More than 32 bits, which no file has, is none either.
std::size_t IndexOf(const json& object, const char* name, std::size_t missing) {
  const json& member = Member(object, name);
  if (!member.is_number_unsigned() || member.get<std::size_t>() > 0xffffffffu) return missing;
  return member.get<std::size_t>();
}

class Gltf {
 public:
  Gltf(std::string_view text, std::size_t num_binary, const std::string& path)
      : num_binary_(num_binary), path_(path) {
    if (DepthOf(text) > kMostNested)
      Refuse(path_, fmt::format("its JSON is nested more than {} deep", kMostNested));
    in_ = json::parse(text.begin(), text.end(), nullptr, false);
    if (!in_.is_object()) Refuse(path_, "holds no valid JSON of glTF");
  }

  json Plain() {
    CheckVersion();
    CheckExtensions();
    json out = Only(in_, {"scene"});
    out["asset"]["version"] = "2.0";
    out["accessors"] = json::array();
    TakeBuffers(&out);
    for (const json& mesh : ArrayOf(in_, "meshes")) {
      json plain = Only(mesh, {"name"});
      plain["primitives"] = json::array();
      for (const json& primitive : ArrayOf(mesh, "primitives"))
        plain["primitives"].push_back(Primitive(primitive, &out["accessors"]));
      out["meshes"].push_back(plain);
    }
    TakeNodes(&out);
    return out;
  }

 private:
  static json Only(const json& object, const std::vector<const char*>& names) {
    json plain = json::object();
    for (const char* name : names)
      if (!Member(object, name).is_null()) plain[name] = object[name];
    return plain;
  }

  void CheckVersion() const {
    const json& version = Member(Member(in_, "asset"), "version");
    if (!version.is_string() || version.get_ref<const std::string&>().rfind("2.", 0) != 0)
      Refuse(path_, fmt::format("is glTF of version {}, wanted 2.0", version.dump()));
  }

  /// Those of looks alone may be passed over.
  void CheckExtensions() const {
    for (const json& extension : ArrayOf(in_, "extensionsRequired")) {
      const std::string name = extension.dump();
      const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
      if (has("material") || has("texture") || has("light")) continue;
      Refuse(path_, fmt::format("needs the extension {}, which is not read, and is to come "
                                "without compression of meshes",
                                name));
    }
  }

  void TakeBuffers(json* out) const {
    for (const json& buffer : ArrayOf(in_, "buffers")) {
      const json& uri = Member(buffer, "uri");
      const bool is_here =
          !uri.is_string() || uri.get_ref<const std::string&>().rfind("data:", 0) == 0;
      if (!is_here)
        Refuse(path_, fmt::format("its corners are in another file, {}, and of a mesh one file is "
                                  "read: wanted .glb",
                                  uri.dump()));
      (*out)["buffers"].push_back(Only(buffer, {"byteLength", "uri"}));
    }
    for (const json& view : ArrayOf(in_, "bufferViews")) {
      (*out)["bufferViews"].push_back(
          Only(view, {"buffer", "byteOffset", "byteLength", "byteStride"}));
    }
  }

  /// Its corners and their order; each has an accessor of its own then.
  json Primitive(const json& primitive, json* accessors) {
    json plain = Only(primitive, {"mode"});
    const auto take = [&](const json& object, const char* name, bool is_corners) {
      accessors->push_back(Accessor(IndexOf(object, name, kNone), is_corners));
      return accessors->size() - 1;
    };
    plain["attributes"]["POSITION"] = take(Member(primitive, "attributes"), "POSITION", true);
    if (!Member(primitive, "indices").is_null())
      plain["indices"] = take(primitive, "indices", false);
    return plain;
  }

  json Accessor(std::size_t index, bool is_corners) {
    const json& accessor = At("accessors", index);
    const json& view = At("bufferViews", IndexOf(accessor, "bufferView", kNone));
    const json& buffer = At("buffers", IndexOf(view, "buffer", kNone));
    const std::size_t kind = IndexOf(accessor, "componentType", 0);
    const bool is_kind = is_corners ? kind == 5126 && Member(accessor, "type") == "VEC3"
                                    : (kind == 5121 || kind == 5123 || kind == 5125) &&
                                          Member(accessor, "type") == "SCALAR";
    const std::size_t size = is_corners ? 12 : kind == 5121 ? 1 : kind == 5123 ? 2 : 4;
    const std::size_t stride = IndexOf(view, "byteStride", size);
    const std::size_t count = IndexOf(accessor, "count", 0);
    const std::size_t view_size = IndexOf(view, "byteLength", 0);
    std::size_t buffer_size = IndexOf(buffer, "byteLength", 0);
    if (Member(buffer, "uri").is_null()) buffer_size = std::min(buffer_size, num_binary_);
    const bool fits =
        count > 0 && stride >= size &&
        IndexOf(accessor, "byteOffset", 0) + (count - 1) * stride + size <= view_size &&
        IndexOf(view, "byteOffset", 0) + view_size <= buffer_size;
    if (!is_kind || !fits || !Member(accessor, "sparse").is_null()) {
      Refuse(path_, is_corners ? "an accessor of its corners is not of 3 floats within their data"
                               : "an accessor of its triangles is not unsigned within their data");
    }
    num_values_ += count;
    if (num_values_ > kMostValues) {
      Refuse(path_, fmt::format("its parts have more than {} corners and indices, so decimate it",
                                kMostValues));
    }
    return Only(accessor, {"bufferView", "byteOffset", "componentType", "count", "type"});
  }

  const json& At(const char* array, std::size_t index) const {
    static const json none;
    const json& all = ArrayOf(in_, array);
    return index < all.size() ? all[index] : none;
  }

  void TakeNodes(json* out) const {
    const json& nodes = ArrayOf(in_, "nodes");
    if (nodes.size() > kMostNodes) {
      Refuse(path_, fmt::format("has {} nodes, at most {} are read, so join them", nodes.size(),
                                kMostNodes));
    }
    std::vector<std::size_t> parents(nodes.size(), kNone);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      NoteParent(ArrayOf(nodes[i], "children"), i, &parents);
      (*out)["nodes"].push_back(Only(
          nodes[i], {"name", "children", "mesh", "matrix", "translation", "rotation", "scale"}));
    }
    for (const json& scene : ArrayOf(in_, "scenes")) {
      std::vector<std::size_t> roots = parents;  // scenes may share nodes
      NoteParent(ArrayOf(scene, "nodes"), nodes.size(), &roots);
      (*out)["scenes"].push_back(Only(scene, {"nodes"}));
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      int depth = 0;
      for (std::size_t at = i; at < nodes.size(); at = parents[at]) {
        if (++depth > kMostNested)
          Refuse(path_, fmt::format("its nodes are nested more than {} deep", kMostNested));
      }
    }
  }

  /// What stands in two places, and in each of them twice, would become as many as one likes.
  void NoteParent(const json& children, std::size_t parent,
                  std::vector<std::size_t>* parents) const {
    for (const json& child : children) {
      if (!child.is_number_unsigned() || child.get<std::size_t>() >= parents->size())
        Refuse(path_, fmt::format("its node {} is not there", child.dump()));
      std::size_t& known = parents->at(child.get<std::size_t>());
      if (known != kNone)
        Refuse(path_, fmt::format("its node {} stands in two places", child.dump()));
      known = parent;
    }
  }

  json in_;
  std::size_t num_binary_;     // bytes behind the JSON
  std::size_t num_values_{0};  // parts may share what they are of
  const std::string& path_;
};

}  // namespace

std::string PlainGltf(const std::string& bytes, bool is_binary, const std::string& path) {
  if (!is_binary) return Gltf(bytes, 0, path).Plain().dump();
  constexpr std::size_t kBegin = kHeaderSize + kChunkHeaderSize;
  const bool is_glb = bytes.rfind("glTF", 0) == 0 && bytes.size() > kBegin;
  const std::size_t end = is_glb ? kBegin + NumberAt(bytes, kHeaderSize) : 0;
  if (!is_glb || end > bytes.size()) Refuse(path, "is no whole .glb");
  const std::size_t num_behind = bytes.size() - end;
  const std::size_t num_binary =
      num_behind < kChunkHeaderSize ? 0
                                    : std::min(num_behind - kChunkHeaderSize, NumberAt(bytes, end));
  std::string text =
      Gltf(std::string_view(bytes).substr(kBegin, end - kBegin), num_binary, path).Plain().dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return bytes.substr(0, 8) + Number(kBegin + text.size() + num_behind) + Number(text.size()) +
         bytes.substr(kHeaderSize + 4, 4) + text + bytes.substr(end);
}

}  // namespace hires::geometry
