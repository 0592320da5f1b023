#include "cli/package_folder.h"

#include <cstdlib>
#include <filesystem>

namespace hires::cli {

std::string LocalPackageFolder(const std::string& source_folder) {
  if (const char* folder = std::getenv("HIRES_PACKAGE_FOLDER")) return folder;
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto above =
      program.parent_path().parent_path();  // bin/hires_local or lib/hires/hires_local
  for (const auto& prefix : {above, above.parent_path()}) {
    const auto installed = prefix / "share" / "hires";
    if (std::filesystem::exists(installed / "config" / "scene.yaml", error)) return installed;
  }
  return source_folder;
}

void NamePackageFolder(const std::string& folder) {
  const char* known = std::getenv("ROS_PACKAGE_PATH");
  const std::string path = known == nullptr || *known == '\0' ? folder : known + (":" + folder);
  setenv("ROS_PACKAGE_PATH", path.c_str(), 1);
}

}  // namespace hires::cli
