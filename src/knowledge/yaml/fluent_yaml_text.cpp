#include "knowledge/yaml/fluent_yaml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/utf.hpp>

#include "hires/base/error.h"
#include "knowledge/fluents/store_check.h"

namespace hires::knowledge {
namespace {

using Utf8 = boost::locale::utf::utf_traits<char>;

constexpr std::size_t kMaxBytes = 64u << 20;

/// The parser queues the tokens of a whole bracket before it tells of the first. Each token needs
/// one of these characters, so this many of them bound what it holds.
constexpr std::string_view kPunctuation = "[]{},:?-&*!|>\"'%";
constexpr std::ptrdiff_t kMaxPunctuation = 1'000'000;

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

int LineOf(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  return 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
}

[[noreturn]] void FailInLine(const std::string& source, int line, const std::string& what) {
  throw base::ConfigError(fmt::format("{}: line {}: {}", source, line, what));
}

/// The first control character that may stand in no YAML text; npos if there is none.
std::size_t FindForbidden(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!IsControl(text[i]) || text[i] == '\t' || text[i] == '\n') continue;
    if (text.substr(i, 2) != "\r\n") return i;
  }
  return std::string_view::npos;
}

void CheckControls(std::string_view text, const std::string& source) {
  const std::size_t found = FindForbidden(text);
  if (found == std::string_view::npos) return;
  if (text[found] == '\r') {
    FailInLine(source, LineOf(text, found),
               "holds a carriage return without a line feed; save the file with line feeds");
  }
  FailInLine(
      source, LineOf(text, found),
      fmt::format("holds the control character 0x{0:02x}; remove it, or write \"\\x{0:02x}\" in "
                  "double quotes",
                  static_cast<unsigned char>(text[found])));
}

void CheckUtf8(std::string_view text, const std::string& source) {
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    const auto before = static_cast<std::size_t>(at - text.data());
    if (!boost::locale::utf::is_valid_codepoint(Utf8::decode(at, end))) {
      FailInLine(source, LineOf(text, before),
                 fmt::format("byte {} is no UTF-8 text; save the file as UTF-8", before + 1));
    }
  }
}

bool IsMarker(std::string_view line, std::string_view marker) {
  if (line.substr(0, marker.size()) != marker) return false;
  return line.size() == marker.size() ||
         std::string_view(" \t\r\n").find(line[marker.size()]) != std::string_view::npos;
}

/// Whether a line holds more than blanks and a comment.
bool HasContent(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && line[first] != '#';
}

void CheckPunctuation(std::string_view text, const std::string& source, int line) {
  const std::ptrdiff_t count = std::count_if(text.begin(), text.end(), [](char c) {
    return kPunctuation.find(c) != std::string_view::npos;
  });
  if (count <= kMaxPunctuation) return;
  FailInLine(source, line,
             fmt::format("a document begins that has {} of the characters {}, at most {} are read; "
                         "split it",
                         count, kPunctuation, kMaxPunctuation));
}

}  // namespace

DocumentSplitter::DocumentSplitter(std::string_view text, std::string source)
    : rest_(text), source_(std::move(source)) {
  if (text.size() > kMaxBytes) {
    throw base::ConfigError(fmt::format("{}: has {} bytes, at most {} are read; split it", source_,
                                        text.size(), kMaxBytes));
  }
  if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    rest_.remove_prefix(kByteOrderMark.size());
  }
  CheckControls(rest_, source_);
  CheckUtf8(rest_, source_);
}

std::string_view DocumentSplitter::Line() const {
  const std::size_t end = rest_.find('\n');
  return end == std::string_view::npos ? rest_ : rest_.substr(0, end + 1);
}

void DocumentSplitter::Pass(std::string_view line) {
  rest_.remove_prefix(line.size());
  ++line_;
}

std::optional<DocumentText> DocumentSplitter::Next() {
  while (!rest_.empty()) {
    const char* const begin = rest_.data();
    const int first_line = line_;
    bool begun = false;    // a marker or content was seen: the next marker begins another document
    bool content = false;  // something other than markers, comments and directives
    while (!rest_.empty()) {
      const std::string_view line = Line();
      const bool starts = IsMarker(line, "---");
      if (starts && begun) break;
      Pass(line);
      if (IsMarker(line, "...")) break;
      const bool counts = HasContent(starts ? line.substr(3) : line) && (begun || line[0] != '%');
      content = content || counts;
      begun = begun || starts || counts;
    }
    number_ += begun;
    if (!content) continue;
    const std::string_view text(begin, static_cast<std::size_t>(rest_.data() - begin));
    CheckPunctuation(text, source_, first_line);
    return DocumentText{text, first_line};
  }
  return std::nullopt;
}

std::string Shown(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::size_t size = std::min(text.size(), kShown);
  while (size < text.size() && size > 0 && (text[size] & 0xc0) == 0x80) --size;
  std::string shown(text.substr(0, size));
  std::replace_if(shown.begin(), shown.end(), IsControl, ' ');
  return size < text.size() ? shown + "..." : shown;
}

}  // namespace hires::knowledge
