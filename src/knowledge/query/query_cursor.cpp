#include "knowledge/query/query_cursor.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <tuple>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

std::uint64_t BitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

double FromBits(std::uint64_t bits) {
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

template <typename Number>
bool ReadNumber(const std::string& text, int base, Number* number) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, *number, base);
  return result.ec == std::errc() && result.ptr == end;
}

}  // namespace

bool operator<(const QueryPosition& a, const QueryPosition& b) {
  const int names = sqlite3_stricmp(a.name.c_str(), b.name.c_str());
  if (names != 0) return names < 0;
  return std::tie(a.world, a.start, a.id) < std::tie(b.world, b.start, b.id);
}

std::string ToString(const QueryCursor& cursor) {
  return fmt::format("{}:{}:{:x}:{}:{}", cursor.as_of, cursor.last.world, BitsOf(cursor.last.start),
                     cursor.last.id, cursor.last.name);
}

QueryCursor ReadCursor(const std::string& text) {
  const std::vector<std::string> parts = base::Split(text, ':');
  QueryCursor cursor;
  std::uint64_t bits = 0;
  const bool ok = parts.size() >= 5 && ReadNumber(parts[0], 10, &cursor.as_of) &&
                  ReadNumber(parts[1], 10, &cursor.last.world) && ReadNumber(parts[2], 16, &bits) &&
                  ReadNumber(parts[3], 10, &cursor.last.id) && cursor.as_of >= 0;
  cursor.last.start = FromBits(bits);
  if (!ok || std::isnan(cursor.last.start)) {
    throw base::ConfigError(fmt::format(
        "cursor '{}' is malformed; wanted: empty at first, then `next` of the page before",
        text.substr(0, 60)));
  }
  cursor.last.name = base::Join({parts.begin() + 4, parts.end()}, ":");  // it may have some itself
  return cursor;
}

PageStart StartOfPage(const std::string& cursor, std::int64_t last) {
  if (cursor.empty()) return {last, std::nullopt};
  const QueryCursor read = ReadCursor(cursor);
  return {std::min(read.as_of, last), read.last};
}

}  // namespace hires::knowledge
