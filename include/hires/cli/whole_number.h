#pragma once

#include <CLI/Validators.hpp>

namespace hires::cli {

/// Digits alone, at most 18 of them. For seeds: CLI11's own check reads them as floating-point
/// numbers, and its conversion turns -3 into a large number.
CLI::Validator WholeNumber();

}  // namespace hires::cli
