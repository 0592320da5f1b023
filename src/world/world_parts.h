#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hires::world {

/// A part of an SDF world, to be read by itself.
struct WorldPart {
  std::string text;                 ///< an SDF document; its elements are in the file's lines
  std::vector<std::size_t> places;  ///< of its models among all of the world, by their order
};

/// Cuts a world into parts, as libsdformat holds some 400 kB for each model that it has read. Every
/// model is in one part. The first part has all that is no model, and the models that are named by
/// the pose of another model or by a frame, or whose own pose counts from elsewhere; so each part
/// means what it meant in the whole.
/// @param text  of an SDF file, well-formed.
/// @param models_per_part  at most so many in each part but the first.
/// @return nothing if there is no need to cut, or if it is no world that could be.
std::vector<WorldPart> CutWorld(const std::string& text, std::size_t models_per_part);

}  // namespace hires::world
