#pragma once

#include <nlohmann/json.hpp>

#include "lab/src/statistics.h"
#include "reports/text/known_number.h"

namespace hires::lab {

inline nlohmann::ordered_json IntervalJson(const Interval& interval) {
  return {{"estimate", reports::NumberOrNull(interval.estimate)},
          {"lower", reports::NumberOrNull(interval.lower)},
          {"upper", reports::NumberOrNull(interval.upper)}};
}

}  // namespace hires::lab
