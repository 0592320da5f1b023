#pragma once

#include <string>
#include <vector>

#include "hires/imagination/uncertainty.h"

namespace hires::imagination {

/// A part is not the whole: what `over` does not name is as in `base`, unless it is_only. Its
/// correlations take the place of those of `base`, and these go where it spreads start poses
/// itself. The `yaml` of what is returned has all of it.
Uncertainty LaidOver(const Uncertainty& base, const Uncertainty& over);

/// The quantities that keep their nominal values in every rollout, as no distribution is given for
/// them; in the order of their table.
std::vector<std::string> CertainQuantities(const Uncertainty& uncertainty);

/// A sentence about these for people: by name, or all but the others where those are fewer; empty
/// where each quantity has a distribution.
std::string CertainText(const Uncertainty& uncertainty);

}  // namespace hires::imagination
