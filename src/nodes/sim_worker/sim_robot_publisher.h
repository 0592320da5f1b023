#pragma once

#include <hires/GroundTruth.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"
#include "hires/ros/imagination/trace_markers.h"
#include "hires/simulation/truth_record.h"
#include "nodes/sim_worker/sim_robot_camera_publisher.h"
#include "nodes/sim_worker/sim_robot_laser_publisher.h"
#include "nodes/sim_worker/sim_robot_motion_publisher.h"
#include "nodes/sim_worker/sim_robot_params.h"
#include "sim_robot/sim_robot_sensors.h"
#include "sim_robot/sim_robot_world.h"

namespace hires_ros {

/// Says under a PR2's names what the simulated robot's sensors read, and under ground_truth/ what
/// is really so.
class SimRobotPublisher {
 public:
  /// @param setup  what the robot is told: the map is of it; `world` is what there is to see.
  SimRobotPublisher(const SimRobotParams& params, const hires::imagination::ImaginationSetup& setup,
                    const hires::sim_robot::SimRobotWorld& world, ros::NodeHandle* nh);

  /// What comes at 100 Hz: joints, odometry and inertial unit, then the clock, so that no node
  /// knows a time whose sensors are not on their way.
  void PublishFast(const hires::sim_robot::SimRobotWorld& world,
                   const hires::sim_robot::SensorReadings& readings);

  /// What comes with every tick of 0.05 s, before the fast ones of the same moment: transforms,
  /// localisation (of a robot that tells its place), laser, and detector and cameras when they are
  /// due. Called again, it publishes the same again.
  /// @return topics that have a message of this stamp, fast ones included.
  std::vector<std::string> PublishTick(const hires::sim_robot::SimRobotWorld& world,
                                       const hires::sim_robot::SensorReadings& readings,
                                       const hires::simulation::TruthRecord& truth);

  /// What comes between two ticks: scans of the laser that nods. For each look for falls.
  /// @param readings  of the last tick.
  void PublishLook(const hires::sim_robot::SimRobotWorld& world,
                   const hires::sim_robot::SensorReadings& readings);

  void PublishClock(const hires::sim_robot::SimRobotWorld& world);
  /// Where objects are recognised by another program in the clouds.
  bool sees_pictures() const { return sensors_.sees_pictures(); }
  long num_drawn() const { return cameras_.num_drawn(); }  ///< pictures; any thread may ask
  long num_recognised() const { return num_recognised_; }  ///< answers to them; likewise
  static ros::Time StampOf(
      const hires::sim_robot::SimRobotWorld& world);  ///< begins at 1 s; 0 means "no time yet"

 private:
  void PublishTransforms(const hires::sim_robot::SimRobotWorld& world,
                         const hires::sim_robot::SensorReadings& readings, const ros::Time& stamp);
  void PublishLocalisation(const hires::sim_robot::SensorReadings& readings,
                           const ros::Time& stamp);
  void PublishScan(const hires::sim_robot::SimRobotWorld& world,
                   const hires::sim_robot::SensorReadings& readings, const ros::Time& stamp);
  bool PublishLookOf(const hires::sim_robot::SimRobotWorld& world,
                     const hires::sim_robot::SensorReadings& readings, const ros::Time& stamp);
  void PublishTruth(const hires::sim_robot::SimRobotWorld& world,
                    const hires::simulation::TruthRecord& truth, const ros::Time& stamp);
  void PublishMap();

  const SimRobotParams params_;
  std::shared_ptr<const hires::simulation::Scene> scene_;
  hires::sim_robot::SimRobotSensors sensors_;
  SimRobotCameraPublisher cameras_;
  SimRobotLaserPublisher lasers_;
  SimRobotMotionPublisher motion_;
  ros::Publisher clock_, joints_, amcl_, scan_, detections_, map_, world_markers_, markers_,
      true_world_, true_robot_, truth_, tf_;
  ros::Subscriber recogniser_;  // its answers, where pictures are seen
  std::atomic<long> num_recognised_{0};
  TraceMarkers trace_;
};

}  // namespace hires_ros
