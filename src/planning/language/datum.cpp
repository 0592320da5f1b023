#include "hires/planning/datum.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "planning/language/datum_text.h"

namespace hires::planning {
namespace {

Datum MakeText(Datum::Kind kind, std::string_view text) {
  Datum datum;
  datum.kind = kind;
  datum.text = text;
  return datum;
}

std::string Shortest(double value, std::chars_format format) {
  char buffer[400];  // a double has at most 309 digits before its point
  const std::to_chars_result end = std::to_chars(buffer, buffer + sizeof buffer, value, format);
  return std::string(buffer, end.ptr);
}

/// "1e+20" becomes "1.0e20", "15" becomes "15.0".
std::string InLispForm(const std::string& number) {
  const std::size_t exponent = number.find('e');
  std::string mantissa = number.substr(0, exponent);
  if (mantissa.find('.') == std::string::npos) mantissa += ".0";
  if (exponent == std::string::npos) return mantissa;
  const std::string power = number.substr(exponent + 1);
  const bool is_negative = power[0] == '-';
  const std::size_t digits = power.find_first_of("123456789");
  return mantissa + (is_negative ? "e-" : "e") + power.substr(digits);
}

/// Lisp writes an exponent outside of 0.001 .. 10 million.
std::string RealText(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
  const double size = std::fabs(value);
  const bool is_fixed = size == 0.0 || (size >= 1e-3 && size < 1e7);
  return InLispForm(
      Shortest(value, is_fixed ? std::chars_format::fixed : std::chars_format::scientific));
}

/// Text into which no more is written than asked for, so that a message about a huge datum is
/// cheap.
class Writer {
 public:
  explicit Writer(std::size_t limit) : limit_(limit) {}

  void Write(const Datum& datum) {
    if (IsFull()) return;
    switch (datum.kind) {
      case Datum::Kind::kSymbol:
        return WriteSymbol(datum.text);
      case Datum::Kind::kVariable:
        return Add(datum.text);
      case Datum::Kind::kInteger:
        return Add(std::to_string(datum.integer));
      case Datum::Kind::kReal:
        return Add(RealText(datum.real));
      case Datum::Kind::kString:
        return WriteQuoted(datum.text, '"');
      case Datum::Kind::kList:
        return WriteList(datum);
    }
  }

  std::string Take() { return std::move(text_); }

 private:
  bool IsFull() const { return text_.size() >= limit_; }

  void Add(std::string_view text) { text_ += text.substr(0, limit_ - text_.size()); }

  void WriteSymbol(const std::string& name) {
    if (NeedsBars(name)) return WriteQuoted(name, '|');
    Add(name);
  }

  void WriteQuoted(const std::string& text, char quote) {
    Add({&quote, 1});
    for (const char c : text) {
      if (IsFull()) return;
      if (c == quote || c == '\\') Add("\\");
      Add({&c, 1});
    }
    Add({&quote, 1});
  }

  void WriteList(const Datum& list) {
    if (list.items.empty()) return Add("nil");
    Add("(");
    for (std::size_t i = 0; i < list.items.size() && !IsFull(); ++i) {
      if (i > 0) Add(" ");
      Write(list.items[i]);
    }
    if (!list.tail.empty()) {
      Add(" . ");
      Write(list.tail.front());
    }
    Add(")");
  }

  std::size_t limit_;
  std::string text_;
};

}  // namespace

std::string_view Datum::Head() const {
  if (!IsList() || items.empty() || items[0].kind != Kind::kSymbol) return {};
  return items[0].text;
}

Datum MakeSymbol(std::string_view name) { return MakeText(Datum::Kind::kSymbol, name); }
Datum MakeVariable(std::string_view name) { return MakeText(Datum::Kind::kVariable, name); }
Datum MakeString(std::string_view text) { return MakeText(Datum::Kind::kString, text); }

Datum MakeInteger(std::int64_t value) {
  Datum datum;
  datum.kind = Datum::Kind::kInteger;
  datum.integer = value;
  return datum;
}

Datum MakeReal(double value) {
  Datum datum;
  datum.kind = Datum::Kind::kReal;
  datum.real = value;
  return datum;
}

Datum MakeList(std::vector<Datum> items) {
  Datum datum;
  datum.items = std::move(items);
  return datum;
}

bool operator==(const Datum& a, const Datum& b) {
  if (a.IsNil() || b.IsNil()) return a.IsNil() && b.IsNil();
  return a.kind == b.kind && a.text == b.text && a.integer == b.integer && a.real == b.real &&
         a.items == b.items && a.tail == b.tail;
}

bool IsGround(const Datum& datum) {
  if (datum.kind == Datum::Kind::kVariable) return false;
  for (const Datum& item : datum.items) {
    if (!IsGround(item)) return false;
  }
  return datum.tail.empty() || IsGround(datum.tail.front());
}

std::string ToString(const Datum& datum) { return ToString(datum, std::string::npos); }

std::string ToString(const Datum& datum, std::size_t at_most) {
  Writer writer(at_most);
  writer.Write(datum);
  return writer.Take();
}

}  // namespace hires::planning
