#include "world/resource_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "base/files/model_folders.h"
#include "base/files/nearest_file.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/sdf/model_folders.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostGuesses = 200;  // names that are not there; messages list fewer

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// ".." in a URI would lead out of the folder that the name was found in.
bool Climbs(const std::string& path) {
  const std::vector<std::string> parts = base::Split(path, '/');
  return std::find(parts.begin(), parts.end(), "..") != parts.end();
}

void AppendFolders(const std::vector<std::string>& candidates, std::vector<std::string>* folders) {
  for (const std::string& candidate : candidates) {
    if (candidate.empty() || !base::IsFolder(candidate)) continue;
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

/// For a command line.
std::string WithoutBlanks(const std::string& uri) {
  std::string text;
  for (const char c : uri) text += c == ' ' ? std::string("%20") : std::string(1, c);
  return text;
}

/// "%20" and the like as the letters that they stand for.
std::string Decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto is_digit = [&](std::size_t at) {
      return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at])) != 0;
    };
    const bool is_escape = uri[i] == '%' && is_digit(i + 1) && is_digit(i + 2);
    text += is_escape ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
    if (is_escape) i += 2;
  }
  return text;
}

/// What is found by a URI as it stands, else by what its escapes stand for.
std::string FindEither(const std::string& uri,
                       const std::function<std::string(const std::string&)>& find) {
  const std::string decoded = Decoded(uri);
  if (decoded == uri) return find(uri);
  try {
    return find(uri);
  } catch (const base::ConfigError&) {
    try {
      return find(decoded);
    } catch (const base::ConfigError&) {
    }
    throw;
  }
}

bool IsRelative(const std::string& uri) {
  return uri.find("://") == std::string::npos ||
         (StartsWith(uri, "file://") && !StartsWith(uri, "file:///"));
}

/// "" of no file.
std::string FolderOf(const std::string& file) {
  return file.empty() ? "" : fs::absolute(file).parent_path().string();
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

std::string ResourceFinder::Guess(const std::string& name,
                                  const std::function<std::string()>& look) const {
  const auto known = guesses_.find(name);
  if (known != guesses_.end()) return known->second;
  if (guesses_.size() >= kMostGuesses) return "";
  return guesses_[name] = look();
}

std::string ResourceFinder::NearestFile(const std::string& path) const {
  return Guess(path, [&] { return base::DidYouMeanFile(path); });
}

std::string ResourceFinder::NotThere(const std::string& uri, const std::string& name,
                                     const std::string& where,
                                     const std::vector<std::string>& folders) const {
  const std::string folder_of_name = name.substr(0, name.find('/'));
  for (const std::string& folder : folders) {
    const std::string path = (fs::path(folder) / name).string();
    if (name.size() > folder_of_name.size() && base::IsFolder(fs::path(folder) / folder_of_name)) {
      return fmt::format("{}: '{}' is not there; looked for {}{}", where, uri, path,
                         NearestFile(path));
    }
  }
  return fmt::format(
      "{}: '{}' is not there; looked in {}; add its folder to the model path or to "
      "one of {}{}",
      where, uri, folders.empty() ? "no folder" : base::Join(folders, ", "), base::ModelVariables(),
      Guess(folder_of_name, [&] { return NearestName(folders, folder_of_name); }));
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
    if (base::Exists(inside)) return inside.string();
    if (StartsWith(uri, "package://") && IsBelow(beside, folder) && base::Exists(beside)) {
      return beside.string();
    }
  }
  throw base::ConfigError(NotThere(uri, name, where, folders));
}

/// Gazebo would ask a server; what a world holds must not depend on one.
std::string ResourceFinder::FindOfFuel(const std::string& uri, const std::string& where) const {
  const FuelName name = FuelNameOf(uri);
  if (Climbs(name.inside)) {
    throw base::ConfigError(
        fmt::format("{}: '{}' leaves its folder by '..'; name the file directly", where, uri));
  }
  const std::string folder = FindAlike(model_folders_, name.model);
  if (folder.empty()) {
    throw base::ConfigError(fmt::format(
        "{}; nothing is fetched: put the model into a folder '{}' there, or fetch it once by "
        "`gz fuel download -u {}`",
        NotThere(uri, name.model, where, model_folders_), name.model, WithoutBlanks(uri)));
  }
  if (name.inside.empty() || base::Exists(fs::path(folder) / name.inside))
    return name.inside.empty() ? folder : (fs::path(folder) / name.inside).string();
  throw base::ConfigError(fmt::format("{}: '{}': {} has no file {}{}", where, uri, folder,
                                      name.inside,
                                      NearestFile((fs::path(folder) / name.inside).string())));
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
  if (StartsWith(uri, "https://") || StartsWith(uri, "http://")) return FindOfFuel(uri, where);
  if (StartsWith(uri, "file:///")) {
    if (base::Exists(uri.substr(7))) return uri.substr(7);
    throw base::ConfigError(fmt::format("{}: '{}' is not there; check the path{}", where, uri,
                                        NearestFile(uri.substr(7))));
  }
  throw base::ConfigError(
      fmt::format("{}: '{}' cannot be reached; write model://name, package://name/... or "
                  "file:///path",
                  where, uri));
}

/// A path without a scheme, or file://media/... of old worlds: beside the file, else below a folder
/// of the model path, whose own name the path may begin with (file://models/crate/...).
std::string ResourceFinder::FindBeside(const std::string& uri, const std::string& from_file,
                                       const std::string& where) const {
  const std::string name = StartsWith(uri, "file://") ? uri.substr(7) : uri;
  const fs::path folder = fs::absolute(from_file).lexically_normal().parent_path();
  const fs::path path = (folder / name).lexically_normal();
  const auto holds = [&](const fs::path& root) { return IsBelow(path, root); };
  if (!holds(folder) && std::none_of(model_folders_.begin(), model_folders_.end(), holds)) {
    throw base::ConfigError(fmt::format(
        "{}: '{}' lies outside the folder of its file and the model path; name it by file://, or "
        "add its folder to the model path",
        where, uri));
  }
  if (base::Exists(path)) return path.string();
  fs::path nearest = path;  // to what may be meant
  for (const std::string& root : model_folders_) {
    if (Climbs(name)) break;
    const fs::path inside = fs::path(root) / name, beside = fs::path(root).parent_path() / name;
    if (base::Exists(inside)) return inside.string();
    if (!IsBelow(beside, root)) continue;
    if (base::Exists(beside)) return beside.string();
    if (base::IsFolder(beside.parent_path())) nearest = beside;
  }
  throw base::ConfigError(fmt::format("{}: '{}' is not there; looked for {}{}", where, uri,
                                      nearest.string(), NearestFile(nearest.string())));
}

std::string ResourceFinder::Find(const std::string& uri, const std::string& where,
                                 const std::string& from_file, bool has_file) const {
  return FindEither(uri, [&](const std::string& either) {
    return IsRelative(either) && has_file ? FindBeside(either, from_file, where)
                                          : FindByScheme(either, FolderOf(from_file), where);
  });
}

std::string ResourceFinder::FindModel(const std::string& uri, const std::string& where,
                                      const std::string& from_file) const {
  const std::string path = Find(uri, where, from_file, !from_file.empty());
  return base::IsFolder(path) ? ModelFileIn(path, uri, where) : path;
}

std::string ResourceFinder::FindMesh(const std::string& uri, const std::string& from_file,
                                     const std::string& where) const {
  return Find(uri, where, from_file, true);
}

}  // namespace hires::world
