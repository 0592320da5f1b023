#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/robot/trajectory.h"
#include "hires/skills/activity.h"
#include "hires/skills/manipulation_context.h"

namespace hires::skills {

/// Trajectories by group of joints: "torso", "head", an arm.
using GroupTrajectories = std::map<std::string, robot::JointTrajectory>;

enum class MotionEnd {
  kSettled,  ///< over when all joints have rested at the goal
  kPassing,  ///< over as soon as they come within tolerance: another motion follows
};

/// Sends trajectories once and watches the joints until they have reached their ends. Only the head
/// is sent on again where it is late: what looks around while no action needs it may have turned it
/// before it heard of this one. Fails with timed_out when they are not there long after they should
/// be.
class JointMotion : public Activity {
 public:
  JointMotion(std::shared_ptr<const ManipulationContext> context, GroupTrajectories trajectories,
              MotionEnd end = MotionEnd::kSettled);

  Status Update(const robot::Observation& observation, robot::Command* command) override;

 private:
  bool IsAtGoal(const robot::Observation& observation) const;
  bool IsTorsoAlone() const;
  void SendLateHead(const robot::Observation& observation, robot::Command* command);

  std::shared_ptr<const ManipulationContext> context_;
  GroupTrajectories trajectories_;
  MotionEnd end_;
  double duration_{0.0};        // [s]
  double begin_{-1.0};          // [s] negative: not begun
  double at_goal_since_{-1.0};  // [s] negative: not there
  double head_due_{0.0};        // [s] then the head should be there
};

/// A group of joints along a path that begins where the joints are now.
robot::JointTrajectory TrajectoryFrom(const ManipulationContext& context,
                                      const robot::Observation& observation,
                                      const std::vector<std::string>& joints,
                                      std::vector<std::vector<double>> path, double speed);

/// Opens or closes a gripper. Opening ends when the gap is reached (timed_out otherwise), closing
/// when the fingers have come to rest, on something or on each other.
class GripperMotion : public Activity {
 public:
  static std::unique_ptr<Activity> Open(std::shared_ptr<const ManipulationContext> context,
                                        const std::string& arm);
  static std::unique_ptr<Activity> Close(std::shared_ptr<const ManipulationContext> context,
                                         const std::string& arm);

  GripperMotion(std::shared_ptr<const ManipulationContext> context, std::string arm,
                robot::GripperCommand wanted, bool opens);
  Status Update(const robot::Observation& observation, robot::Command* command) override;

 private:
  bool IsOver(double gap, double time);

  std::shared_ptr<const ManipulationContext> context_;
  std::string arm_;
  robot::GripperCommand wanted_;
  bool opens_;
  double begin_{-1.0};         // [s] negative: not begun
  double resting_gap_{0.0};    // [m]
  double resting_since_{0.0};  // [s]
  bool has_moved_{false};
};

/// Waits until something is seen; fails with `failure` after `time_limit` [s].
class WaitUntil : public Activity {
 public:
  using Condition = std::function<bool(const robot::Observation&)>;
  WaitUntil(Condition condition, double time_limit, base::Failure failure)
      : condition_(std::move(condition)), time_limit_(time_limit), failure_(std::move(failure)) {}

  Status Update(const robot::Observation& observation, robot::Command* command) override;

 private:
  Condition condition_;
  double time_limit_;  // [s]
  base::Failure failure_;
  double begin_{-1.0};  // [s]
};

/// [m] between the finger tips, as measured.
double GapNow(const robot::ArmProfile& arm, const robot::Observation& observation);

/// Brings every joint that moves to rest, each group as fast as its slowest joint can brake, and
/// the base too: what stops a skill in the middle.
robot::Command Halt(const robot::Robot& robot, const robot::Observation& observation);

}  // namespace hires::skills
