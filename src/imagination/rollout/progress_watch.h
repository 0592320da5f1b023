#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/skills/move_base.h"

namespace hires::imagination {

/// From when on a base came no further, and what it did instead.
struct Stall {
  enum class Kind { kStands, kCircles, kTurns, kSwings };
  Kind kind{Kind::kStands};
  double since{0.0};              ///< [s] since the action began
  geometry::Pose2 X_MB;           ///< at the end
  std::optional<double> to_goal;  ///< [m] from there; none where it knows no goal
  double speed{0.0};              ///< [m/s] mean since then
  double turning{0.0};            ///< [rad/s] likewise, to one side
};

/// Notes where a driving robot is, once a control cycle.
class ProgressWatch {
 public:
  /// @param time  [s] since the action began; not less than before.
  void Note(double time, const geometry::Pose2& X_MB, const std::optional<skills::DriveView>& view);

  /// The longest time up to the last note in which it stayed within a small place; nothing where
  /// that is short against the whole, as it was still under way.
  std::optional<Stall> StallAtEnd() const;

  /// Where it should come to, as far as it was told.
  const std::optional<geometry::Pose2>& X_MGoal() const { return X_MGoal_; }

  /// [m] from where it was last to where it should come to; nothing where it knows no goal.
  std::optional<double> ToGoal() const;

  /// Whether in all it came nearer to its goal at a fifth at least of the pace that it had at best,
  /// over 5 s: else it was stuck again and again. True where it knows no goal.
  bool ComesOn() const;

 private:
  struct Noted {
    double time;
    geometry::Pose2 X_MB;
  };
  std::vector<Noted> noted_;
  std::optional<geometry::Pose2> X_MGoal_;
};

/// "circles its goal 0.31 m off": what it does, for people.
std::string WhatItDoes(const Stall& stall);

/// The same with since when and where, and which parameter would help; at a goal that has no room
/// for the base (skills::WhyGoalIsTight; empty: it has) another goal would.
std::string StallText(const Stall& stall, const skills::MoveBaseParams& driving,
                      const std::string& why_tight);

/// What to say of a drive that ran out of time and was not stuck at its end.
std::string UnderWayText(double time_limit, const std::optional<double>& to_goal, bool comes_on);

}  // namespace hires::imagination
