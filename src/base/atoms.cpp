#include "hires/base/atoms.h"

#include <algorithm>

namespace hires::base {

bool SameAtoms(const std::vector<Atom>& a, const std::vector<Atom>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Atom& x, const Atom& y) {
    return x.predicate == y.predicate && x.arguments == y.arguments;
  });
}

}  // namespace hires::base
