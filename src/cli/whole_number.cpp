#include "hires/cli/whole_number.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace hires::cli
