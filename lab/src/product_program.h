#pragma once

#include <string>

namespace hires::lab {

/// The program `hires`, which lies beside this one.
std::string ProductProgram();

}  // namespace hires::lab
