#include "hires/cli/whole_number.h"

#include <fmt/format.h>

#include <CLI/TypeTools.hpp>
#include <algorithm>
#include <cmath>

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

CLI::Validator NumberBetween(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& text) {
        double number = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
        if (is_number && number >= low && number <= high) return std::string();
        return fmt::format("'{}' is {}; wanted a number from {:g} to {:g}", text,
                           is_number ? "out of range" : "not a number", low, high);
      },
      fmt::format("{:g} to {:g}", low, high));
}

}  // namespace hires::cli
