#include "knowledge/state/live_view_match.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <variant>

namespace hires::knowledge {
namespace {

unsigned char Lower(char c) {
  return static_cast<unsigned char>('A' <= c && c <= 'Z' ? c - 'A' + 'a' : c);
}

}  // namespace

bool SameName(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [](char x, char y) { return Lower(x) == Lower(y); });
}

bool NameLess(std::string_view a, std::string_view b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                      [](char x, char y) { return Lower(x) < Lower(y); });
}

bool IsNumber(const Filler& filler) {
  return std::holds_alternative<double>(filler) || std::holds_alternative<std::int64_t>(filler);
}

double AsDouble(const Filler& number) {
  const auto* integer = std::get_if<std::int64_t>(&number);
  return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(number);
}

bool SameFiller(const Filler& a, const Filler& b) {
  const auto* text = std::get_if<std::string>(&a);
  const auto* other = std::get_if<std::string>(&b);
  if (text != nullptr && other != nullptr) return SameName(*text, *other);
  // Integers beyond 2^53 do not all fit a double, so two of them compare as they are.
  if (a.index() == b.index() || !IsNumber(a) || !IsNumber(b)) return a == b;
  return AsDouble(a) == AsDouble(b);
}

}  // namespace hires::knowledge
