#pragma once

#include <string>
#include <vector>

#include "lab/src/publish/publish_catalogue.h"

namespace hires::lab {

/// What stands between braces in a row's text.
struct Placeholder {
  std::string text;      ///< "{onset_error:n}"
  std::string number;    ///< "onset_error"
  std::string part;      ///< "", "interval", "n" or "goal"
  bool is_known{false};  ///< false: it is neither of these
};
std::vector<Placeholder> PlaceholdersOf(const std::string& text);

/// The text with numbers in place of names.
/// @throws base::ConfigError for names that no number has, and for intervals, counts and goals that
/// a number lacks.
std::string Filled(std::string text, const std::vector<PublishedNumber>& numbers);

/// "480,000", "0.10": as many digits behind the point as it is published with; "(not played)".
std::string ValueText(const PublishedNumber& number);
/// "0.8 .. 3.5"; "-" where there is none.
std::string IntervalText(const PublishedNumber& number);
/// "goal 95: met", "goal 90 .. 99: **missed**"; "-" where there is none. A value alone decides.
std::string GoalText(const PublishedNumber& number);

}  // namespace hires::lab
