#include "knowledge/yaml/fluent_yaml_scalar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/locale/utf.hpp>
#include <charconv>
#include <cmath>
#include <string>

#include "hires/base/check.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

using Utf8 = boost::locale::utf::utf_traits<char>;

constexpr std::string_view kDigits = "0123456789";

constexpr std::array<std::string_view, 8> kTruthWords = {"y",  "n",    "yes",   "no",
                                                         "on", "true", "false", "off"};

// YAML 1.1 takes a word in lower case, in capitals, or with one capital in front: not "oN".
bool IsCasedAsWord(std::string_view text) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  return std::all_of(text.begin(), text.end(), is_upper) ||
         std::all_of(text.begin() + 1, text.end(), is_lower);
}

bool IsTruthWord(std::string_view text) {
  if (text.empty() || text.size() > 5 || !IsCasedAsWord(text)) return false;
  return std::count(kTruthWords.begin(), kTruthWords.end(), base::ToLower(text)) > 0;
}

bool IsNullWord(std::string_view text) {
  if (text.empty() || text == "~") return true;
  return text.size() == 4 && IsCasedAsWord(text) && base::ToLower(text) == "null";
}

bool ConsistsOf(std::string_view text, std::string_view characters) {
  return text.find_first_not_of(characters) == std::string_view::npos;
}

std::string_view WithoutSign(std::string_view text) {
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) text.remove_prefix(1);
  return text;
}

/// The exponent "e+5" at the end of a number, "" if there is none.
std::string_view ExponentOf(std::string_view number) {
  const std::size_t at = number.find_first_of("eE");
  if (at == std::string_view::npos) return "";
  const std::string_view digits = WithoutSign(number.substr(at + 1));
  return digits.empty() || !ConsistsOf(digits, kDigits) ? "" : number.substr(at);
}

bool IsNumberWord(std::string_view unsigned_text) {
  const std::string lower =
      unsigned_text.size() == 4 ? base::ToLower(unsigned_text) : std::string();
  return lower == ".inf" || lower == ".nan";
}

/// In doubt yes: 12, 1_000, 0x1F, 0b1, 1:30, .5, 1e5, 2015-03-01 and the like.
bool LooksLikeNumber(std::string_view text) {
  text = WithoutSign(text);
  if (IsNumberWord(text)) return true;
  const std::string_view prefix = text.substr(0, 2);
  if (prefix == "0x") return ConsistsOf(text.substr(2), "0123456789abcdefABCDEF_");
  if (prefix == "0b" || prefix == "0o") return ConsistsOf(text.substr(2), "01234567_");
  text.remove_suffix(ExponentOf(text).size());
  return text.find_first_of(kDigits) != std::string_view::npos &&
         ConsistsOf(text, "0123456789._:-");
}

bool HasLeadingZero(std::string_view whole) { return whole.size() > 1 && whole[0] == '0'; }

/// Sign, digits, point, digits, exponent.
bool IsDecimal(std::string_view text) {
  text = WithoutSign(text);
  text.remove_suffix(ExponentOf(text).size());
  const std::size_t point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  const std::string_view fraction = point == std::string_view::npos ? "" : text.substr(point + 1);
  return whole.size() + fraction.size() > 0 && !HasLeadingZero(whole) &&
         ConsistsOf(whole, kDigits) && ConsistsOf(fraction, kDigits);
}

template <typename Number>
NumberOutcome Convert(std::string_view text, Number* value) {
  if (text[0] == '+') text.remove_prefix(1);  // from_chars knows no plus
  const auto result = std::from_chars(text.data(), text.data() + text.size(), *value);
  return result.ec == std::errc() ? NumberOutcome::kRead : NumberOutcome::kTooLarge;
}

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool IsSafePlain(std::string_view text) {
  if (text.empty() || !IsLetter(text[0]) || MeaningOf(text) != PlainMeaning::kText) return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return IsLetter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
  });
}

/// Characters that YAML takes for no text, or for line breaks.
bool MustBeEscaped(boost::locale::utf::code_point c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x2028 || c == 0x2029 || c == 0xfeff ||
         (c & 0xfffe) == 0xfffe;
}

std::string Escaped(boost::locale::utf::code_point c) {
  if (c == '\n') return "\\n";
  if (c == '\t') return "\\t";
  if (c < 0x100) return fmt::format("\\x{:02x}", c);
  return c < 0x10000 ? fmt::format("\\u{:04x}", c) : fmt::format("\\U{:08x}", c);
}

}  // namespace

PlainMeaning MeaningOf(std::string_view plain) {
  if (IsNullWord(plain)) return PlainMeaning::kNull;
  if (IsTruthWord(plain)) return PlainMeaning::kTruth;
  return LooksLikeNumber(plain) ? PlainMeaning::kNumber : PlainMeaning::kText;
}

std::optional<bool> ReadTruth(std::string_view plain) {
  if (!IsTruthWord(plain) || plain.size() < 4) return std::nullopt;
  return plain.size() == 4;
}

NumberOutcome ReadReal(std::string_view plain, double* value) {
  return IsDecimal(plain) ? Convert(plain, value) : NumberOutcome::kNoNumber;
}

NumberOutcome ReadInteger(std::string_view plain, std::int64_t* value) {
  const std::string_view digits = WithoutSign(plain);
  if (digits.empty() || !ConsistsOf(digits, kDigits) || HasLeadingZero(digits)) {
    return NumberOutcome::kNoNumber;
  }
  return Convert(plain, value);
}

std::string WriteReal(double value) {
  HIRES_CHECK(!std::isnan(value), "NaN cannot be written");
  if (std::isinf(value)) return value > 0.0 ? ".inf" : "-.inf";
  std::string text = fmt::format("{}", value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

std::string WriteText(std::string_view text) {
  if (IsSafePlain(text)) return std::string(text);
  std::string quoted = "\"";
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    const char* const begin = at;
    const boost::locale::utf::code_point c = Utf8::decode(at, end);
    HIRES_CHECK(boost::locale::utf::is_valid_codepoint(c), "text to be written is no UTF-8");
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += MustBeEscaped(c) ? Escaped(c) : std::string(begin, at);
  }
  return quoted + "\"";
}

}  // namespace hires::knowledge
