#include "hires/ros/odometry_frame.h"

#include <cmath>

#include "hires/ros/conversions.h"

namespace hires_ros {
namespace {

constexpr double kHistory = 1.0;  // [s] that a filter may be late
constexpr double kNear = 0.1;     // [s] between a transform and the reading it is compared with

}  // namespace

std::string BareFrame(const std::string& frame) {
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

std::optional<hires::geometry::Pose2> PoseBetween(const geometry_msgs::TransformStamped& transform,
                                                  const std::string& parent,
                                                  const std::string& child) {
  if (BareFrame(transform.header.frame_id) != parent) return std::nullopt;
  if (BareFrame(transform.child_frame_id) != child) return std::nullopt;
  geometry_msgs::Pose pose;
  pose.position.x = transform.transform.translation.x;
  pose.position.y = transform.transform.translation.y;
  pose.orientation = transform.transform.rotation;
  const hires::geometry::Pose3 X_PC = FromMsg(pose);
  if (!X_PC.IsFinite()) return std::nullopt;
  return hires::geometry::Flatten(X_PC);
}

void OdometryFrame::OnTransform(double stamp, const hires::geometry::Pose2& X_OB) {
  told_ = {stamp, X_OB};
  Align();
}

std::optional<OdometryReading> OdometryFrame::Take(double stamp, const std::string& frame_id,
                                                   const OdometryReading& raw) {
  if (BareFrame(frame_id) == frame_) return raw;
  // A clock that began anew makes all older stamps worthless.
  if (!raw_.empty() && stamp < raw_.back().stamp - kHistory) raw_.clear();
  raw_.push_back({stamp, raw.X_OB});
  while (raw_.front().stamp < stamp - kHistory) raw_.pop_front();
  Align();
  if (!X_OR_) return std::nullopt;
  return OdometryReading{*X_OR_ * raw.X_OB, raw.V_B};
}

/// Where the wheels' frame is, from both words about one moment.
void OdometryFrame::Align() {
  if (!told_) return;
  const Raw* nearest = nullptr;
  for (const Raw& raw : raw_) {
    if (nearest == nullptr ||
        std::abs(raw.stamp - told_->first) < std::abs(nearest->stamp - told_->first)) {
      nearest = &raw;
    }
  }
  if (nearest == nullptr || std::abs(nearest->stamp - told_->first) > kNear) return;
  X_OR_ = told_->second * nearest->X_RB.Inverse();
  // A later reading may be nearer to it still.
  if (raw_.back().stamp >= told_->first) told_.reset();
}

}  // namespace hires_ros
