#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hires/temporal/interval.h"

namespace hires::temporal {

/// A simple temporal network [Dechter, Meiri, Pearl 1991, Artif. Intell. 49:61-95]: moments, and
/// bounds on the time between two of them. Always consistent: what would make it inconsistent is
/// refused with the cycle of constraints that contradict each other.
///
/// Inside, time is counted in whole microseconds, so that sums are exact and a cycle is negative or
/// it is not. A solution is kept as a potential; with it a new constraint is checked in the way of
/// [Cotton, Maler 2006, SAT 2006, LNCS 4121:170-183]. Bounds are kept as shortest paths from and to
/// the origin. A new constraint propagates as far as it changes something, a retracted one until
/// what rested on it is found again; both by Dijkstra's algorithm on the reduced lengths that the
/// potential gives.
class Stn {
 public:
  using Point = int;
  using ConstraintId = int;
  static constexpr Point kOrigin = 0;  ///< time 0
  /// [s] Bounds beyond it are as good as none; it is some 300 years.
  static constexpr double kLongest = 1e10;

  /// The constraints that cannot all hold, in the order of the cycle.
  struct Conflict {
    static constexpr ConstraintId kRefused = -1;
    std::vector<ConstraintId> cycle;  ///< begins with the refused one
    /// Each with the side of it that counts: "drive lasts (at least 12 s); deadline (at most 10
    /// s)".
    std::string text;
  };

  Stn();
  Point AddPoint(std::string name);
  std::size_t num_points() const { return names_.size(); }
  const std::string& NameOf(Point point) const;

  /// to - from lies in `bounds` [s], rounded to microseconds. `why` names the constraint in
  /// conflicts.
  /// @param id  of the new constraint, where wanted; only set if it was taken.
  /// @return nothing if it was taken; else the network is as before.
  /// @pre finite bounds lie within +-kLongest; earliest is not +infinite, latest not -infinite.
  ///   @throws std::logic_error if broken.
  std::optional<Conflict> Constrain(Point from, Point to, const Bounds& bounds, std::string why,
                                    ConstraintId* id = nullptr);
  /// Gives back what it forbade. @pre the constraint is there.  @throws std::logic_error if broken.
  void Retract(ConstraintId id);

  Bounds Of(Point point) const;                ///< relative to the origin
  Bounds Between(Point from, Point to) const;  ///< tightest bounds on to - from

 private:
  using Ticks = std::int64_t;  ///< [us]
  /// Edge 2 i says that constraint i's `to` comes at most `upper` after its `from`, edge 2 i + 1
  /// that its `from` comes at most -`lower` after its `to`.
  using EdgeId = int;
  struct Constraint {
    Point from, to;
    Ticks lower, upper;
    std::string why;
    bool is_active;
  };
  struct Edge {
    Point from, to;
    Ticks length;
  };
  enum class Way { kFromOrigin, kToOrigin };
  struct Reach {  ///< shortest paths from or to the origin, and the edge next to each point on them
    std::vector<Ticks> distance;
    std::vector<EdgeId> edge;
  };
  struct Relaxation;

  Edge EdgeOf(EdgeId edge) const;
  bool IsUseful(EdgeId edge) const;  ///< it bounds something
  void Link(EdgeId edge);
  void Unlink(ConstraintId id);
  std::optional<std::vector<EdgeId>> Repair(EdgeId edge);
  Conflict Explain(const std::vector<EdgeId>& cycle, ConstraintId refused) const;
  std::string TextOf(EdgeId edge) const;

  Edge Along(Way way, EdgeId edge) const;
  const std::vector<EdgeId>& Leaving(Way way, Point point) const;
  Ticks KeyOf(Way way, Point point, Ticks distance) const;
  Reach& reach(Way way) { return way == Way::kFromOrigin ? from_origin_ : to_origin_; }
  void Improve(Way way, EdgeId edge);
  void Forget(Way way, EdgeId edge);
  void Relax(Way way, Reach* reach, Relaxation* open) const;
  Ticks Distance(Point from, Point to) const;

  std::vector<std::string> names_;
  std::vector<Constraint> constraints_;
  std::vector<std::vector<EdgeId>> leaving_, arriving_;
  std::vector<Ticks> potential_;  ///< to <= from + length for every edge
  Reach from_origin_, to_origin_;
};

/// What an Allen relation asks of two intervals' ends, as bounds between points: the named end of b
/// minus that of a lies in `bounds`.
struct EndConstraint {
  bool from_is_start_a, to_is_start_b;  ///< which end of a and of b
  Bounds bounds;
};
/// Where one end must come before another, at least `gap.earliest` and at most `gap.latest` lie
/// between them. With the default two ends may also fall together: simple temporal networks know
/// no "strictly".  @pre 0 <= gap.earliest <= gap.latest.
std::vector<EndConstraint> BoundsOf(Allen relation, const Bounds& gap = {0.0, kForever});

}  // namespace hires::temporal
