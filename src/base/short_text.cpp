#include "hires/base/short_text.h"

namespace hires::base {
namespace {

constexpr std::size_t kLongest = 2000;  // bytes

bool IsWithinCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string Shortened(const std::string& text) {
  if (text.size() <= kLongest) return text;
  std::size_t end = kLongest;
  while (end > 0 && IsWithinCharacter(text[end])) --end;
  return text.substr(0, end) + " ...";
}

}  // namespace hires::base
