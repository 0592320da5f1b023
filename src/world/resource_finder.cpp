#include "world/resource_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sdf/parser.hh>

#include "base/files/nearest_file.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/files/missing_files.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool Exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool IsFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// ".." in a URI would lead out of the folder that the name was found in.
bool Climbs(const std::string& path) {
  const std::vector<std::string> parts = base::Split(path, '/');
  return std::find(parts.begin(), parts.end(), "..") != parts.end();
}

void AppendFolders(const std::vector<std::string>& candidates, std::vector<std::string>* folders) {
  for (const std::string& candidate : candidates) {
    if (candidate.empty() || !IsFolder(candidate)) continue;
    const std::string folder = fs::absolute(candidate).lexically_normal().string();
    if (std::find(folders->begin(), folders->end(), folder) == folders->end()) {
      folders->push_back(folder);
    }
  }
}

std::vector<std::string> FoldersInEnvironment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::vector<std::string>{} : base::Split(value, ':');
}

/// Our own stand-ins for what nearly every Gazebo world includes (sun, ground_plane), where the
/// user has none. ROS_PACKAGE_PATH names the package itself or the folder that holds it.
void AppendOwn(std::vector<std::string>* folders) {
  for (const std::string& place : FoldersInEnvironment("ROS_PACKAGE_PATH")) {
    for (const char* below : {"worlds/gazebo", "hires/worlds/gazebo"}) {
      folders->push_back((fs::path(place) / below).string());
    }
  }
}

bool IsBelow(const fs::path& path, const fs::path& folder) {
  const fs::path relative =
      fs::weakly_canonical(path).lexically_relative(fs::weakly_canonical(folder));
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

ResourceFinder::ResourceFinder(const std::vector<std::string>& folders) {
  AppendFolders(folders, &model_folders_);
  package_folders_ = model_folders_;
  AppendFolders(FoldersInEnvironment("ROS_PACKAGE_PATH"), &package_folders_);
}

std::string ResourceFinder::FindIn(const std::vector<std::string>& folders, const std::string& uri,
                                   const std::string& where) const {
  const std::string name = uri.substr(uri.find("://") + 3);
  if (Climbs(name)) {
    throw base::ConfigError(
        fmt::format("{}: '{}' leaves its folder by '..'; name the file directly", where, uri));
  }
  for (const std::string& folder : folders) {
    // ROS_PACKAGE_PATH may name a package itself or the folder that holds it.
    const fs::path inside = fs::path(folder) / name;
    const fs::path beside = fs::path(folder).parent_path() / name;
    if (Exists(inside)) return inside.string();
    if (StartsWith(uri, "package://") && IsBelow(beside, folder) && Exists(beside)) {
      return beside.string();
    }
  }
  throw base::ConfigError(WhyNoModel(uri, folders, where));
}

/// As rospack finds packages; else a folder of that name, without a package.xml, on the same path.
std::string ResourceFinder::FindInPackages(const std::string& uri, const std::string& near,
                                           const std::string& where) const {
  std::vector<std::string> folders = model_folders_;
  if (!near.empty()) folders.insert(folders.begin(), near);
  try {
    return packages_.Find(uri, folders);
  } catch (const base::ConfigError& error) {
    try {
      return FindIn(package_folders_, uri, where);
    } catch (const base::ConfigError&) {
      throw base::ConfigError(fmt::format("{}: {}", where, error.what()));
    }
  }
}

std::string ResourceFinder::FindByScheme(const std::string& uri, const std::string& near,
                                         const std::string& where) const {
  if (StartsWith(uri, "model://")) return FindIn(model_folders_, uri, where);
  if (StartsWith(uri, "package://")) return FindInPackages(uri, near, where);
  if (StartsWith(uri, "file:///")) {
    if (Exists(uri.substr(7))) return uri.substr(7);
    throw base::ConfigError(fmt::format("{}: '{}' is not there{}; correct the path", where, uri,
                                        base::DidYouMeanFile(uri.substr(7))));
  }
  throw base::ConfigError(
      fmt::format("{}: '{}' cannot be reached; write model://name, package://name/... or "
                  "file:///path",
                  where, uri));
}

std::string ResourceFinder::FindModel(const std::string& uri, const std::string& where) const {
  const std::string path = FindByScheme(uri, "", where);
  if (!IsFolder(path)) return path;
  if (!Exists(fs::path(path) / "model.config")) {
    throw base::ConfigError(fmt::format(
        "{}: '{}' is the folder {}, which has no model.config; add one that names its SDF file",
        where, uri, path));
  }
  base::ReadTextFile(path + "/model.config", 1u << 20);  // bounds what sdformat will read
  const std::string file = sdf::getModelFilePath(path);
  if (!Exists(file) || IsFolder(file)) {
    throw base::ConfigError(
        fmt::format("{}: '{}': {}/model.config names no SDF file that is there; correct its <sdf>",
                    where, uri, path));
  }
  return file;
}

std::string ResourceFinder::FindMesh(const std::string& uri, const std::string& from_file,
                                     const std::string& where) const {
  const fs::path folder = fs::absolute(from_file).parent_path();
  if (uri.find("://") != std::string::npos) return FindByScheme(uri, folder.string(), where);
  const fs::path path = (folder / uri).lexically_normal();
  const auto holds = [&](const fs::path& root) { return IsBelow(path, root); };
  if (!holds(folder) && std::none_of(model_folders_.begin(), model_folders_.end(), holds)) {
    throw base::ConfigError(fmt::format(
        "{}: mesh '{}' lies outside the folder of its file and the model path; name it by file://, "
        "or add its folder to the model path",
        where, uri));
  }
  if (Exists(path)) return path.string();
  throw base::ConfigError(fmt::format("{}: mesh '{}' is not there; looked for {}{}", where, uri,
                                      path.string(), base::DidYouMeanFile(path.string())));
}

std::vector<std::string> ModelFoldersFor(const std::string& file,
                                         const std::vector<std::string>& model_path) {
  const fs::path folder = fs::absolute(file).parent_path();
  std::vector<std::string> folders{(folder / "models").string(), folder.string()};
  folders.insert(folders.end(), model_path.begin(), model_path.end());
  for (const char* variable : {"GAZEBO_MODEL_PATH", "SDF_PATH"}) {
    const std::vector<std::string> more = FoldersInEnvironment(variable);
    folders.insert(folders.end(), more.begin(), more.end());
  }
  AppendOwn(&folders);
  return folders;
}

}  // namespace hires::world
