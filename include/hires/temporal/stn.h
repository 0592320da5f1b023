#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/temporal/interval.h"

namespace hires::temporal {

/// A simple temporal network [Dechter, Meiri, Pearl 1991, Artif. Intell. 49:61-95]: moments, and
/// bounds on the time between two of them. Always consistent: what would make it inconsistent is
/// refused with the cycle of constraints that contradict each other. Bounds are kept as shortest
/// paths from and to the origin, propagated incrementally.
class Stn {
 public:
  using Point = int;
  using ConstraintId = int;
  static constexpr Point kOrigin = 0;  ///< time 0

  /// The constraints that cannot all hold, in the order of the cycle, and the text of it:
  /// "drive lasts at least 12 s; drive ends before 10 s".
  struct Conflict {
    std::vector<ConstraintId> cycle;  ///< the refused one is -1
    std::string text;
  };

  Stn();
  Point AddPoint(std::string name);
  std::size_t num_points() const;
  const std::string& NameOf(Point point) const;

  /// to - from lies in `bounds` [s]. `why` names the constraint in conflicts.
  /// @param id  of the new constraint, where wanted.
  /// @return nothing if it was taken; else the network is as before.
  std::optional<Conflict> Constrain(Point from, Point to, const Bounds& bounds, std::string why,
                                    ConstraintId* id = nullptr);
  /// Gives back what it forbade. @pre the constraint is there.
  void Retract(ConstraintId id);

  Bounds Of(Point point) const;                ///< relative to the origin
  Bounds Between(Point from, Point to) const;  ///< tightest bounds on to - from

 private:
  struct Constraint {
    Point from, to;
    Bounds bounds;
    std::string why;
    bool is_active;
  };
  std::vector<std::string> names_;
  std::vector<Constraint> constraints_;
};

/// What an Allen relation asks of two intervals' ends, as bounds between points; `gap` is what
/// "before" leaves at least and at most.
struct EndConstraint {
  bool from_is_start_a, to_is_start_b;  ///< which end of a and of b
  Bounds bounds;
};
std::vector<EndConstraint> BoundsOf(Allen relation, const Bounds& gap = {0.0, kForever});

}  // namespace hires::temporal
