#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hires/evaluation/sim_robot_sensors.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/sensing/object_estimator.h"
#include "hires/sensing/robot_state_estimator.h"
#include "loop/frame_record.h"

namespace hires::loop {

/// What the robot's sensors say at one moment, as one who listens to them gets it.
struct SensorNews {
  double stamp{0.0};  ///< [s]
  evaluation::SensorReadings readings;
  /// With the moments at which the laser, the localisation and the camera speak, too.
  bool is_tick{false};
  std::vector<double> scan;  ///< [m]; empty: the robot has no laser
  std::optional<std::vector<perception::Detection>> seen;
};

/// One listener's estimates of the robot's state and of objects: middle layer and tracker have each
/// their own, as they have in processes of their own.
class RobotSenses {
 public:
  /// @param frames  what the robot calls map, odometry and base.
  RobotSenses(const imagination::ImaginationSetup& setup, const sensing::FrameNames& frames);

  /// Takes in all but the laser.
  void Hear(const SensorNews& news);

  const sensing::RobotStateEstimator& state() const { return state_; }
  /// Null if the robot sees no objects.
  sensing::ObjectEstimator* objects() const { return objects_.get(); }

 private:
  const sensing::FrameNames names_;
  const std::string base_link_, camera_link_;
  std::shared_ptr<FrameRecord> frames_;
  sensing::RobotStateEstimator state_;
  std::unique_ptr<sensing::ObjectEstimator> objects_;
};

}  // namespace hires::loop
