#include "hires/control/move_base_limits.h"

#include <fmt/format.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::control {
namespace {

using base::ConfigError;
using robot::MotionSet;

constexpr double kSame = 1e-9;  // of numbers that went to a server and back

struct Limit {
  std::string word;
  double MotionSet::*field;
};

const std::vector<Limit>& Table() {
  static const std::vector<Limit> table{
      {"max_linear_velocity", &MotionSet::max_linear_velocity},
      {"max_translational_velocity", &MotionSet::max_linear_velocity},
      {"max_angular_velocity", &MotionSet::max_angular_velocity},
      {"max_linear_acceleration", &MotionSet::max_linear_acceleration},
      {"max_lateral_acceleration", &MotionSet::max_linear_acceleration},
      {"max_angular_acceleration", &MotionSet::max_angular_acceleration},
  };
  return table;
}

/// The planner's own word for a limit.
const std::string& WordFor(const std::string& limit, const std::vector<std::string>& words,
                           const PlannerValues& having) {
  for (const std::string& word : words) {
    if (having.count(word) > 0) return word;
  }
  throw ConfigError(fmt::format(
      "has no parameter for {}: none of {}; add its name to move_base.parameters in the "
      "file of the robot's names; it has {}",
      limit, base::Join(words, ", "), ToText(having)));
}

}  // namespace

const std::vector<std::string>& MotionLimits() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all;
    for (const Limit& limit : Table()) all.push_back(limit.word);
    return all;
  }();
  return words;
}

double LimitOf(const MotionSet& set, const std::string& limit) {
  for (const Limit& known : Table()) {
    if (known.word == limit) return set.*known.field;
  }
  throw ConfigError(base::UnknownName("limit", limit, MotionLimits()));
}

PlannerValues InWordsOf(const PlannerValues& having, const RobotNames::MoveBase& names,
                        const MotionSet& set) {
  PlannerValues values;
  for (const auto& [limit, words] : names.parameters) {
    values[WordFor(limit, words, having)] = LimitOf(set, limit);
  }
  return values;
}

std::string WhatDiffers(const PlannerValues& wanted, const PlannerValues& got) {
  std::vector<std::string> differences;
  for (const auto& [name, value] : wanted) {
    const auto found = got.find(name);
    if (found == got.end()) {
      differences.push_back(fmt::format("{} is not there, wanted {:g}", name, value));
    } else if (!(std::abs(found->second - value) <= kSame)) {  // a NaN is different too
      differences.push_back(fmt::format("{} is {:g}, wanted {:g}", name, found->second, value));
    }
  }
  return base::Join(differences, "; ");
}

std::string ToText(const PlannerValues& values) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : values) parts.push_back(fmt::format("{} {:g}", name, value));
  return parts.empty() ? "nothing" : base::Join(parts, ", ");
}

}  // namespace hires::control
