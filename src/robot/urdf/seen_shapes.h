#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files/package_finder.h"
#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::robot {

/// What a <visual> shows.
struct SeenShape {
  geometry::Pose3 X_LS;                  ///< in the frame of its link
  std::optional<geometry::Shape> shape;  ///< none: a mesh, see LookMeshes
  std::string mesh{};                    ///< its URI
  Eigen::Vector3d scale{Eigen::Vector3d::Ones()};
};

/// By link, of those that have a <visual>: what is seen of it. Nothing of what has no valid size or
/// place, and nothing of text that is no XML.
std::map<std::string, std::vector<SeenShape>> ShapesSeen(const std::string& urdf_xml);

/// Reads meshes of looks while that costs little: no more once it has read kMostBytes, or could not
/// find or read kMostFailed of them.
class LookMeshes {
 public:
  static constexpr std::uintmax_t kMostBytes = 8 << 20;
  static constexpr int kMostFailed = 8;

  /// @param folder  of the URDF, from which paths are seen.
  explicit LookMeshes(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Nothing where it is not read.
  std::optional<geometry::Shape> Read(const SeenShape& seen);

 private:
  std::optional<geometry::Shape> ReadFile(const SeenShape& seen);

  using Key = std::pair<std::string, std::array<double, 3>>;  // URI and scale

  std::filesystem::path folder_;
  base::PackageFinder packages_;
  std::map<Key, std::optional<geometry::Shape>> known_;
  std::uintmax_t num_bytes_{0};
  int num_failed_{0};
};

}  // namespace hires::robot
