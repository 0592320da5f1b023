#pragma once

#include <string>
#include <vector>

#include "hires/imagination/rollout_result.h"
#include "hires/simulation/fall_watch.h"
#include "hires/simulation/robot_simulator.h"
#include "hires/world/standing.h"
#include "imagination/purpose.h"

namespace hires::imagination {

struct RolloutParams;

/// What happened just before now that may have disturbed a load: "late_command", "braking",
/// "accelerating", "turning", or else "floor".
std::string CauseNow(const simulation::RobotSimulator& simulator);

/// Whether a thing that stood on the robot at the start has fallen off before the action began: it
/// stands on no part of it any more, nor where it was. Upright as it may be; what lies is the
/// FallWatch's to tell.
/// @param X_BOstart  where it began in the base frame, nominally.
bool FellWhileSettling(const simulation::RobotSimulator& simulator, int object,
                       const geometry::Pose3& X_BOstart, const world::StandingCriterion& standing);

/// Watches the objects that an action is about, and those that it should leave alone.
///
/// Its concern are the objects that stand on the robot or are in its hands at the start, and the
/// one that the action takes or puts down: their tilt is what Eq. 5.1 counts. Everything else that
/// stands upright at the start, and every ball, is a bystander, which must still stand when all is
/// over unless nothing has reached it (RobotSimulator::IsReached). What counts as a fall is the
/// world::StandingCriterion's to say; the thresholds of Eq. 5.1 in RolloutParams are about samples.
class LoadMonitor {
 public:
  /// The first look finds things where they stand. What fell off the robot while it settled has
  /// fallen already.
  /// @param X_BOstart  where all objects began in the base frame, nominally; none: they have not
  ///                   settled since.
  /// @pre simulator and params outlive the monitor.
  LoadMonitor(simulation::RobotSimulator* simulator, const RolloutParams& params,
              const world::StandingCriterion& standing, const Purpose& purpose = {},
              const std::vector<geometry::Pose3>& X_BOstart = {});

  void Look();  ///< call every world::kFallLookInterval
  /// One sample of Eq. 5.1, of the object of concern that leans most; none if there is no such
  /// object.
  OutcomeCounts Sample() const;

  bool watches_something() const { return !objects_.empty(); }
  double tilt() const { return tilt_; }          ///< [rad] of the object that leans most, now
  double max_tilt() const { return max_tilt_; }  ///< [rad]
  /// Objects that fell over, slid off the robot, or were knocked over (see KnockedOver).
  int falls() const { return falls_; }
  bool is_lost() const {
    return bool(lost_);
  }  ///< physics gave an object a pose that is not finite
  const base::Failure& why_lost() const { return lost_; }  ///< which, or nothing
  const std::string& first_cause() const { return first_cause_; }

  /// Nothing of concern is on the way to falling or standing still again, and no bystander that
  /// still stands moves.
  bool IsSettled() const;

  /// Looks at how things are now that the action says it has reached its goal: the first of these
  /// that is not well, with the names of whom it happened to, or nothing.
  ///   object_fell       what was taken or put down fell from its place or stands lower than it
  ///                     should, or what stood on the robot fell over or down
  ///   object_toppled    what was taken or put down lies where it should stand
  ///   object_slipped    what the hand should hold it does not, or what was put down is not where
  ///                     it was to be
  ///   object_not_released  the hand still holds what it should have put down
  ///   object_slid       what stood on the robot, or was taken or put down, slid too far, and none
  ///                     of it fell
  ///   knocked_over      bystanders, by name
  base::Failure WhyNotWell() const;

  /// Bystanders that do not stand any more, by name. Each counts as one fall once Conclude was
  /// called.
  std::vector<std::string> KnockedOver() const;
  /// What is of concern and down now, by name in lower case.
  std::vector<std::string> Down() const;
  void Conclude();  ///< the last look: counts bystanders that fell

 private:
  struct Object {
    int index;
    std::string name;  // lower case
    bool is_load;      // stands on the robot and is not to be taken from there
    bool was_held;     // at the start
    simulation::FallWatch watch;
    bool fell_while_settling{false};
  };
  struct Bystander {
    int index;
    std::string name;
    simulation::FallWatch watch;
  };
  void Sort(const Purpose& purpose);
  void NoteFallsWhileSettling(const std::vector<geometry::Pose3>& X_BOstart);
  void LookAt(Object* object);
  void LookAtBystanders();
  void NoteFall(const base::Failure& fall);
  void PutBackIfDown(Object* object);
  bool IsHeld(const Object& object) const;
  bool MayFall(const Object& object) const;
  bool IsHandled(const Object& object) const;
  bool Moves(int index) const;
  base::Failure FailureOf(const Object& object, world::Fall fall) const;
  base::Failure WhyNotTaken(const Object& object) const;
  base::Failure WhyNotStanding(const Object& object) const;
  base::Failure WhyHandledIsNotWell() const;
  base::Failure WhyNotHeldAnyMore() const;
  geometry::Pose3 X_MGoal() const;
  Eigen::AlignedBox2d ExtentOfGoal() const;

  simulation::RobotSimulator* simulator_;
  const RolloutParams& params_;
  world::StandingCriterion standing_;
  Purpose purpose_;
  std::vector<Object> objects_;
  std::vector<Bystander> bystanders_;
  int handled_{-1};  // in objects_
  double tilt_{0.0}, max_tilt_{0.0};
  int falls_{0};
  base::Failure lost_;
  base::Failure first_fall_;  // and all that fell like the first; a slide only if nothing fell
  std::string first_cause_;
};

}  // namespace hires::imagination
