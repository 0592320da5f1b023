#include "world/sdf/model_folders.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "base/files/nearest_file.h"
#include "base/files/plain_xml.h"
#include "base/trimmed.h"
#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "world/xml_check.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariables[] = {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH",
                                      "SDF_PATH", "GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH"};
constexpr std::size_t kMostNamed = 20000;  // folders or files that are looked through for a name

std::vector<std::string> InEnvironment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::vector<std::string>{} : base::Split(value, ':');
}

/// What lies in a folder, in the order of names; nothing if it cannot be read.
std::vector<fs::path> EntriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end;
       !error && at != end && entries.size() < kMostNamed; at.increment(error)) {
    entries.push_back(at->path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// models/ beside the folders above, up to that of the package or repository, or three of them.
void AppendAbove(const fs::path& folder, std::vector<std::string>* folders) {
  constexpr int kMost = 3;
  fs::path at = folder;
  for (int i = 0; i < kMost && at.has_relative_path(); ++i) {
    if (Exists(at / "package.xml") || Exists(at / ".git")) return;
    at = at.parent_path();
    folders->push_back((at / "models").string());
  }
}

void AppendVariables(std::vector<std::string>* folders) {
  for (const char* variable : kVariables) {
    for (const std::string& folder : InEnvironment(variable)) {
      if (folder.empty()) continue;
      folders->push_back(folder);
      folders->push_back((fs::path(folder) / "models").string());
    }
  }
}

/// <cache>/<server>/<owner>/models holds a folder for each model, and in it one for each version.
void AppendCaches(std::vector<std::string>* folders) {
  std::vector<fs::path> caches;
  for (const char* variable : {"GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH"}) {
    for (const std::string& cache : InEnvironment(variable)) caches.emplace_back(cache);
  }
  const char* value = std::getenv("HOME");
  const fs::path home = value == nullptr ? "" : value;
  if (!home.empty()) {
    caches.push_back(home / ".gz/fuel");
    caches.push_back(home / ".ignition/fuel");
    folders->push_back((home / ".gazebo/models").string());
  }
  for (const fs::path& cache : caches) {
    for (const fs::path& server : EntriesOf(cache)) {
      for (const fs::path& owner : EntriesOf(server)) {
        if (IsFolder(owner / "models")) folders->push_back((owner / "models").string());
      }
    }
  }
}

/// Our own stand-ins for what nearly every Gazebo world includes (sun, ground_plane), where the
/// user has none. ROS_PACKAGE_PATH names the package itself or the folder that holds it.
void AppendOwn(std::vector<std::string>* folders) {
  for (const std::string& place : InEnvironment("ROS_PACKAGE_PATH")) {
    for (const char* below : {"worlds/gazebo", "hires/worlds/gazebo"}) {
      folders->push_back((fs::path(place) / below).string());
    }
  }
}

bool IsNumber(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool HoldsModel(const fs::path& folder) {
  return Exists(folder / "model.config") || Exists(folder / "model.sdf");
}

/// The folder itself, or the newest of its versions.
std::string NewestIn(const fs::path& folder) {
  if (HoldsModel(folder)) return folder.string();
  fs::path newest;
  long version = -1;
  for (const fs::path& entry : EntriesOf(folder)) {
    const std::string name = entry.filename().string();
    if (!IsNumber(name) || name.size() > 9 || !HoldsModel(entry)) continue;
    if (std::stol(name) > version) newest = entry, version = std::stol(name);
  }
  return newest.empty() ? folder.string() : newest.string();
}

/// "1.10" -> 10; -1 for what is no SDF 1.x.
int MinorOf(const char* version) {
  const std::string text = version == nullptr ? "" : version;
  return text.rfind("1.", 0) == 0 && IsNumber(text.substr(2)) && text.size() < 6
             ? std::stoi(text.substr(2))
             : -1;
}

/// Of several, libsdformat's newest (1.9) or the nearest below; else the oldest above it.
std::string FileNamedIn(const tinyxml2::XMLElement& model) {
  constexpr int kNewest = 9;
  std::string best;
  int best_minor = -2;
  for (const auto* sdf = model.FirstChildElement("sdf"); sdf != nullptr;
       sdf = sdf->NextSiblingElement("sdf")) {
    if (sdf->GetText() == nullptr) continue;
    const int minor = MinorOf(sdf->Attribute("version"));
    const bool is_better =
        best_minor > kNewest ? minor < best_minor : minor <= kNewest && minor > best_minor;
    if (!best.empty() && !is_better) continue;
    best = sdf->GetText();
    best_minor = minor;
  }
  return base::Trimmed(best);
}

}  // namespace

bool Exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool IsFolder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::vector<std::string> ModelFoldersFor(const std::string& file,
                                         const std::vector<std::string>& model_path) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  std::vector<std::string> folders{(folder / "models").string(), folder.string()};
  AppendAbove(folder, &folders);
  folders.insert(folders.end(), model_path.begin(), model_path.end());
  AppendVariables(&folders);
  AppendCaches(&folders);
  AppendOwn(&folders);
  return folders;
}

std::string ModelVariables() { return fmt::format("{}", fmt::join(kVariables, ", ")); }

std::string AlikeName(const std::string& name) {
  std::string alike;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name.compare(i, 3, "%20") == 0) {
      alike += '_';
      i += 2;
    } else {
      alike += name[i] == ' ' ? '_' : name[i];
    }
  }
  return base::ToLower(alike);
}

FuelName FuelNameOf(const std::string& uri) {
  std::vector<std::string> parts;
  const std::size_t scheme = uri.find("://");
  for (const std::string& part :
       base::Split(scheme == std::string::npos ? uri : uri.substr(scheme + 3), '/')) {
    if (!part.empty()) parts.push_back(part);
  }
  const auto models = std::find(parts.begin(), parts.end(), "models");
  if (models == parts.end() || models + 1 == parts.end())
    return {parts.empty() ? "" : parts.back(), ""};
  FuelName result{*(models + 1), ""};
  auto rest = models + 2;
  if (rest != parts.end() && (IsNumber(*rest) || *rest == "tip")) ++rest;
  if (rest != parts.end() && *rest == "files") ++rest;
  result.inside = base::Join({rest, parts.end()}, "/");
  return result;
}

std::string FindAlike(const std::vector<std::string>& folders, const std::string& name) {
  const std::string wanted = AlikeName(name);
  for (const std::string& folder : folders) {
    for (const fs::path& entry : EntriesOf(folder)) {
      if (AlikeName(entry.filename().string()) == wanted && IsFolder(entry)) return NewestIn(entry);
    }
  }
  return "";
}

std::string NearestName(const std::vector<std::string>& folders, const std::string& name) {
  std::vector<std::string> known;
  for (const std::string& folder : folders) {
    for (const fs::path& entry : EntriesOf(folder)) known.push_back(entry.filename().string());
  }
  const std::vector<std::string> likely = base::LikelyNames(name, known);
  return likely.empty() ? "" : fmt::format("; did you mean '{}'?", base::Join(likely, "' or '"));
}

std::string ModelFileIn(const std::string& folder_of_versions, const std::string& uri,
                        const std::string& where) {
  const std::string folder = NewestIn(folder_of_versions);
  const std::string config = folder + "/model.config";
  if (!Exists(config)) {
    if (Exists(folder + "/model.sdf")) return folder + "/model.sdf";
    throw base::ConfigError(fmt::format(
        "{}: '{}' is the folder {}, which has no model.config; add one that names its SDF file",
        where, uri, folder));
  }
  tinyxml2::XMLDocument document;
  ParseXml(base::PlainXml(base::ReadTextFile(config, 1u << 20), config), config, {}, &document);
  const tinyxml2::XMLElement* root = document.RootElement();
  const std::string named = root == nullptr ? "" : FileNamedIn(*root);
  const std::string file = folder + "/" + named;
  if (!named.empty() && Exists(file) && !IsFolder(file)) return file;
  throw base::ConfigError(fmt::format(
      "{}: '{}': {} names no SDF file that is there{}; correct its <sdf>{}", where, uri, config,
      named.empty() ? "" : " ('" + named + "')", named.empty() ? "" : base::DidYouMeanFile(file)));
}

}  // namespace hires::world
