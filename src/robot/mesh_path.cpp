#include "robot/mesh_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::robot {
namespace {

namespace fs = std::filesystem;

constexpr char kPackage[] = "package://";
constexpr char kFile[] = "file://";
constexpr int kMaxDepth = 5;         // of packages below a folder of ROS_PACKAGE_PATH
constexpr int kMaxFolders = 100000;  // looked at in one search

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool IsPackage(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "package.xml", error) || fs::exists(folder / "manifest.xml", error);
}

std::vector<fs::path> RosPackagePath() {
  const char* value = std::getenv("ROS_PACKAGE_PATH");
  std::vector<fs::path> folders;
  for (const std::string& part : base::Split(value == nullptr ? "" : value, ':')) {
    if (!part.empty()) folders.emplace_back(part);
  }
  return folders;
}

/// Packages of that name at or below `top`, sorted, without looking into packages.
std::vector<fs::path> PackagesBelow(const fs::path& top, const std::string& package) {
  if (IsPackage(top)) return top.filename() == package ? std::vector{top} : std::vector<fs::path>{};
  std::vector<fs::path> found;
  std::error_code error;
  int num_folders = 0;
  for (fs::recursive_directory_iterator
           entry(top, fs::directory_options::skip_permission_denied, error),
       end;
       !error && entry != end && num_folders < kMaxFolders; entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored)) continue;
    ++num_folders;
    const bool is_package = IsPackage(entry->path());
    if (is_package && entry->path().filename() == package) found.push_back(entry->path());
    if (is_package || entry.depth() >= kMaxDepth) entry.disable_recursion_pending();
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Folders that may be the package, best first.
std::vector<fs::path> PackageFolders(const std::string& package, const fs::path& urdf_folder) {
  std::vector<fs::path> folders;
  for (const fs::path& top : RosPackagePath()) {
    for (const fs::path& folder : PackagesBelow(top, package)) folders.push_back(folder);
  }
  const fs::path start = fs::absolute(urdf_folder.empty() ? "." : urdf_folder).lexically_normal();
  for (fs::path above = start; above != above.parent_path(); above = above.parent_path()) {
    if (above.filename() == package) folders.push_back(above);
  }
  return folders;
}

std::string FirstThatExists(const std::string& uri, const std::vector<fs::path>& candidates,
                            const std::string& remedy) {
  std::vector<std::string> looked;
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    if (fs::is_regular_file(candidate, error)) return candidate.string();
    looked.push_back(candidate.string());
  }
  throw base::ConfigError(fmt::format(
      "mesh '{}' is not there; looked for {}; {}", uri,
      looked.empty() ? "no package of that name found" : "'" + base::Join(looked, "', '") + "'",
      remedy));
}

std::string ResolvePackageMesh(const std::string& uri, const fs::path& folder) {
  const std::string rest = uri.substr(sizeof(kPackage) - 1);
  const std::size_t slash = rest.find('/');
  const fs::path inside =
      slash == std::string::npos ? fs::path() : fs::path(rest.substr(slash + 1)).lexically_normal();
  if (slash == 0 || inside.empty() || inside.is_absolute() || *inside.begin() == "..") {
    throw base::ConfigError(fmt::format(
        "mesh '{}' names no file inside a package; wanted package://<package>/<path>", uri));
  }
  const std::string package = rest.substr(0, slash);
  std::vector<fs::path> candidates;
  for (const fs::path& place : PackageFolders(package, folder))
    candidates.push_back(place / inside);
  const char* path = std::getenv("ROS_PACKAGE_PATH");
  return FirstThatExists(
      uri, candidates,
      fmt::format("add the folder of package '{}' to ROS_PACKAGE_PATH (now '{}')", package,
                  path == nullptr ? "" : path));
}

}  // namespace

std::string ResolveMesh(const std::string& uri, const std::filesystem::path& folder) {
  if (StartsWith(uri, kPackage)) return ResolvePackageMesh(uri, folder);
  if (StartsWith(uri, kFile)) {
    return FirstThatExists(uri, {fs::path(uri.substr(sizeof(kFile) - 1))}, "check the path");
  }
  if (uri.empty() || uri.find("://") != std::string::npos) {
    throw base::ConfigError(fmt::format(
        "mesh '{}' cannot be found; wanted package://..., file://... or a path from the URDF's "
        "folder",
        uri));
  }
  return FirstThatExists(uri, {folder / uri}, "paths are relative to the URDF's folder");
}

}  // namespace hires::robot
