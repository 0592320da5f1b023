#pragma once

#include <CLI/CLI.hpp>

namespace hires::cli {

/// Digits alone, at most 18 of them. For seeds: CLI11's own check reads them as floating-point
/// numbers, and its conversion turns -3 into a large number.
CLI::Validator WholeNumber();

/// A number from `low` to `high`, both included. CLI11's own check says of what is no number that
/// it is out of range.
CLI::Validator NumberBetween(double low, double high);
/// Of options that count: whole numbers alone, which CLI11 would only say it "could not convert".
CLI::Validator NumberBetween(int low, int high);

}  // namespace hires::cli
