// `hires` of the build without ROS: imagines in its own process.
#include "cli/command_line.h"
#include "cli/package_folder.h"

int main(int argc, char** argv) {
  hires::cli::Backends backends;
  backends.package_folder = hires::cli::LocalPackageFolder(HIRES_SOURCE_DIR);
  hires::cli::NamePackageFolder(backends.package_folder);
  return hires::cli::RunCommandLine({argv, argv + argc}, backends);
}
