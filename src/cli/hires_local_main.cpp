// `hires` of the build without ROS: imagines in its own process.
#include <cstdlib>

#include "hires/cli/command_line.h"

int main(int argc, char** argv) {
  hires::cli::Backends backends;
  const char* folder = std::getenv("HIRES_PACKAGE_FOLDER");
  backends.package_folder = folder != nullptr ? folder : HIRES_SOURCE_DIR;
  return hires::cli::RunCommandLine({argv, argv + argc}, backends);
}
