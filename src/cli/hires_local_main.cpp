// `hires` of the build without ROS: imagines in its own process.
#include <cstdlib>
#include <filesystem>

#include "hires/cli/command_line.h"

namespace {

/// Where config/, worlds/ and urdf/ lie: as the environment says, beside the installed program, or
/// in the source tree.
std::string PackageFolder() {
  if (const char* folder = std::getenv("HIRES_PACKAGE_FOLDER")) return folder;
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto installed = program.parent_path().parent_path() / "share" / "hires";
  if (std::filesystem::exists(installed / "config" / "scene.yaml", error)) return installed;
  return HIRES_SOURCE_DIR;
}

}  // namespace

int main(int argc, char** argv) {
  hires::cli::Backends backends;
  backends.package_folder = PackageFolder();
  return hires::cli::RunCommandLine({argv, argv + argc}, backends);
}
