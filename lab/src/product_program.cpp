#include "lab/src/product_program.h"

#include <filesystem>

namespace hires::lab {

std::string ProductProgram() {
  const auto own = std::filesystem::read_symlink("/proc/self/exe");
  return (own.parent_path() / "hires").string();
}

}  // namespace hires::lab
