#include "world/maps/map_yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "hires/base/error.h"
#include "hires/base/radians.h"
#include "hires/base/short_text.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "world/maps/map_picture.h"

namespace hires::world {
namespace {

constexpr double kMaxOrigin = 1e5;  // [m]
constexpr double kNoYaw = 1e-6;     // [rad] what tools write for 0
constexpr std::size_t kMostNamed = 12;

const std::vector<std::string>& KnownKeys() {
  static const std::vector<std::string> keys{"image",           "resolution",  "origin", "negate",
                                             "occupied_thresh", "free_thresh", "mode"};
  return keys;
}

std::string WrittenAs(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  return node.IsMap() ? "a map" : "empty";
}

/// Whether a key that is none of map_server's is one of them mistyped.
/// @param is_missing  whether that one is not there
bool IsMeant(const std::string& key, const std::string& known, bool is_missing) {
  if (base::ToLower(key) == known || base::AreSpeltAlike(key, known)) return true;
  // A foreign key may be like one that is there; where it is not, more may have meant it.
  return is_missing && !base::LikelyNames(key, {known}).empty();
}

/// Reads key after key, and collects what is wrong with each.
class MapYamlReader {
 public:
  MapYamlReader(const std::string& file, const YAML::Node& document, MapFindings* findings)
      : file_(file), findings_(*findings) {
    for (const auto& entry : document) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      const int line = entry.first.Mark().line + 1;
      if (!entries_.emplace(key, Entry{entry.second, line}).second) {
        Fail(line, fmt::format("{} stands twice, first in line {}; keep one", key,
                               entries_.at(key).line));
      }
    }
    RefuseMistyped();
  }

  MapParams Read() {
    MapParams params;
    ReadImage(&params);
    if (const auto resolution = Number("resolution", 1e-4, 100.0, "[m] of a pixel"))
      params.resolution = *resolution;
    ReadOrigin(&params);
    ReadNegate(&params);
    if (const auto share = Share("occupied_thresh")) params.occupied_thresh = *share;
    if (const auto share = Share("free_thresh")) params.free_thresh = *share;
    if (params.free_thresh > params.occupied_thresh) {
      const int line = std::max(LineOf("free_thresh"), LineOf("occupied_thresh"));
      Fail(line, fmt::format("free_thresh is {}, wanted at most occupied_thresh, which is {}",
                             params.free_thresh, params.occupied_thresh));
    }
    ReadMode(&params);
    NoteDefaults();
    NameForeign();
    return params;
  }

 private:
  struct Entry {
    YAML::Node value;
    int line;
  };

  void Fail(int line, const std::string& what) {
    findings_.errors.push_back(line > 0 ? fmt::format("{}:{}: {}", file_, line, what)
                                        : fmt::format("{}: {}", file_, what));
  }
  int LineOf(const std::string& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() ? 0 : found->second.line;
  }
  const YAML::Node* Find(const std::string& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() ? nullptr : &found->second.value;
  }
  void FailValue(const std::string& key, const std::string& wanted) {
    Fail(LineOf(key), fmt::format("{} is {}, wanted {}", key, WrittenAs(*Find(key)), wanted));
  }
  /// Missing, and no mistyped key was told already.
  void FailMissing(const std::string& key, const std::string& remedy) {
    if (mistyped_.count(key) == 0) Fail(0, fmt::format("{} is missing; {}", key, remedy));
  }

  void RefuseMistyped() {
    for (const auto& [key, entry] : entries_) {
      const std::string& name = key;
      if (std::count(KnownKeys().begin(), KnownKeys().end(), name) > 0) continue;
      const auto meant =
          std::find_if(KnownKeys().begin(), KnownKeys().end(), [&](const std::string& known) {
            return IsMeant(name, known, Find(known) == nullptr && known != "mode");
          });
      if (meant == KnownKeys().end()) {
        foreign_.emplace(entry.line, name);
        continue;
      }
      mistyped_.insert(*meant);
      Fail(entry.line, fmt::format("key '{}' is unknown; did you mean '{}'?", name, *meant));
    }
  }

  void ReadImage(MapParams* params) {
    const YAML::Node* image = Find("image");
    if (image == nullptr) return FailMissing("image", "add the name of the map's picture");
    if (!image->IsScalar() || image->Scalar().empty())
      return FailValue("image", "the name of the map's picture");
    params->image = image->Scalar();
    params->image_line = LineOf("image");
  }

  static bool ToNumber(const YAML::Node& node, double* number) {
    return node.IsScalar() && YAML::convert<double>::decode(node, *number) &&
           std::isfinite(*number);
  }

  std::optional<double> Number(const std::string& key, double lower, double upper,
                               const std::string& unit) {
    const YAML::Node* node = Find(key);
    if (node == nullptr) {
      FailMissing(key, "add it, " + unit);
      return std::nullopt;
    }
    double number = 0.0;
    if (ToNumber(*node, &number) && number >= lower && number <= upper) return number;
    FailValue(key, fmt::format("a number between {:g} and {:g}, {}", lower, upper, unit));
    return std::nullopt;
  }

  /// A threshold, or nothing where map_server's default holds.
  std::optional<double> Share(const std::string& key) {
    const YAML::Node* node = Find(key);
    if (node == nullptr) {
      TakeDefault(key, key == "free_thresh" ? "0.196" : "0.65");
      return std::nullopt;
    }
    double number = 0.0;
    const bool is_number = ToNumber(*node, &number);
    if (is_number && number >= 0.0 && number <= 1.0) return number;
    FailValue(key, is_number && number > 1.0 && number <= 100.0
                       ? fmt::format("a share of black between 0 and 1; in percent, it is {:g}",
                                     number / 100.0)
                       : "a share of black between 0 and 1");
    return std::nullopt;
  }

  void ReadOrigin(MapParams* params) {
    const YAML::Node* origin = Find("origin");
    if (origin == nullptr) {
      return FailMissing("origin",
                         "wanted [x, y, yaw] of the lower left corner; add origin: [0.0, 0.0, 0.0] "
                         "if the map begins at its frame");
    }
    constexpr char kWanted[] = "[x, y, yaw] of the lower left corner [m, m, rad]";
    if (!origin->IsSequence() || origin->size() != 3) return FailValue("origin", kWanted);
    double numbers[3];
    for (int i = 0; i < 3; ++i) {
      const YAML::Node item = (*origin)[i];
      if (ToNumber(item, &numbers[i])) continue;
      return Fail(LineOf("origin"),
                  fmt::format("origin: number {} is {}, wanted a finite number; {}", i + 1,
                              WrittenAs(item), kWanted));
    }
    if (std::max(std::abs(numbers[0]), std::abs(numbers[1])) > kMaxOrigin) {
      return Fail(LineOf("origin"), fmt::format("origin is [{:g}, {:g}, {:g}], wanted coordinates "
                                                "within {:g} m",
                                                numbers[0], numbers[1], numbers[2], kMaxOrigin));
    }
    if (const std::optional<std::string> why = base::WhyNoRadians(numbers[2])) {
      return Fail(LineOf("origin"), "origin: its third number, the yaw, " + *why);
    }
    params->origin = {numbers[0], numbers[1]};
    params->yaw = std::abs(numbers[2]) < kNoYaw ? 0.0 : numbers[2];
  }

  void ReadNegate(MapParams* params) {
    const YAML::Node* negate = Find("negate");
    if (negate == nullptr) return TakeDefault("negate", "0");
    double number = 0.0;
    if (ToNumber(*negate, &number) && (number == 0.0 || number == 1.0)) {
      params->negate = number == 1.0;
    } else if (!negate->IsScalar() || !YAML::convert<bool>::decode(*negate, params->negate)) {
      FailValue("negate", "0 (black is occupied) or 1 (white is)");
    }
  }

  void ReadMode(MapParams* params) {
    const YAML::Node* mode = Find("mode");
    if (mode == nullptr) return;
    const std::string name = mode->IsScalar() ? base::ToLower(mode->Scalar()) : "";
    if (name == "trinary") return;
    if (name == "scale") {
      params->mode = MapMode::kScale;
    } else if (name == "raw") {
      params->mode = MapMode::kRaw;
    } else {
      FailValue("mode", "trinary, scale or raw");
    }
  }

  void TakeDefault(const std::string& key, const std::string& value) {
    if (mistyped_.count(key) == 0) defaults_.push_back(fmt::format("{}: {}", key, value));
  }
  void NoteDefaults() {
    if (defaults_.empty()) return;
    findings_.notes.push_back(
        fmt::format("{}: what it does not say is taken as map_server has it: {}", file_,
                    base::Join(defaults_, ", ")));
  }

  void NameForeign() {
    if (foreign_.empty()) return;
    std::vector<std::string> named;
    for (const auto& [line, key] : foreign_) {
      if (named.size() < kMostNamed) named.push_back(fmt::format("'{}' (line {})", key, line));
    }
    if (foreign_.size() > named.size())
      named.push_back(fmt::format("and {} more", foreign_.size() - named.size()));
    findings_.warnings.push_back(
        fmt::format("{}: keys that map_server does not know are passed over: {}", file_,
                    base::Join(named, ", ")));
  }

  const std::string& file_;
  MapFindings& findings_;
  std::map<std::string, Entry> entries_;
  std::multimap<int, std::string> foreign_;  // by line
  std::set<std::string> mistyped_;           // keys that others were meant to be
  std::vector<std::string> defaults_;
};

/// A picture is often given in the place of the file that says how large its pixels are.
std::string YamlBeside(const std::string& picture) {
  const std::filesystem::path yaml = std::filesystem::path(picture).replace_extension(".yaml");
  return std::filesystem::exists(yaml)
             ? fmt::format(" ({} lies beside it)", yaml.filename().string())
             : "";
}

void RefusePicture(const std::string& path) {
  if (!IsPictureName(path)) return;
  throw base::ConfigError(fmt::format(
      "{}: is a map's picture; name the YAML file of map_server that says where it lies{}, with "
      "image, resolution, origin, negate, occupied_thresh and free_thresh",
      path, YamlBeside(path)));
}

void RefuseOtherKinds(const std::string& path, const std::string& bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) {
    throw base::ConfigError(path + ": is empty, wanted the YAML of a map_server map");
  }
  if (bytes[first] != '<') return;
  const bool is_robot = bytes.find("<robot") != std::string::npos;
  throw base::ConfigError(fmt::format("{}: is {} and no map_server map (YAML); {} takes it", path,
                                      is_robot ? "a robot (URDF)" : "XML",
                                      is_robot ? "--robot" : "--world, if it is a world,"));
}

/// The entry "yaml_filename" of a map_server's parameters, which stand below its name.
/// @param num_left  nodes that are looked at, as an alias may stand for many.
std::optional<YAML::const_iterator> YamlFilenameIn(const YAML::Node& node, int* num_left) {
  if (!node.IsMap()) return std::nullopt;
  for (auto entry = node.begin(); entry != node.end(); ++entry) {
    if (--*num_left < 0) return std::nullopt;
    if (entry->first.IsScalar() && entry->first.Scalar() == "yaml_filename") return entry;
    if (const auto found = YamlFilenameIn(entry->second, num_left)) return found;
  }
  return std::nullopt;
}

void RefuseParameters(const std::string& path, const YAML::Node& document) {
  if (document["image"]) return;
  int num_left = 10'000;
  const auto found = YamlFilenameIn(document, &num_left);
  if (!found) return;
  const YAML::Node name = (*found)->second;
  const bool is_named = name.IsScalar() && !name.Scalar().empty();
  throw base::ConfigError(
      fmt::format("{}:{}: has parameters of a map_server and is no map; its yaml_filename {}", path,
                  (*found)->first.Mark().line + 1,
                  is_named ? fmt::format("names the map: give '{}'", name.Scalar())
                           : "is empty, as a launch file names the map: give that"));
}

YAML::Node ParseYaml(const std::string& path, const std::string& bytes) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(bytes);
    if (documents.size() == 1 && documents[0].IsMap()) return documents[0];
    throw base::ConfigError(fmt::format("{}: {}, wanted the keys of a map_server map: {}", path,
                                        documents.size() == 1
                                            ? "is " + WrittenAs(documents[0])
                                            : fmt::format("holds {} documents", documents.size()),
                                        base::Join(KnownKeys(), ", ")));
  } catch (const YAML::Exception& error) {
    throw base::ConfigError(
        fmt::format("{}:{}: no valid YAML: {}", path, error.mark.line + 1, error.msg));
  }
}

}  // namespace

MapParams ReadMapYaml(const std::string& yaml_path, MapFindings* findings) {
  RefusePicture(yaml_path);
  const std::string bytes = base::ReadTextFile(yaml_path, 1u << 20);
  RefuseOtherKinds(yaml_path, bytes);
  const YAML::Node document = ParseYaml(yaml_path, bytes);
  RefuseParameters(yaml_path, document);
  return MapYamlReader(yaml_path, document, findings).Read();
}

void ThrowErrors(const std::string& file, const MapFindings& findings) {
  if (!findings.errors.empty())
    throw base::ConfigError(base::AllThatIsWrong(file, findings.errors));
}

}  // namespace hires::world
