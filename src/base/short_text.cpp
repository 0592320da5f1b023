#include "hires/base/short_text.h"

namespace hires::base {
namespace {

bool IsWithinCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string Shortened(const std::string& text, std::size_t at_most) {
  if (text.size() <= at_most) return text;
  std::size_t end = at_most;
  while (end > 0 && IsWithinCharacter(text[end])) --end;
  return text.substr(0, end) + " ...";
}

}  // namespace hires::base
