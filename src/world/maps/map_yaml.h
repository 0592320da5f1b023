#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace hires::world {

/// How map_server turns a picture into cells.
enum class MapMode { kTrinary, kScale, kRaw };

/// What a map_server YAML says.
struct MapParams {
  std::string image;             ///< as it is written
  int image_line{0};             ///< where; 0: nowhere
  double resolution{0.05};       ///< [m] per pixel
  Eigen::Vector2d origin{0, 0};  ///< [m] lower left corner of the lower left pixel
  double yaw{0.0};               ///< [rad] of the picture about that corner, counter-clockwise
  bool negate{false};            ///< white is occupied
  double occupied_thresh{0.65};  ///< occupied above this share of black
  double free_thresh{0.196};     ///< free below this share of black
  MapMode mode{MapMode::kTrinary};
};

/// All that is wrong with a file and all that its reader should know, instead of the first alone.
struct MapFindings {
  std::vector<std::string> errors;    ///< whole messages, "m.yaml:3: ..."
  std::vector<std::string> warnings;  ///< what was passed over
  std::vector<std::string> notes;     ///< warnings that an answer should carry
};

/// Reads a map's YAML. Keys that are none of map_server's are passed over with one warning, but for
/// those that look like one of its keys mistyped. Missing keys for which map_server has a default
/// (`negate` 0, `occupied_thresh` 0.65, `free_thresh` 0.196 of its older way to be started, `mode`
/// trinary) take it; all but `mode` are noted.
/// [map_server/src/main.cpp in ros-planning/navigation; nav2_map_server/src/map_io.cpp]
/// @param[out] findings  What is wrong with single keys; the rest is read all the same.
/// @throws base::ConfigError: no such file, no YAML, or a file of another kind, which is named.
MapParams ReadMapYaml(const std::string& yaml_path, MapFindings* findings);

/// Throws all errors in one, if there are any.
void ThrowErrors(const std::string& file, const MapFindings& findings);

}  // namespace hires::world
