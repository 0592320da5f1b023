#include "hires/base/short_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/text.h"

namespace hires::base {
namespace {

bool IsWithinCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// A NUL would end a message, and others change what a terminal shows.
bool IsControl(unsigned char c) { return (c < 0x20 && c != '\n' && c != '\t') || c == 0x7F; }

std::string WithoutControls(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (IsControl(byte)) {
      shown += fmt::format("\\x{:02x}", byte);
    } else {
      shown += c;
    }
  }
  return shown;
}

}  // namespace

std::string Shortened(const std::string& text, std::size_t at_most) {
  const std::string shown = WithoutControls(text.substr(0, at_most + 1));
  if (shown.size() <= at_most) return shown;
  std::size_t end = at_most;
  while (end > 0 && IsWithinCharacter(shown[end])) --end;
  return shown.substr(0, end) + " ...";
}

std::vector<std::string> FirstLines(std::vector<std::string> lines) {
  const std::size_t count = lines.size();
  if (count <= kMostListed) return lines;
  lines.resize(kMostListed);
  lines.push_back(fmt::format("and {} more", count - kMostListed));
  return lines;
}

std::string FirstNames(const std::vector<std::string>& names, std::size_t at_most) {
  const std::size_t shown = std::min(names.size(), at_most);
  const std::string text =
      Join({names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown)}, ", ");
  return shown == names.size() ? text : fmt::format("{} and {} more", text, names.size() - shown);
}

std::string AllThatIsWrong(const std::string& where, const std::vector<std::string>& problems) {
  if (problems.size() == 1) return problems.front();
  return fmt::format("{}: {} things are wrong:\n  {}", where, problems.size(),
                     Join(FirstLines(problems), "\n  "));
}

}  // namespace hires::base
