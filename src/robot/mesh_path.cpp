#include "robot/mesh_path.h"

#include <fmt/format.h>

#include <system_error>

#include "base/files/nearest_file.h"
#include "hires/base/error.h"

namespace hires::robot {
namespace {

namespace fs = std::filesystem;

constexpr char kPackage[] = "package://";
constexpr char kFile[] = "file://";

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

std::string RequireFile(const std::string& uri, const fs::path& path, const std::string& remedy) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return path.string();
  throw base::ConfigError(fmt::format("mesh '{}' is not there; looked for '{}'{}; {}", uri,
                                      path.string(), base::DidYouMeanFile(path.string()), remedy));
}

}  // namespace

std::string ResolveMesh(const std::string& uri, const fs::path& folder,
                        const base::PackageFinder& packages) {
  if (StartsWith(uri, kPackage)) {
    try {
      return packages.Find(uri, {folder.string()});
    } catch (const base::ConfigError& error) {
      throw base::ConfigError(fmt::format("mesh {}", error.what()));
    }
  }
  if (StartsWith(uri, kFile))
    return RequireFile(uri, fs::path(uri.substr(sizeof(kFile) - 1)), "correct the path");
  if (uri.empty() || uri.find("://") != std::string::npos) {
    throw base::ConfigError(fmt::format(
        "mesh '{}' cannot be found; wanted package://..., file://... or a path from the URDF's "
        "folder",
        uri));
  }
  return RequireFile(uri, folder / uri, "paths are relative to the URDF's folder");
}

}  // namespace hires::robot
