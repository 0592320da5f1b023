// `hires` of the build without ROS: imagines in its own process.
#include <cstdlib>

#include "hires/evaluation/command_line.h"

int main(int argc, char** argv) {
  hires::evaluation::Backends backends;
  const char* folder = std::getenv("HIRES_PACKAGE_FOLDER");
  backends.package_folder = folder != nullptr ? folder : HIRES_SOURCE_DIR;
  return hires::evaluation::RunCommandLine({argv, argv + argc}, backends);
}
