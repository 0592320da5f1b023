#include "robot/mesh_path.h"

#include <fmt/format.h>

#include <system_error>

#include "base/files/model_folders.h"
#include "base/files/nearest_file.h"
#include "hires/base/error.h"

namespace hires::robot {
namespace {

namespace fs = std::filesystem;

constexpr char kPackage[] = "package://";
constexpr char kModel[] = "model://";
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

/// As worlds find models; else as a package of that name, which is what exporters make of one.
std::string FindOfModel(const std::string& uri, const fs::path& folder,
                        const base::PackageFinder& packages) {
  const fs::path name = fs::path(uri.substr(sizeof(kModel) - 1)).lexically_normal();
  if (name.empty() || name.is_absolute() || *name.begin() == "..") {
    throw base::ConfigError(
        fmt::format("mesh '{}' names no file inside a model; wanted model://<model>/<path>", uri));
  }
  for (const std::string& models : base::ModelFoldersFor((folder / "robot.urdf").string(), {})) {
    const std::string file = (fs::path(models) / name).string();
    if (base::Exists(file) && !base::IsFolder(file)) return file;
  }
  try {
    return packages.Find(kPackage + name.generic_string(), {folder.string()});
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format(
        "mesh '{}' is not there: no such file in models/ or the folder beside the URDF, "
        "nor in the folders of {}; and as a package's {}",
        uri, base::ModelVariables(), error.what()));
  }
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
  if (StartsWith(uri, kModel)) return FindOfModel(uri, folder, packages);
  if (StartsWith(uri, kFile))
    return RequireFile(uri, fs::path(uri.substr(sizeof(kFile) - 1)), "correct the path");
  if (uri.empty() || uri.find("://") != std::string::npos) {
    throw base::ConfigError(fmt::format(
        "mesh '{}' cannot be found; wanted package://..., model://..., file://... or a path from "
        "the URDF's folder",
        uri));
  }
  return RequireFile(uri, folder / uri, "paths are relative to the URDF's folder");
}

}  // namespace hires::robot
