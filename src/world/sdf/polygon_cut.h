#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hires::world {

/// Cuts the area between closed lines into triangles, counter-clockwise; a line within another one
/// is a hole, one within a hole is an island, and so on.
/// @param lines  each of at least 3 corners, in any sense of rotation.
/// @return nothing if lines cross themselves or each other.
std::vector<std::array<Eigen::Vector2d, 3>> CutIntoTriangles(
    std::vector<std::vector<Eigen::Vector2d>> lines);

}  // namespace hires::world
