#pragma once

#include <tuple>
#include <vector>

#include "hires/imagination/ranking.h"

namespace hires::imagination {

/// Smaller is better, field by field: the criteria of the rule in their order.
using Key = std::tuple<double, double, double>;
Key KeyOf(const Evidence& evidence, const Criteria& criteria);

/// Under kThesis: its action failed in most rollouts.
bool IsOut(const Evidence& evidence);

int NumSuccess(const Evidence& evidence);

}  // namespace hires::imagination
