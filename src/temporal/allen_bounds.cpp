#include <algorithm>

#include "hires/base/check.h"
#include "hires/temporal/stn.h"

namespace hires::temporal {
namespace {

/// What is asked of the four pairs of ends.
class EndConstraints {
 public:
  explicit EndConstraints(const Bounds& gap) : gap_(gap) {}

  EndConstraints& Starts(const Bounds& bounds) { return Add({true, true, bounds}); }
  EndConstraints& Finishes(const Bounds& bounds) { return Add({false, false, bounds}); }
  EndConstraints& FinishToStart(const Bounds& bounds) { return Add({false, true, bounds}); }
  EndConstraints& StartToFinish(const Bounds& bounds) { return Add({true, false, bounds}); }

  Bounds Later() const { return gap_; }
  Bounds Earlier() const { return {-gap_.latest, -gap_.earliest}; }
  static Bounds Same() { return {0.0, 0.0}; }

  std::vector<EndConstraint> Take() { return std::move(all_); }

 private:
  EndConstraints& Add(const EndConstraint& constraint) {
    all_.push_back(constraint);
    return *this;
  }

  Bounds gap_;
  std::vector<EndConstraint> all_;
};

}  // namespace

std::vector<EndConstraint> BoundsOf(Allen relation, const Bounds& gap) {
  HIRES_CHECK(0.0 <= gap.earliest && gap.earliest <= gap.latest, "a gap must not be negative");
  EndConstraints ends(gap);
  const Bounds later = ends.Later(), earlier = ends.Earlier(), same = EndConstraints::Same();
  switch (relation) {
    case Allen::kBefore:
      return ends.FinishToStart(later).Take();
    case Allen::kMeets:
      return ends.FinishToStart(same).Take();
    case Allen::kOverlaps:
      return ends.Starts(later).FinishToStart(earlier).Finishes(later).Take();
    case Allen::kStarts:
      return ends.Starts(same).Finishes(later).Take();
    case Allen::kDuring:
      return ends.Starts(earlier).Finishes(later).Take();
    case Allen::kFinishes:
      return ends.Starts(earlier).Finishes(same).Take();
    case Allen::kEquals:
      return ends.Starts(same).Finishes(same).Take();
    case Allen::kFinishedBy:
      return ends.Starts(later).Finishes(same).Take();
    case Allen::kContains:
      return ends.Starts(later).Finishes(earlier).Take();
    case Allen::kStartedBy:
      return ends.Starts(same).Finishes(earlier).Take();
    case Allen::kOverlappedBy:
      return ends.Starts(earlier).StartToFinish(later).Finishes(earlier).Take();
    case Allen::kMetBy:
      return ends.StartToFinish(same).Take();
    case Allen::kAfter:
      return ends.StartToFinish(earlier).Take();
  }
  return {};
}

}  // namespace hires::temporal
