#pragma once

#include <memory>
#include <vector>

#include "hires/imagination/imagination_setup.h"
#include "hires/sensing/object_estimator.h"
#include "hires/sensing/robot_state_estimator.h"
#include "hires/sensing/scan_obstacles.h"
#include "hires/simulation/laser_scanner.h"
#include "loop/frame_record.h"
#include "loop/loop_observer.h"

namespace hires::loop {

/// The robot's frames by the names that its own messages have.
sensing::FrameNames FramesOf(const robot::Robot& robot);

/// One listener's estimates of the robot's state and of objects: middle layer and tracker have each
/// their own, as they have in processes of their own.
class RobotSenses {
 public:
  /// @param frames  what the robot calls map, odometry and base.
  /// @param surroundings  of what is told and seen of objects; null: nothing is.
  RobotSenses(const imagination::ImaginationSetup& setup, const sensing::FrameNames& frames,
              std::shared_ptr<const perception::Surroundings> surroundings);

  /// Takes in all but the laser of the base.
  void Hear(const SensorNews& news);
  /// What the camera saw at a moment that is not told of yet.
  void See(double stamp, const perception::Sighting& seen);

  const sensing::FrameNames& frames() const { return names_; }
  const sensing::RobotStateEstimator& state() const { return state_; }
  /// Null without surroundings.
  sensing::ObjectEstimator* objects() const { return objects_.get(); }

 private:
  const sensing::FrameNames names_;
  const std::string base_link_, camera_link_;
  std::shared_ptr<FrameRecord> frames_;
  sensing::RobotStateEstimator state_;
  std::unique_ptr<sensing::ObjectEstimator> objects_;
};

}  // namespace hires::loop
