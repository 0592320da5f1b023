#include "base/files/model_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "hires/base/text.h"

namespace hires::base {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariables[] = {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH",
                                      "SDF_PATH", "GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH"};
constexpr std::size_t kMostEntries = 20000;  // of a folder that is looked through for a name

std::vector<std::string> InEnvironment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::vector<std::string>{} : Split(value, ':');
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

}  // namespace

bool Exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool IsFolder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::vector<fs::path> EntriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end;
       !error && at != end && entries.size() < kMostEntries; at.increment(error)) {
    entries.push_back(at->path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
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

}  // namespace hires::base
