#pragma once

#include <optional>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/navigation/dwa.h"
#include "navigation/swept_footprint.h"

namespace hires::navigation {

/// Notices that what is left of a way hardly becomes less for some time, by what the motion set
/// lets a base do. To be told once in a control cycle. A value.
class ProgressWatch {
 public:
  /// @param patience  [s]
  ProgressWatch(const DwaParams& params, double patience);

  void SetMotionSet(const robot::MotionSet& limits);
  /// @param left  [m], what is to be turned included, as LeftTo has it.
  bool Stalls(double left);
  void Reset();

 private:
  double period_, patience_;  // [s]
  double closer_;             // [m] what counts as progress
  double least_;              // [m] that remained so far
  double since_;              // [s]
};

/// [m] to a place, with what a base has to turn to face it.
double LeftTo(const geometry::Pose2& X_MB, const Eigen::Vector2d& p_M);

/// [m] As near to its goal a base is a matter of GoalWatch.
double NearGoal(const DwaParams& params);

/// Notices a base that swings beside its goal: near it, it has come hardly nearer and turned hardly
/// further towards it for some time. To be told once in a control cycle. A value.
class GoalWatch {
 public:
  explicit GoalWatch(const DwaParams& params);

  void SetMotionSet(const robot::MotionSet& limits) { watch_.SetMotionSet(limits); }
  bool Swings(const geometry::Pose2& X_MB, const Eigen::Vector2d& p_MGoal);
  void Reset() { watch_.Reset(); }

 private:
  double near_;  // [m]
  ProgressWatch watch_;
};

/// [rad/s] With the sign of an angle [rad]: how fast a base that lags may turn that has so far to
/// go.
double SpeedOfTurn(double angle, const robot::MotionSet& limits);

/// [rad] Signed: the shorter way of an angle; of a turn that has begun, with a sign, its own way
/// while that is far from done.
double TurnBegun(double angle, int sign);

/// The signed angle to a heading through which the base can turn where it stands without contact:
/// the shorter way, or that of a turn begun (TurnBegun; sign 0: none has), else the other one.
std::optional<double> FreeTurn(const Costmap& costmap, const geometry::Pose2& X_MB, double yaw,
                               int sign, SweptFootprint* sweep);

/// A turn on the spot to a heading, and a straight drive as it is headed then to a place: forward,
/// backward or, of a base that moves sideways, to its left or right.
struct Piece {
  double yaw{0.0};                  ///< [rad]
  int sign{0};                      ///< of the turn; 0: the shorter way
  Eigen::Vector2d p_MTo{0.0, 0.0};  ///< [m]
};

/// Brings a base from nearby to the place of its goal without sampling velocities, of which each
/// may lead past it. A base that moves sideways creeps there as it is headed; another one turns its
/// front or its back to the place, drives there straight, and leaves the turn to the goal's heading
/// to the caller. Or it drives pieces of a way that was found elsewhere, whatever base. Only where
/// the footprint's way is free. A value.
class GoalApproach {
 public:
  explicit GoalApproach(const DwaParams& params);

  void SetMotionSet(const robot::MotionSet& limits) { limits_ = limits; }

  /// To the goal, as far as its place is known on the way.
  void BeginTo(const geometry::Pose2& X_MGoal);
  /// The base stands headed as at its goal and lacks what lies between. It drives just that far: as
  /// it turns, what its believed place errs by turns with it, and comes back with the heading.
  void BeginFrom(const geometry::Pose2& X_MB, const geometry::Pose2& X_MGoal);
  /// One after the other, each from standing. @pre not empty
  void BeginAlong(std::vector<Piece> pieces);
  void End() { stage_ = Stage::kNone; }
  bool is_active() const { return stage_ != Stage::kNone; }

  enum class State { kDriving, kArrived, kBlocked };
  struct Step {
    State state;
    geometry::Twist2 velocity;  ///< zero unless driving
  };
  /// One control cycle. It ends where it has arrived, or something is in its way.
  /// @pre is_active()
  Step Update(const Costmap& costmap, const geometry::Pose2& X_MB, const geometry::Twist2& V_B,
              SweptFootprint* sweep);

 private:
  enum class Stage { kNone, kStopping, kTurning, kDriving };

  bool CanMoveSideways() const { return params_.max_lateral_velocity > 0.0; }
  Eigen::Vector2d Place(const geometry::Pose2& X_MB) const;
  bool Choose(const Costmap& costmap, const geometry::Pose2& X_MB, SweptFootprint* sweep);
  bool ChooseOwn(const Costmap& costmap, const geometry::Pose2& X_MB, SweptFootprint* sweep);
  double TurnLeft(double yaw) const;
  double HeadingTowards(const Eigen::Vector2d& p_MB, double left) const;
  double MostTowards(const Eigen::Vector2d& way_B) const;
  geometry::Twist2 Turn(const geometry::Pose2& X_MB, const geometry::Twist2& V_B) const;
  std::optional<geometry::Twist2> Drive(const geometry::Pose2& X_MB,
                                        const geometry::Twist2& V_B) const;

  DwaParams params_;
  robot::MotionSet limits_;
  Stage stage_{Stage::kNone};
  geometry::Pose2 X_MGoal_;
  std::optional<Eigen::Vector2d> missing_M_;  // [m] to be driven; none: to the goal's place
  std::vector<Piece> pieces_;                 // not begun; the next one is the last
  bool has_pieces_{false};
  Eigen::Vector2d p_MTo_{0.0, 0.0};  // while it drives
  double yaw_{0.0};                  // [rad] with which it drives
  int sign_{0};                      // of the turn to it
  geometry::Twist2 commanded_;       // in the last cycle
};

}  // namespace hires::navigation
