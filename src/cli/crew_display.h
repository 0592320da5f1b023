#pragma once

#include <functional>
#include <string>

#include "base/parallel.h"

namespace hires::cli {

/// @param threads  0: one for each core.
/// @param is_quiet  no bar of progress; there is none either where standard error is no terminal.
base::Crew MakeCrew(int threads, bool is_quiet, const std::function<bool()>& cancelled);

/// " 52 %, 12 s left", for terminals.
std::string ProgressText(double fraction, double elapsed);

}  // namespace hires::cli
