#pragma once

#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hires/ros/transforms/transform_buffer.h"

namespace hires_ros {

/// Hears /tf and /tf_static for a node that asks where frames are at the stamps of its messages.
/// Where ROS time goes back by more than a second, as where a bag begins again, what moves is
/// forgotten.
class TransformListener {
 public:
  using OnNews = std::function<void(const TransformBuffer::News&)>;

  /// @param on_news  called after each message.
  TransformListener(ros::NodeHandle* nh, OnNews on_news);
  TransformListener(const TransformListener&) = delete;

  const TransformBuffer& tree() const { return tree_; }

 private:
  void Take(const tf2_msgs::TFMessage& msg, bool are_static);

  TransformBuffer tree_;
  OnNews on_news_;
  ros::Time now_;
  std::vector<ros::Subscriber> subscribers_;
};

/// Where a frame is at a stamp; if that is not known, why not: one of the three is there.
struct Placement {
  std::optional<hires::geometry::Pose3> X_PC;
  std::string waits_for;  ///< it may still come
  std::string why_never;  ///< it will not come
};
/// @param time  [s]
Placement PlaceAt(const TransformBuffer& tree, const std::string& parent, const std::string& child,
                  double time);

}  // namespace hires_ros
