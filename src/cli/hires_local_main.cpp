// What can be answered in one process, without nodes.
#include <string>

#include "cli/local_verbs.h"
#include "cli/package_folder.h"

int main(int argc, char** argv) {
  const std::string folder = hires::cli::LocalPackageFolder(HIRES_SOURCE_DIR);
  hires::cli::NamePackageFolder(folder);
  return hires::cli::RunLocalCommandLine({argv, argv + argc}, folder);
}
