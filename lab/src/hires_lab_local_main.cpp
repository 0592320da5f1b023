// `hires_lab` of the build without ROS: plays in its own process.
#include "lab/src/verbs/command_line.h"
#include "cli/package_folder.h"

int main(int argc, char** argv) {
  hires::lab::LabBackends backends;
  backends.package_folder = hires::cli::LocalPackageFolder(HIRES_SOURCE_DIR);
  return hires::lab::RunLabCommandLine({argv, argv + argc}, backends);
}
