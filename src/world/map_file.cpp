#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "hires/world/occupancy_grid.h"
#include "world/pgm.h"
#include "world/png.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxOrigin = 1e5;  // [m]
constexpr std::uint8_t kFreeGrey = 254, kOccupiedGrey = 0, kUnknownGrey = 205;

/// The keys of a map_server YAML.
struct MapParams {
  std::string image;
  double resolution{0.05};       ///< [m] per pixel
  Eigen::Vector2d origin{0, 0};  ///< [m] lower left corner of the lower left pixel
  bool negate{false};            ///< white is occupied
  double occupied_thresh{0.65};  ///< occupied above this share of black
  double free_thresh{0.196};     ///< free below this share of black
};

Eigen::Vector2d ReadOrigin(base::ParamReader* in) {
  if (!in->Has("origin")) {
    in->Fail("origin",
             "wanted [x, y, yaw] of the lower left corner; add origin: [0.0, 0.0, 0.0] "
             "if the map begins at its frame");
  }
  const std::vector<double> origin = in->GetNumbers("origin", 3);
  if (origin[2] != 0.0) {
    in->Fail("origin", fmt::format("wanted a yaw (the third) of 0 and not {}; rotated maps are not "
                                   "read: rotate the image",
                                   origin[2]));
  }
  if (std::max(std::abs(origin[0]), std::abs(origin[1])) > kMaxOrigin) {
    in->Fail("origin", fmt::format("wanted coordinates within {} m", kMaxOrigin));
  }
  return {origin[0], origin[1]};
}

MapParams ReadMapParams(const std::string& yaml_path) {
  const std::string extension = base::ToLower(fs::path(yaml_path).extension().string());
  if (extension == ".png" || extension == ".pgm") {
    throw base::ConfigError(fmt::format(
        "{}: is a map's picture; name the YAML file of map_server that says where it lies, with "
        "image, resolution, origin, negate, occupied_thresh and free_thresh",
        yaml_path));
  }
  base::ParamReader in = base::ParamReader::FromFile(yaml_path);
  MapParams params;
  params.image = in.GetString("image");
  params.resolution = in.Get("resolution", base::Between(1e-4, 100.0));
  params.origin = ReadOrigin(&in);
  params.negate = in.Get("negate", base::Between(0, 1)) == 1;
  params.occupied_thresh = in.Get("occupied_thresh", base::Between(0.0, 1.0));
  params.free_thresh = in.Get("free_thresh", base::Between(0.0, 1.0));
  if (params.free_thresh > params.occupied_thresh) {
    in.Fail("free_thresh", "wanted at most occupied_thresh");
  }
  if (in.Has("mode") && in.GetString("mode") != "trinary") {
    in.Fail("mode",
            "wanted trinary: cells are free, occupied or unknown; leave the line out to have the "
            "picture read so");
  }
  in.RejectUnknownKeys();
  return params;
}

double BlackOf(std::uint8_t grey, const MapParams& params) {
  return (params.negate ? grey : 255 - grey) / 255.0;
}

/// map_server's trinary mode.
Cell CellOf(std::uint8_t grey, const MapParams& params) {
  const double black = BlackOf(grey, params);
  if (black > params.occupied_thresh) return Cell::kOccupied;
  return black < params.free_thresh ? Cell::kFree : Cell::kUnknown;
}

std::uint8_t GreyOf(Cell cell) {
  switch (cell) {
    case Cell::kFree:
      return kFreeGrey;
    case Cell::kOccupied:
      return kOccupiedGrey;
    default:
      return kUnknownGrey;
  }
}

void WriteFile(const fs::path& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    throw base::ConfigError(fmt::format(
        "{}: cannot be written; check that the folder exists and lets you write", path.string()));
  }
}

/// The usual unknown is a grey of 205, which thresholds of another map may take for free. Empty:
/// no grey counts so.
std::string TextOfGreyThatIsFree(const GreyImage& image, const MapParams& params,
                                 const std::string& yaml_path) {
  constexpr double kGrey =
      0.05;  // share of black; what is lighter may be a scanner's or painter's white
  std::map<std::uint8_t, long> greys;
  long num_cells = 0;
  for (const std::uint8_t grey : image.pixels) {
    const double black = BlackOf(grey, params);
    if (black < kGrey || black >= params.free_thresh) continue;
    ++greys[grey];
    ++num_cells;
  }
  if (num_cells == 0) return "";
  const auto most = std::max_element(
      greys.begin(), greys.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const double black = BlackOf(most->first, params);
  double lightest = 1.0;
  for (const auto& [grey, count] : greys) lightest = std::min(lightest, BlackOf(grey, params));
  const double unknown_from =
      std::floor(lightest * 1000.0) / 1000.0;  // rounded so that it has all unknown
  return fmt::format(
      "{}: {} of {} cells are grey in {} (most of them {}) and count as free, as their share of "
      "black, {:.3f}, lies below free_thresh {}; grey is usually unknown: free_thresh: {:.3f} has "
      "them so",
      yaml_path, num_cells, image.pixels.size(), params.image, int{most->first}, black,
      params.free_thresh, unknown_from);
}

}  // namespace

OccupancyGrid LoadMap(const std::string& yaml_path) {
  const MapParams params = ReadMapParams(yaml_path);
  const std::string image_path = (fs::path(yaml_path).parent_path() / params.image).string();
  const std::string bytes = base::ReadTextFile(image_path, 512u << 20);
  const GreyImage image = IsPng(bytes) ? ParsePng(bytes, image_path) : ParsePgm(bytes, image_path);
  OccupancyGrid grid{params.resolution, image.width, image.height, params.origin, {}};
  const std::string grey = TextOfGreyThatIsFree(image, params, yaml_path);
  if (!grey.empty()) {
    base::Log(base::LogLevel::kWarn, grey);
    grid.notes.push_back(grey);
  }
  grid.cells.reserve(image.pixels.size());
  for (int row = image.height - 1; row >= 0; --row) {  // images begin at the top, grids below
    for (int column = 0; column < image.width; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row) * image.width + column;
      grid.cells.push_back(CellOf(image.pixels[pixel], params));
    }
  }
  return grid;
}

void SaveMap(const OccupancyGrid& grid, const std::string& yaml_path) {
  HIRES_CHECK(grid.width >= 1 && grid.height >= 1, "a map has cells");
  GreyImage image{grid.width, grid.height, {}};
  for (int row = grid.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width; ++column) {
      image.pixels.push_back(GreyOf(grid.at(column, row)));
    }
  }
  const fs::path image_path = fs::path(yaml_path).replace_extension(".pgm");
  WriteFile(image_path, FormatPgm(image));
  // {} writes the shortest text that reads back as the same number.
  WriteFile(yaml_path, fmt::format("image: \"{}\"\nresolution: {}\norigin: [{}, {}, 0.0]\n"
                                   "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
                                   image_path.filename().string(), grid.resolution, grid.origin.x(),
                                   grid.origin.y()));
}

}  // namespace hires::world
