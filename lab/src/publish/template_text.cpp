#include "lab/src/publish/template_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

constexpr std::size_t kDigitsInAGroup = 3;
constexpr std::size_t kLeastGrouped = 5;  // 480,000, but 1000

/// A comma between thousands of what has five digits or more before the point.
std::string Grouped(std::string text) {
  const std::size_t begin = text[0] == '-' ? 1 : 0;
  const std::size_t end = std::min(text.find('.'), text.size());
  if (end - begin < kLeastGrouped) return text;
  for (std::size_t at = end - kDigitsInAGroup; at > begin; at -= kDigitsInAGroup) {
    text.insert(at, ",");
    if (at < begin + kDigitsInAGroup) break;
  }
  return text;
}

/// A zero has no sign.
std::string Text(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return Grouped(is_zero && text[0] == '-' ? text.substr(1) : text);
}

std::string TextOf(const Placeholder& placeholder, const PublishedNumber& number) {
  if (!number.value && !placeholder.part.empty()) return "-";
  if (placeholder.part == "interval" && number.low) return IntervalText(number);
  if (placeholder.part == "goal" && (number.at_least || number.at_most)) return GoalText(number);
  if (placeholder.part == "n" && number.n) return Grouped(std::to_string(*number.n));
  if (placeholder.part.empty()) return ValueText(number);
  throw base::ConfigError(
      fmt::format("{}: the number has none; wanted a row without it", placeholder.text));
}

}  // namespace

std::vector<Placeholder> PlaceholdersOf(const std::string& text) {
  static const std::regex kBraces("\\{[^}]*\\}"), kKnown("\\{([a-z0-9_]+)(:(interval|n|goal))?\\}");
  std::vector<Placeholder> placeholders;
  for (std::sregex_iterator at(text.begin(), text.end(), kBraces), end; at != end; ++at) {
    const std::string braces = at->str();
    std::smatch parts;
    const bool is_known = std::regex_match(braces, parts, kKnown);
    placeholders.push_back(
        {braces, is_known ? parts[1].str() : "", is_known ? parts[3].str() : "", is_known});
  }
  return placeholders;
}

std::string Filled(std::string text, const std::vector<PublishedNumber>& numbers) {
  for (const Placeholder& placeholder : PlaceholdersOf(text)) {
    const auto number =
        std::find_if(numbers.begin(), numbers.end(),
                     [&](const PublishedNumber& each) { return each.name == placeholder.number; });
    if (number == numbers.end()) {
      throw base::ConfigError(placeholder.text +
                              ": the results have no such number; `hires_lab publish` adds it");
    }
    const std::string filled = TextOf(placeholder, *number);
    text.replace(text.find(placeholder.text), placeholder.text.size(), filled);
  }
  return text;
}

std::string ValueText(const PublishedNumber& number) {
  return number.value ? Text(*number.value, number.digits) : "(not played)";
}

std::string IntervalText(const PublishedNumber& number) {
  if (!number.low || !number.high) return "-";
  return Text(*number.low, number.digits) + " .. " + Text(*number.high, number.digits);
}

std::string GoalText(const PublishedNumber& number) {
  std::vector<std::string> ends;
  for (const std::optional<double>& end : {number.at_least, number.at_most}) {
    if (end) ends.push_back(fmt::format("{:g}", *end));
  }
  if (ends.empty()) return "-";
  const std::string goal = "goal " + base::Join(ends, " .. ");
  if (!number.value) return goal;
  const bool is_met = *number.value >= number.at_least.value_or(*number.value) &&
                      *number.value <= number.at_most.value_or(*number.value);
  return goal + (is_met ? ": met" : ": **missed**");
}

}  // namespace hires::lab
