// What can be answered in one process, without nodes.
#include "cli/local_verbs.h"
#include "cli/package_folder.h"

int main(int argc, char** argv) {
  return hires::cli::RunLocalCommandLine({argv, argv + argc},
                                         hires::cli::LocalPackageFolder(HIRES_SOURCE_DIR));
}
