#include "planning/language/datum_text.h"

#include <algorithm>
#include <cctype>

namespace hires::planning {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Takes the beginning of a token apart, piece by piece.
class Scanner {
 public:
  explicit Scanner(std::string_view rest) : rest_(rest) {}

  bool AtEnd() const { return rest_.empty(); }

  bool Take(std::string_view one_of) {
    if (AtEnd() || one_of.find(rest_[0]) == std::string_view::npos) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool TakeDigits() {
    const std::string_view before = rest_;
    while (!AtEnd() && IsDigit(rest_[0])) rest_.remove_prefix(1);
    return rest_.size() != before.size();
  }

  /// "e10" up to the end of the token; Lisp has four more letters for its kinds of reals.
  bool TakeExponentToEnd() {
    if (!Take("esfdlESFDL")) return false;
    Take("+-");
    return TakeDigits() && AtEnd();
  }

 private:
  std::string_view rest_;
};

TokenKind KindAfterDigits(Scanner scanner) {
  if (scanner.AtEnd()) return TokenKind::kInteger;
  if (scanner.Take("/")) {
    return scanner.TakeDigits() && scanner.AtEnd() ? TokenKind::kRatio : TokenKind::kSymbol;
  }
  if (scanner.Take(".")) {
    if (scanner.AtEnd()) return TokenKind::kInteger;  // "5." is five in Lisp
    if (scanner.TakeDigits() && scanner.AtEnd()) return TokenKind::kReal;
  }
  return scanner.TakeExponentToEnd() ? TokenKind::kReal : TokenKind::kSymbol;
}

TokenKind KindOfNumber(Scanner scanner) {
  scanner.Take("+-");
  if (scanner.TakeDigits()) return KindAfterDigits(scanner);
  if (!scanner.Take(".") || !scanner.TakeDigits()) return TokenKind::kSymbol;
  return scanner.AtEnd() || scanner.TakeExponentToEnd() ? TokenKind::kReal : TokenKind::kSymbol;
}

bool IsContinuation(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

std::size_t LengthByFirstByte(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return 2;
  if (first >= 0xE0 && first <= 0xEF) return 3;
  if (first >= 0xF0 && first <= 0xF4) return 4;
  return 0;
}

/// The second byte tells overlong forms, surrogates and what lies beyond U+10FFFF apart.
bool IsSecondByteInRange(unsigned char first, unsigned char second) {
  switch (first) {
    case 0xE0:
      return second >= 0xA0;
    case 0xED:
      return second <= 0x9F;
    case 0xF0:
      return second >= 0x90;
    case 0xF4:
      return second <= 0x8F;
    default:
      return true;
  }
}

/// Bytes of the character that begins `text`; 0 if those bytes are no character. @pre text is not
/// empty.
std::size_t CharacterLength(std::string_view text) {
  const std::size_t length = LengthByFirstByte(static_cast<unsigned char>(text[0]));
  if (length == 0 || length > text.size()) return 0;
  if (!std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length),
                   IsContinuation)) {
    return 0;
  }
  const bool in_range = length == 1 || IsSecondByteInRange(static_cast<unsigned char>(text[0]),
                                                           static_cast<unsigned char>(text[1]));
  return in_range ? length : 0;
}

bool NeedsEscape(char c) {
  return EndsToken(c) || c == '|' || c == '\\' || static_cast<unsigned char>(c) < ' ' ||
         c == '\x7f';
}

bool HasWideBlank(std::string_view name) {
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (WideBlankLength(name.substr(i)) > 0) return true;
  }
  return false;
}

}  // namespace

TokenKind KindOfToken(std::string_view token) {
  if (token.find_first_not_of('.') == std::string_view::npos) return TokenKind::kDots;
  if (token[0] == '?') return TokenKind::kVariable;
  return KindOfNumber(Scanner(token));
}

bool NeedsBars(std::string_view name) {
  return name.empty() || KindOfToken(name) != TokenKind::kSymbol || name[0] == '#' ||
         name.substr(0, 3) == kByteOrderMark || HasWideBlank(name) ||
         std::any_of(name.begin(), name.end(), NeedsEscape);
}

std::size_t WideBlankLength(std::string_view text) {
  if (text.substr(0, 2) == "\xC2\xA0") return 2;
  if (text.substr(0, 3) == "\xE3\x80\x80") return 3;
  if (text.size() < 3 || text.substr(0, 2) != "\xE2\x80") return 0;
  const auto last = static_cast<unsigned char>(text[2]);
  return (last >= 0x80 && last <= 0x8B) || last == 0xAF ? 3 : 0;
}

bool EndsToken(char c) {
  return std::string_view(" \t\n\r\f\v()\"';`,").find(c) != std::string_view::npos;
}

std::size_t ValidUtf8Length(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size()) {
    const std::size_t step = CharacterLength(text.substr(length));
    if (step == 0) break;
    length += step;
  }
  return length;
}

}  // namespace hires::planning
