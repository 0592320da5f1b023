#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hires/temporal/interval.h"

namespace hires::knowledge {

/// Where in the order of answers a fluent stands.
struct QueryPosition {
  std::string name;
  std::int64_t world{0};
  double start{-temporal::kForever};
  std::int64_t id{0};
};
/// By name (case ignored), world, start, and order of writing.
bool operator<(const QueryPosition& a, const QueryPosition& b);

/// A place to go on from: the last fluent told, and the last change that the first page knew of.
struct QueryCursor {
  std::int64_t as_of{0};
  QueryPosition last;
};
std::string ToString(const QueryCursor& cursor);
QueryCursor ReadCursor(const std::string& text);  ///< @throws ConfigError

/// Where a page begins.
struct PageStart {
  std::int64_t as_of{0};               ///< last change that counts
  std::optional<QueryPosition> after;  ///< last fluent of the page before; nothing at first
};
/// @param cursor  of the page before, or "".
/// @param last  Sequence number of the store's last change.
/// @throws ConfigError
PageStart StartOfPage(const std::string& cursor, std::int64_t last);

}  // namespace hires::knowledge
