#pragma once

#include <set>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/planning/datum.h"

namespace hires::execution {

/// (!imagine !drive (a) (slow fast)): drive with those lists.
base::ActionTemplate TemplateOf(const planning::Datum& task);

/// The call is one of the combinations.
bool Fits(const base::ActionTemplate& action, const base::ActionCall& call);
bool IsSame(const base::ActionTemplate& a, const base::ActionTemplate& b);

base::ActionCall Lowered(const base::ActionCall& call);  ///< as plans spell it, without `!`
std::set<std::string> LoweredSet(const std::vector<std::string>& names);

}  // namespace hires::execution
