#pragma once

#include <optional>

#include "hires/base/param_reader.h"
#include "hires/geometry/pose.h"

// The one meaning of a fall, for rollouts, experiments, the record of what really happens, skills,
// translation and markers.
namespace hires::world {

/// When a thing that should stand counts as fallen. Block `standing` of config/scene.yaml;
/// docs/sources.md says where the numbers come from.
struct StandingCriterion {
  double tilt{0.5};       ///< [rad] its axis leans from the world's by that much or more ...
  double hold_time{0.0};  ///< [s] ... and has done so for that long
  double drop{0.05};      ///< [m] it is lower than where it stood by more than that
  double slide{0.10};     ///< [m] it is beside where it stood, level, by more than that

  /// What fell counts as put up again once it leans by less than this share of `tilt`. No
  /// parameter: it only keeps a thing that rocks at the edge from falling many times.
  static constexpr double kUprightShare = 0.2;
  double upright_tilt() const { return kUprightShare * tilt; }  ///< [rad]
};
/// @throws base::ConfigError naming file and key; unknown keys are refused.
StandingCriterion ReadStandingCriterion(base::ParamReader in);

/// In what way a thing fell. The first that holds counts.
enum class Fall {
  kNone,
  kLost,     ///< its pose is no number any more
  kToppled,  ///< it leans too far
  kDropped,  ///< it is lower than where it stood
  kSlid      ///< it is not where it stood
};

/// What falls is worse than what only slid, and that is worse than nothing; ways to fall are alike.
bool IsWorse(Fall fall, Fall than);

/// How far a thing is from standing where it stood.
struct Departure {
  double tilt{0.0};   ///< [rad] alpha of Eq. 5.1
  double drop{0.0};   ///< [m] below where it stood; negative: above
  double slide{0.0};  ///< [m] beside where it stood
};
/// @param X_CstoodO  where it stood in the frame of what carries it, whose z axis points up.
/// @param X_CO       where it is now, in the same frame.
Departure DepartureFrom(const geometry::Pose3& X_CstoodO, const geometry::Pose3& X_CO);

/// It is lower than where it stood, or beside it, by more than the criterion allows, however it
/// leans.
bool IsAway(const StandingCriterion& criterion, const Departure& departure);

/// For those who see a thing once and know neither for how long it has leaned nor where it stood:
/// it does not lean too far. False for a pose that is not finite.
bool IsUpright(const StandingCriterion& criterion, const geometry::Pose3& X_MO);

/// [s] of simulated time between two looks at things that are followed in rollouts, experiments and
/// the record of what really happens: what imagination sees fall, that record sees, too.
constexpr double kFallLookInterval = 0.005;
/// As a number of steps of `time_step` [s]; at least one.
/// @pre time_step > 0.  @throws std::logic_error if broken.
long StepsPerLook(double time_step);

/// Follows one thing and says when it falls. A thing stands where it was first seen, where a hand
/// let go of it, or where it was first seen after Reset(). What a hand holds may lean and be moved
/// as it likes and cannot fall. A fall counts once, also one that begins as a slide and ends worse
/// (IsWorse); it may fall again after it was put up: held and let go, or upright (within the
/// criterion's upright_tilt) where it stood before.
class FallDetector {
 public:
  explicit FallDetector(const StandingCriterion& criterion) : criterion_(criterion) {}

  /// One look.
  /// @param X_MO  the thing in the map.
  /// @param X_MC  what carries it: the robot's base for a thing on its tray, the map itself for one
  ///              on furniture or the floor. May be another one after a hand held it, or Reset().
  /// @param t     [s] While time stands still nothing leans any longer; from a clock that is set
  ///              back on, the hold time counts from its beginning.
  /// @return the fall that this look completes, or to which a slide comes with it; kNone at all
  ///         other looks.
  Fall Update(const geometry::Pose3& X_MO, bool is_held, double t,
              const geometry::Pose3& X_MC = {});

  /// It was put elsewhere from outside: it stands where the next look finds it.
  void Reset();

  /// What it is down by; kNone if it did not fall, or was put up.
  Fall fall() const { return fall_; }
  bool is_down() const { return fall_ != Fall::kNone; }
  /// It stood at the last look: nothing holds it, it is not down and does not lean too far.
  bool stands() const;
  int falls() const { return falls_; }           ///< so far
  const Departure& now() const { return now_; }  ///< at the last look; of a held thing its tilt

 private:
  Fall Note(Fall seen);
  bool HasLeanedLong(double t);

  StandingCriterion criterion_;
  std::optional<geometry::Pose3> X_CstoodO_;
  std::optional<double> leaning_since_;  // [s]
  Departure now_;
  Fall fall_{Fall::kNone};
  int falls_{0};
};

}  // namespace hires::world
