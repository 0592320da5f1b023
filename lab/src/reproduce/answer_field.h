#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace hires::lab {

/// Where a number stands.
struct AnswerField {
  std::string play;
  /// JSON pointer into the play's answer; true and false are 1 and 0 there, and what has `lower`
  /// and `upper` is an interval about its `estimate`, `mean` or `share`. A step `key=value` is the
  /// first entry of a list whose `key` says so.
  std::string pointer;
};
std::string ToString(const AnswerField& field);  ///< "durations:/measures/failed"

/// A number of an answer, with the interval that it was told with.
struct FoundNumber {
  double number{0.0};
  std::optional<double> lower{}, upper{};
};

/// What an answer says of a value.
struct Reading {
  std::optional<FoundNumber> found;
  bool has_value{true};  // false: an event that it rests on never came, so that it cannot be told
};

/// @param answer  of the field's play.
/// @throws base::ConfigError naming the field, if there is no number.
Reading ReadingAt(const AnswerField& field, const nlohmann::ordered_json& answer);

}  // namespace hires::lab
