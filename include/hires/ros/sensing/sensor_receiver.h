#pragma once

#include <hires/Detections.h>
#include <hires/ObjectTemperatures.h>
#include <hires/WorldState.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/topic_warnings.h"
#include "hires/control/robot_names.h"
#include "hires/ros/transforms/transform_buffer.h"
#include "hires/sensing/object_estimator.h"
#include "hires/sensing/robot_state_estimator.h"
#include "hires/sensing/sensing_params.h"

namespace hires_ros {

/// Hands what a robot's sensors say to the estimators of its state and of objects: conversion
/// alone, for the middle layer and the tracker alike. What is wrong with a message becomes one
/// warning a second for each topic. Frames may be any that tf connects with the robot.
class SensorReceiver {
 public:
  /// @param surroundings  what the camera looks at; null: the robot sees no objects.
  SensorReceiver(std::shared_ptr<const hires::robot::Robot> robot,
                 std::shared_ptr<const hires::perception::Surroundings> surroundings,
                 const hires::control::RobotNames& names,
                 const hires::sensing::SensingParams& params);
  SensorReceiver(const SensorReceiver&) = delete;

  void OnOdometry(const nav_msgs::Odometry& msg);
  void OnJoints(const sensor_msgs::JointState& msg);
  void OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static);
  void OnDetections(const hires::Detections& msg);
  void OnTrayScan(const sensor_msgs::LaserScan& msg);
  /// [degrees Celsius] by object, of those that are sure; the others are left out, and warned of
  /// where they are wrong.
  std::map<std::string, double> TemperaturesOf(const hires::ObjectTemperatures& msg);
  /// What another node remembers; taken into account with the next Update.
  void OnKnownObjects(const hires::WorldState& msg);

  /// Objects as they are known at this moment; warns of looks that were dropped.
  hires::sensing::LookNews Update(const hires::sensing::RobotEstimate& now);
  void Warn(const std::string& topic, const std::string& text);
  /// Warns of a message that is not used, and counts it.
  void Refuse(const std::string& topic, const std::string& why);

  const hires::sensing::RobotStateEstimator& state() const { return state_; }
  /// Null if the robot sees no objects.
  hires::sensing::ObjectEstimator* objects() const { return objects_.get(); }
  /// What has not come, by the names of topics and frames; empty: nothing is missing.
  std::string NameOf(hires::sensing::Missing missing) const;
  int num_bad() const { return num_bad_; }  ///< messages, or parts of them

 private:
  void Note(const std::string& topic, const hires::sensing::Receipt& receipt);
  void TakeStated(const hires::sensing::RobotEstimate& now);

  hires::control::RobotNames names_;
  std::shared_ptr<TransformBuffer> tree_;
  hires::sensing::RobotStateEstimator state_;
  std::unique_ptr<hires::sensing::ObjectEstimator> objects_;
  std::unique_ptr<hires::WorldState> stated_;  // by another node, not taken into account yet
  hires::base::TopicWarnings warnings_;
  int num_bad_{0};
};

}  // namespace hires_ros
