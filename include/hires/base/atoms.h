#pragma once

#include <vector>

#include "hires/base/action.h"

namespace hires::base {

/// The same statements in the same order, letter by letter.
bool SameAtoms(const std::vector<Atom>& a, const std::vector<Atom>& b);

}  // namespace hires::base
