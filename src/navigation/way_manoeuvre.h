#pragma once

#include <optional>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/navigation/dwa.h"
#include "navigation/goal_approach.h"
#include "navigation/swept_footprint.h"

namespace hires::navigation {

/// Turns on the spot and straight drives, forward, backward and, of a base that can, sideways, that
/// bring it from where it stands to a place 1 m or more further along its way, headed along it;
/// with the widest margin with which a bounded search finds some the cheapest ones, which are short
/// and few; or none.
/// @param way     [m] in the map frame, densely spaced; the first one is the nearest to the base.
/// @param sweeps  with margins, the widest first; the last one is the footprint's own.
std::vector<Piece> FindPieces(const Costmap& costmap, const geometry::Pose2& X_MB,
                              const std::vector<Eigen::Vector2d>& way, bool moves_sideways,
                              std::vector<SweptFootprint>* sweeps);

/// What a base does on its way that turns to and fro without coming any further, or stands and has
/// no valid velocity: it stops, and drives a few pieces (FindPieces) to where its way goes on.
/// After few manoeuvres that brought it no further it does nothing. A value.
class WayManoeuvre {
 public:
  explicit WayManoeuvre(const DwaParams& params);

  void SetMotionSet(const robot::MotionSet& limits);
  /// A manoeuvre goes on where the goal is the same, unless the base was found elsewhere.
  void SetWay(bool is_same_goal);
  /// The base stands, and there is no valid velocity.
  void Stand() { is_stuck_ = true; }
  bool is_active() const { return drive_.is_active(); }

  enum class Next { kNothing, kBrake, kDrive };
  struct Step {
    Next next;
    geometry::Twist2 velocity;  ///< of kDrive
  };
  /// One control cycle. @param nearest  of the way's points, not empty, the one nearest to the
  /// base.
  Step Update(const Costmap& costmap, const geometry::Pose2& X_MB, const geometry::Twist2& V_B,
              const std::vector<Eigen::Vector2d>& way, std::size_t nearest,
              std::vector<SweptFootprint>* sweeps);

 private:
  void Look(const geometry::Pose2& X_MB, const std::vector<Eigen::Vector2d>& way,
            std::size_t nearest);

  DwaParams params_;
  ProgressWatch watch_;
  GoalApproach drive_;
  std::optional<Eigen::Vector2d> p_MLast_;  // [m] in the last cycle
  bool is_stuck_{false};
  std::optional<double> least_left_;  // [m] of the way, as far as it counts
  int num_tries_{0};                  // for this goal, since it came further
  double since_search_{0.0};          // [s]
  double patience_{0.0};              // [s] between that one and the next
};

}  // namespace hires::navigation
