#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/world/occupancy_grid.h"
#include "hires/world/turned_grid.h"
#include "world/files/map_size.h"
#include "world/maps/map_picture.h"
#include "world/maps/map_yaml.h"
#include "world/maps/pnm.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kFreeGrey = 254, kOccupiedGrey = 0, kUnknownGrey = 205;
constexpr std::size_t kMostBytes = 512u << 20;  // of a picture
constexpr std::size_t kMostBeside = 6;          // pictures that a message names

/// Pictures in the folder of the YAML, those with names like `wanted` first.
std::string PicturesBeside(const fs::path& yaml_path, const std::string& wanted) {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path parent = yaml_path.parent_path();
  for (const auto& entry : fs::directory_iterator(parent.empty() ? "." : parent, error)) {
    if (IsPictureName(entry.path().string())) names.push_back(entry.path().filename().string());
  }
  if (names.empty()) return "no picture lies beside the YAML; put it there";
  std::sort(names.begin(), names.end());
  const std::size_t count = names.size();
  names = base::NearestNames(wanted, names, kMostBeside);
  std::string text = base::Join(names, ", ");
  if (count > names.size()) text += fmt::format(" and {} more", count - names.size());
  return fmt::format("{} {}; write its name, or put the picture there", text,
                     count == 1 ? "is" : "are");
}

/// Paths of Windows, too.
std::string LastPart(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

/// Where the picture lies. A path of another computer is looked for beside the YAML.
std::string FindPicture(const std::string& yaml_path, const MapParams& params,
                        MapFindings* findings) {
  const fs::path folder = fs::path(yaml_path).parent_path();
  const std::string path = (folder / params.image).string();
  std::error_code error;
  if (fs::is_regular_file(path, error)) return path;
  const std::string last = LastPart(params.image);
  const std::string beside = (folder / last).string();
  if (!last.empty() && last != params.image && fs::is_regular_file(beside, error)) {
    findings->notes.push_back(
        fmt::format("{}:{}: image {} is not there, but {} lies beside the "
                    "YAML and is read",
                    yaml_path, params.image_line, params.image, last));
    return beside;
  }
  findings->errors.push_back(
      fmt::format("{}:{}: image {} {}, looked for as {}; {}", yaml_path, params.image_line,
                  params.image, fs::is_directory(path, error) ? "is a folder" : "is not there",
                  path, PicturesBeside(yaml_path, last)));
  return "";
}

/// The mean of pixel i's colours, 0 (black) .. 255, and of its alpha where map_server averages that
/// in.
double LevelOf(const MapPicture& picture, std::size_t i, bool with_alpha) {
  if (!with_alpha) return picture.colours[i] / 3.0;
  return (picture.colours[i] + picture.alpha[i]) / 4.0;
}

double BlackOf(double level, const MapParams& params) {
  return (params.negate ? level : 255.0 - level) / 255.0;
}

bool AveragesAlpha(const MapPicture& picture, const MapParams& params) {
  return params.mode == MapMode::kTrinary && !picture.alpha.empty();
}

Cell CellOf(double occupied, const MapParams& params) {
  if (occupied > params.occupied_thresh) return Cell::kOccupied;
  return occupied < params.free_thresh ? Cell::kFree : Cell::kUnknown;
}

/// What pixel i counts as.
Cell CellOf(const MapPicture& picture, std::size_t i, const MapParams& params, bool with_alpha) {
  const double level = LevelOf(picture, i, with_alpha);
  switch (params.mode) {
    case MapMode::kTrinary:
      break;
    case MapMode::kScale:
      if (!picture.alpha.empty() && picture.alpha[i] != 255) return Cell::kUnknown;
      break;
    case MapMode::kRaw: {  // the level is the occupancy in percent; above 100 nothing is known
      const double percent = std::floor(params.negate ? 255.0 - level : level);
      return percent > 100.0 ? Cell::kUnknown : CellOf(percent / 100.0, params);
    }
  }
  return CellOf(BlackOf(level, params), params);
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

constexpr double kAlmostWhite =
    0.05;  // share of black; what is lighter may be a scanner's or painter's white

/// The usual unknown is a grey of 205, which thresholds of another map, or an alpha channel, may
/// take for free. Empty: no grey counts so.
std::string TextOfGreyThatIsFree(const MapPicture& picture, const MapParams& params,
                                 const std::string& yaml_path) {
  if (params.mode == MapMode::kRaw) return "";
  const bool with_alpha = AveragesAlpha(picture, params);
  std::map<int, long> greys;  // by the brightness of their colours, 0 .. 255
  long num_cells = 0;
  double lightest = 1.0;
  for (std::size_t i = 0; i < picture.colours.size(); ++i) {
    const double black = BlackOf(LevelOf(picture, i, with_alpha), params);
    if (black < kAlmostWhite || CellOf(picture, i, params, with_alpha) != Cell::kFree) continue;
    ++greys[picture.colours[i] / 3];
    ++num_cells;
    lightest = std::min(lightest, black);
  }
  if (num_cells == 0) return "";
  const auto most = std::max_element(
      greys.begin(), greys.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const double unknown_from =
      std::floor(lightest * 1000.0) / 1000.0;  // rounded so that it has all unknown
  return fmt::format(
      "{}: {} of {} cells are grey in {} (most of them {}) and count as free, as their share of "
      "black{} lies below free_thresh {}; grey is usually unknown: free_thresh: {:.3f} has them so",
      yaml_path, num_cells, picture.colours.size(), params.image, most->first,
      with_alpha ? ", in which map_server counts the alpha channel as a fourth colour,"
                 : fmt::format(", {:.3f},", BlackOf(most->first, params)),
      params.free_thresh, unknown_from);
}

/// How the alpha channel changes what a picture shows. Empty: not at all.
std::string TextOfAlpha(const MapPicture& picture, const MapParams& params,
                        const std::string& yaml_path) {
  if (!AveragesAlpha(picture, params)) return "";
  long changed = 0;
  for (std::size_t i = 0; i < picture.colours.size(); ++i) {
    if (CellOf(picture, i, params, true) != CellOf(picture, i, params, false)) ++changed;
  }
  if (changed == 0) return "";
  return fmt::format(
      "{}: {} has an alpha channel, which map_server averages with the colours (mode trinary): {} "
      "of {} cells count otherwise than by their colours; save it without one to have these",
      yaml_path, params.image, changed, picture.colours.size());
}

std::string TextOfTurn(const MapPicture& picture, const MapParams& params,
                       const std::string& yaml_path) {
  if (QuartersOf(params.yaw, picture.width, picture.height)) return "";
  return fmt::format(
      "{}: is turned by {:g} rad about its lower left corner: its cells of {:g} m are drawn anew, "
      "and "
      "all that an occupied one touches is occupied, so that walls may be up to a cell thicker",
      yaml_path, params.yaw, params.resolution);
}

OccupancyGrid GridOf(const MapPicture& picture, const MapParams& params) {
  OccupancyGrid grid{params.resolution, picture.width, picture.height, params.origin, {}};
  const bool with_alpha = AveragesAlpha(picture, params);
  grid.cells.reserve(picture.colours.size());
  for (int row = picture.height - 1; row >= 0; --row) {  // images begin at the top, grids below
    for (int column = 0; column < picture.width; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row) * picture.width + column;
      grid.cells.push_back(CellOf(picture, pixel, params, with_alpha));
    }
  }
  return grid;
}

/// Nothing where there is none, or it is broken: then an error says so.
std::optional<MapPicture> ReadPicture(const std::string& yaml_path, const MapParams& params,
                                      MapFindings* findings) {
  if (params.image.empty()) return std::nullopt;
  const std::string path = FindPicture(yaml_path, params, findings);
  if (path.empty()) return std::nullopt;
  try {
    return ParseMapPicture(base::ReadTextFile(path, kMostBytes), path);
  } catch (const base::ConfigError& error) {
    findings->errors.push_back(error.what());
    return std::nullopt;
  }
}

void NotePicture(const std::string& yaml_path, const MapParams& params, const MapPicture& picture,
                 MapFindings* findings) {
  for (const std::string& text :
       {TextOfAlpha(picture, params, yaml_path), TextOfGreyThatIsFree(picture, params, yaml_path),
        TextOfTurn(picture, params, yaml_path)}) {
    if (!text.empty()) findings->notes.push_back(text);
  }
}

}  // namespace

OccupancyGrid LoadMap(const std::string& yaml_path) {
  MapFindings findings;
  const MapParams params = ReadMapYaml(yaml_path, &findings);
  const std::optional<MapPicture> picture = ReadPicture(yaml_path, params, &findings);
  if (picture && findings.errors.empty()) NotePicture(yaml_path, params, *picture, &findings);
  std::optional<OccupancyGrid> grid;
  if (picture) {
    try {
      grid = TurnedGrid(GridOf(*picture, params), params.yaw);
    } catch (const base::ConfigError& error) {
      findings.errors.push_back(fmt::format("{}: {}", yaml_path, error.what()));
    }
  }
  for (const std::string& warning : findings.warnings) base::Log(base::LogLevel::kWarn, warning);
  for (const std::string& note : findings.notes) base::Log(base::LogLevel::kWarn, note);
  ThrowErrors(yaml_path, findings);
  grid->notes = findings.notes;
  const std::string doubt = DoubtedMapSize(*grid, yaml_path);
  if (!doubt.empty()) grid->notes.push_back(doubt);
  return *std::move(grid);
}

std::string PictureOfMap(const std::string& yaml_path) {
  MapFindings findings;
  try {
    const MapParams params = ReadMapYaml(yaml_path, &findings);
    return params.image.empty() ? "" : FindPicture(yaml_path, params, &findings);
  } catch (const base::ConfigError&) {
    return "";  // what is wrong, LoadMap() says
  }
}

std::string PictureToSave(const std::string& yaml_path) {
  return fs::path(yaml_path).replace_extension(".pgm").string();
}

void SaveMap(const OccupancyGrid& grid, const std::string& yaml_path) {
  HIRES_CHECK(grid.width >= 1 && grid.height >= 1, "a map has cells");
  GreyImage image{grid.width, grid.height, {}};
  for (int row = grid.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width; ++column) {
      image.pixels.push_back(GreyOf(grid.at(column, row)));
    }
  }
  const fs::path image_path = PictureToSave(yaml_path);
  WriteFile(image_path, FormatPgm(image));
  // {} writes the shortest text that reads back as the same number.
  WriteFile(yaml_path, fmt::format("image: \"{}\"\nresolution: {}\norigin: [{}, {}, 0.0]\n"
                                   "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
                                   image_path.filename().string(), grid.resolution, grid.origin.x(),
                                   grid.origin.y()));
}

}  // namespace hires::world
