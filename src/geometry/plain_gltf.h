#pragma once

#include <string>

namespace hires::geometry {

/// Only what is shape of a glTF file: nodes, and the corners and indices of meshes. All else
/// (looks, skins, animations, names of extensions) is gone, and what is left fits together, as
/// Assimp does not survive accessors that reach beyond their data, or nodes nested by the thousand.
/// @param bytes  of the file
/// @param is_binary  .glb and not .gltf; so is what is given back.
/// @throws base::ConfigError naming the path: no glTF 2, a buffer in another file, an extension
/// without which the file cannot be understood (compressed or quantized corners), accessors that do
/// not fit their data, nodes in two places, nested more than 200 deep, or more than 20,000.
std::string PlainGltf(const std::string& bytes, bool is_binary, const std::string& path);

}  // namespace hires::geometry
