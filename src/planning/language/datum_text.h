#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "hires/planning/datum.h"

namespace hires::planning {

/// Nothing to read, though it is no white space.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// As ToString, cut after `at_most` bytes; takes no longer than they need.
std::string ToString(const Datum& datum, std::size_t at_most);

/// What a plain token, one without bars and backslashes, means.
enum class TokenKind { kSymbol, kVariable, kInteger, kReal, kRatio, kDots };
TokenKind KindOfToken(std::string_view token);

/// A symbol of this name must be written |name|, or it would read as something else.
bool NeedsBars(std::string_view name);

/// Ends a token where it stands: white space, parentheses, quotes, a comma, a semicolon.
bool EndsToken(char c);

/// Bytes of the blank beyond ASCII that begins `text`, as texts from web pages and word processors
/// have them: U+00A0, U+2000 to U+200B, U+202F, U+3000; 0: there is none.
std::size_t WideBlankLength(std::string_view text);

/// Bytes of the longest beginning of `text` that is UTF-8.
std::size_t ValidUtf8Length(std::string_view text);

}  // namespace hires::planning
