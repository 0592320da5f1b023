#include "hires/ros/transforms/transform_listener.h"

#include <fmt/format.h>

#include <utility>

#include "hires/ros/names/robot_topics.h"

namespace hires_ros {
namespace {

using hires::sensing::FramePose;
using hires::sensing::FrameStatus;

constexpr std::uint32_t kQueue = 6000;
constexpr double kJumpBack = 1.0;  // [s] by which time goes back where its clock began again

}  // namespace

TransformListener::TransformListener(ros::NodeHandle* nh, OnNews on_news)
    : on_news_(std::move(on_news)) {
  for (const bool are_static : {false, true}) {
    subscribers_.push_back(nh->subscribe<tf2_msgs::TFMessage>(
        are_static ? kStaticTransforms : kTransforms, kQueue,
        boost::function<void(const tf2_msgs::TFMessage&)>(
            [this, are_static](const tf2_msgs::TFMessage& msg) { Take(msg, are_static); }),
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }
}

void TransformListener::Take(const tf2_msgs::TFMessage& msg, bool are_static) {
  const ros::Time now = ros::Time::now();
  if ((now - now_).toSec() < -kJumpBack) tree_.ForgetMoving();
  now_ = now;
  on_news_(tree_.Take(msg, are_static));
}

Placement PlaceAt(const TransformBuffer& tree, const std::string& parent, const std::string& child,
                  double time) {
  const FramePose found = tree.Find(parent, child, time);
  if (found.is_found()) return {found.X_PC, "", ""};
  const std::string why = tree.WhyNot(parent, child, time);
  const auto newest = tree.NewestOf(parent, child);
  const bool is_too_old = found.status == FrameStatus::kNotThen && newest && *newest > time;
  if (is_too_old) return {std::nullopt, "", "older than what is kept of tf: " + why};
  if (found.status == FrameStatus::kInLoop) return {std::nullopt, "", why};
  return {std::nullopt, fmt::format("the transform of '{}' in '{}': {}", child, parent, why), ""};
}

}  // namespace hires_ros
