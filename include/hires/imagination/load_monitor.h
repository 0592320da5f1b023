#pragma once

#include <string>
#include <vector>

#include "hires/imagination/rollout_result.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::imagination {

struct RolloutParams;

/// Watches what the robot carries: tilt, falls, and the cause of the first shaking.
class LoadMonitor {
 public:
  /// @pre both outlive the monitor. Starts where the objects stand now.
  LoadMonitor(simulation::RobotSimulator* simulator, const RolloutParams& params);

  void Look();                   ///< call every few milliseconds
  OutcomeCounts Sample() const;  ///< one sample of Eq. 5.1, of the object that leans most

  double tilt() const { return tilt_; }          ///< [rad] of the object that leans most, now
  double max_tilt() const { return max_tilt_; }  ///< [rad]
  int falls() const { return falls_; }
  bool is_lost() const { return is_lost_; }  ///< physics gave an object a pose that is not finite
  const std::string& first_fall() const { return first_fall_; }  ///< "object_fell", "object_slid"
  const std::string& first_cause() const { return first_cause_; }

 private:
  struct Object {
    int index;
    geometry::Pose3 X_BO;  // in the base frame, at the start
    bool has_fallen{false};
  };
  void LookAt(Object* object);
  void NoteFall(Object* object, double tilt, bool slid);
  std::string Cause() const;

  simulation::RobotSimulator* simulator_;
  const RolloutParams& params_;
  std::vector<Object> objects_;
  double tilt_{0.0}, max_tilt_{0.0};
  int falls_{0};
  bool is_lost_{false};
  std::string first_fall_, first_cause_;
};

}  // namespace hires::imagination
