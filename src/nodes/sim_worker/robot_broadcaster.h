#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>
#include <memory>
#include <string>

#include "hires/ros/imagination/trace_markers.h"
#include "hires/simulation/robot_simulator.h"
#include "hires/simulation/scene.h"

namespace hires_ros {

/// Shows a worker's robot to its own master under the names of a PR2: /clock, /tf (map ->
/// odom_combined -> base_footprint), /tf_static (links; the joints are frozen at this level of
/// detail), /joint_states, /base_odometry/odom; and to the main master worker_k/markers. Simulated
/// time never runs backwards: each rollout goes on where the last ended.
class RobotBroadcaster {
 public:
  /// @param rate  [Hz] at most, by the wall's clock.
  RobotBroadcaster(std::shared_ptr<const hires::simulation::Scene> scene,
                   const hires::world::StandingCriterion& standing, int index, double rate,
                   ros::NodeHandle* nh);

  void BeginRollout();  ///< also where one begins again
  void Publish(const hires::simulation::RobotSimulator& simulator);
  void PublishIdle();  ///< keeps /clock ticking at the wall's pace while nothing is played

 private:
  bool IsDue();
  ros::Time SimulatedTime(double in_rollout) const;
  void PublishClock(const ros::Time& time);
  void PublishRobot(const hires::simulation::RobotSimulator& simulator, const ros::Time& stamp);
  void PublishLinks(const ros::Time& stamp);

  std::shared_ptr<const hires::simulation::Scene> scene_;
  std::chrono::duration<double> period_;
  std::chrono::steady_clock::time_point last_{};
  double clock_base_{1.0};  // [s]; 0 would mean "no time yet"
  double in_rollout_{0.0};  // [s]
  ros::Publisher clock_, odom_, joints_, markers_;
  tf2_ros::TransformBroadcaster tf_;
  tf2_ros::StaticTransformBroadcaster static_tf_;
  TraceMarkers trace_;
};

}  // namespace hires_ros
