#include "cli/whole_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace hires::cli {

CLI::Validator WholeNumber() {
  return CLI::Validator(
      [](const std::string& text) {
        constexpr std::size_t kMostDigits = 18;
        const bool is_good =
            !text.empty() && text.size() <= kMostDigits &&
            std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
        if (is_good) return std::string();
        return fmt::format("'{}' is no whole number from 0 to {}", text,
                           std::string(kMostDigits, '9'));
      },
      "WHOLE NUMBER");
}

namespace {

// Bounds as people write them: 1000000, not 1e+06.
std::string Plain(double bound) {
  return bound == std::floor(bound) ? fmt::format("{:.0f}", bound) : fmt::format("{:g}", bound);
}

CLI::Validator Between(double low, double high, bool is_whole) {
  return CLI::Validator(
      [=](const std::string& text) {
        double number = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
        std::int64_t whole = 0;
        const bool is_right_kind =
            is_number && (!is_whole || CLI::detail::lexical_cast(text, whole));
        if (is_right_kind && number >= low && number <= high) return std::string();
        return fmt::format("'{}' is {}; wanted a {} from {} to {}", text,
                           !is_number       ? "not a number"
                           : !is_right_kind ? "not a whole number"
                                            : "out of range",
                           is_whole ? "whole number" : "number", Plain(low), Plain(high));
      },
      fmt::format("{} to {}", Plain(low), Plain(high)));
}

}  // namespace

CLI::Validator NumberBetween(double low, double high) { return Between(low, high, false); }

CLI::Validator NumberBetween(int low, int high) { return Between(low, high, true); }

}  // namespace hires::cli
