#pragma once

#include <string>
#include <string_view>

namespace hires::base {

/// Without the blanks and line breaks that it begins and ends with.
inline std::string Trimmed(std::string_view text) {
  constexpr const char* kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1));
}

}  // namespace hires::base
