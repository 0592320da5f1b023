#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hires::planning {

/// Where something stands in a text; both count from 1, 0 means "nowhere, made by a program".
struct Place {
  int line{0};
  int column{0};
};

/// A datum of a planning file as it is written: the syntax tree of SHOP2's Lisp and of HDDL.
/// Symbols and variables are lower case (both languages ignore case); a variable keeps its `?`.
struct Datum {
  enum class Kind { kSymbol, kVariable, kInteger, kReal, kString, kList };

  Kind kind{Kind::kList};
  std::string text;          ///< of a symbol, a variable or a string
  std::int64_t integer{0};   ///< of an integer
  double real{0.0};          ///< of a real number
  std::vector<Datum> items;  ///< of a list; `'x` reads as (quote x), `#'f` as (function f)
  std::vector<Datum> tail;   ///< one element for a dotted list `(a . ?rest)`, else empty
  Place place;

  bool IsSymbol(std::string_view name) const { return kind == Kind::kSymbol && text == name; }
  bool IsList() const { return kind == Kind::kList; }
  bool IsNil() const { return IsList() ? items.empty() : IsSymbol("nil"); }  ///< () and nil
  /// The first item's text where that is a symbol, else "".
  std::string_view Head() const;
};

Datum MakeSymbol(std::string_view name);
Datum MakeVariable(std::string_view name);  ///< with its `?`
Datum MakeInteger(std::int64_t value);
Datum MakeReal(double value);
Datum MakeString(std::string_view text);
Datum MakeList(std::vector<Datum> items);

/// Equal in kind and content, wherever they stand; nil equals ().
bool operator==(const Datum& a, const Datum& b);
inline bool operator!=(const Datum& a, const Datum& b) { return !(a == b); }

bool IsGround(const Datum& datum);         ///< no variable in it
std::string ToString(const Datum& datum);  ///< as SHOP2 prints it: (on b1 (a . ?rest)), 15.0, "x"

}  // namespace hires::planning
