#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/robot/robot_profile.h"
#include "hires/robot/trajectory.h"

namespace hires::simulation {

/// What one joint can do.
struct DriveLimits {
  double lower{0.0}, upper{0.0};  ///< [rad] or [m]; not used by continuous joints
  bool is_continuous{false};
  double max_velocity{1.0};      ///< [rad/s] or [m/s]
  double max_acceleration{1.0};  ///< [rad/s^2] or [m/s^2]
};

/// The joints of torso, head, arms and grippers between the trajectories that they are sent and the
/// motion that they make. A joint follows its trajectory exactly while that asks for no more than
/// its limits allow; otherwise it lags and catches up, and it always comes to a stop at the
/// trajectory's end without running over it. A value: copy it to save it.
class JointDrives {
 public:
  /// @param start  positions of all driven joints.
  /// @pre the robot has an upper body.
  JointDrives(const robot::Robot& robot, const robot::JointPositions& start);

  /// Replaces what the joints of a group do, from where and as fast as they are now. Joints of the
  /// group that the trajectory leaves out, and all if it has no points, brake and stand. Positions
  /// beyond a limit count as the limit; those of continuous joints are taken by the nearest turn.
  /// @throws base::ConfigError naming group, joint or point: unknown group, a joint that is none of
  /// the group, sizes that differ, numbers that are not finite, times that do not ascend from 0.
  void Send(const std::string& group, const robot::JointTrajectory& trajectory, double time);

  /// Sends one joint to a position as fast as it may. @pre the joint exists.
  void SendTo(int joint, double position);
  /// Puts one joint somewhere, at rest. @pre the position is finite
  void Place(int joint, double position);
  /// Stands from now on, whatever its speed was: something holds it.
  void Halt(int joint);

  /// Moves on to `time`, which is `dt` later [s].
  void Step(double time, double dt);

  int num_joints() const { return static_cast<int>(joints_.size()); }
  const std::string& name(int joint) const { return (*names_)[joint]; }
  int Find(const std::string& name) const;  ///< -1 if it is not driven
  double position(int joint) const { return joints_[joint].position; }
  double velocity(int joint) const { return joints_[joint].velocity; }
  const DriveLimits& limits(int joint) const { return (*limits_)[joint]; }
  bool is_moving() const { return is_moving_; }  ///< any joint, in the last step

 private:
  struct Knot {
    double time{0.0};  // [s]
    double position{0.0};
    double velocity{0.0};
  };
  struct Reference {
    std::vector<Knot> knots;  // at least one
    bool is_smooth{false};    // velocities count: cubics between knots, else straight lines
  };
  struct State {
    double position{0.0};
    double velocity{0.0};                        // during the last step
    std::shared_ptr<const Reference> reference;  // empty: stands, or brakes
    std::size_t knot{0};                         // where in the reference it is
  };
  struct Wanted {
    double position{0.0}, velocity{0.0};
  };
  static Wanted At(const Reference& reference, std::size_t* knot, double time);
  std::shared_ptr<const Reference> MakeReference(int joint, std::size_t column,
                                                 const robot::JointTrajectory& trajectory,
                                                 double time) const;
  void Check(const std::string& group, const robot::JointTrajectory& trajectory) const;
  void Brake(int joint);
  void StepJoint(int joint, double time, double dt);

  // Constant, shared by copies.
  std::shared_ptr<const std::vector<std::string>> names_;
  std::shared_ptr<const std::vector<DriveLimits>> limits_;
  std::shared_ptr<const std::map<std::string, std::vector<int>>> groups_;
  std::vector<State> joints_;
  bool is_moving_{false};
};

/// Names of the joints that move links, in the order of the drives: the drives' own, the joints of
/// the fingers in place of the gaps. @pre the robot has an upper body.
std::vector<std::string> MovingJoints(const robot::Robot& robot, const JointDrives& drives);

}  // namespace hires::simulation
