#include "hires/ros/transforms/transform_buffer.h"

#include <fmt/format.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose3;
using hires::sensing::BareFrame;
using hires::sensing::FramePose;
using hires::sensing::FrameStatus;

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kSameStamp = 1e-6;  // [s]
constexpr double kUnitSlack = 1e-3;  // of a quaternion's length, as tf2 has it

/// The moment that is meant, where seconds since 1970 round it by some 1e-7 s; time 0 asks for the
/// newest, and of frames that never move any time is as good.
ros::Time TimeOf(double time, std::optional<double> newest) {
  const bool is_newest = newest && std::abs(time - *newest) < kSameStamp;
  return std::isfinite(time) && !is_newest ? ros::Time(time) : ros::Time(0);
}

std::string WhyUnsound(const geometry_msgs::TransformStamped& msg) {
  const auto& p = msg.transform.translation;
  const auto& q = msg.transform.rotation;
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (BareFrame(msg.child_frame_id).empty() || BareFrame(msg.header.frame_id).empty()) {
    return "frame_id or child_frame_id is empty";
  }
  if (!std::isfinite(p.x + p.y + p.z + length)) return "it is not finite, wanted numbers";
  if (std::abs(length - 1.0) > kUnitSlack) {
    return fmt::format("its quaternion has length {:.3g}, wanted 1", length);
  }
  return "";
}

}  // namespace

TransformBuffer::News TransformBuffer::Take(const tf2_msgs::TFMessage& msg, bool are_static) {
  News news;
  for (const geometry_msgs::TransformStamped& transform : msg.transforms) {
    const std::string why = WhyUnsound(transform);
    if (!why.empty()) {
      news.warnings.push_back(fmt::format("transform '{}' -> '{}': {}", transform.header.frame_id,
                                          transform.child_frame_id, why));
      continue;
    }
    if (!are_static && IsRepeated(transform)) continue;
    const std::string torn_apart = WhyTornApart(transform);
    if (!torn_apart.empty()) news.doubts.push_back(torn_apart);
    if (!buffer_.setTransform(transform, "", are_static)) continue;  // too old
    const double stamp = are_static ? kForever : transform.header.stamp.toSec();
    const bool is_new =
        std::find(news.stamps.begin(), news.stamps.end(), stamp) == news.stamps.end();
    if (is_new) news.stamps.push_back(stamp);
  }
  return news;
}

/// tf2 prints a warning of two lines for each that comes twice.
bool TransformBuffer::IsRepeated(const geometry_msgs::TransformStamped& msg) {
  const auto [newest, is_first] = newest_.emplace(msg.child_frame_id, msg.header.stamp);
  if (is_first) return false;
  return std::exchange(newest->second, msg.header.stamp) == msg.header.stamp;
}

/// A frame may be hung elsewhere once, as what is taken up by a hand; one that is hung back has two
/// publishers.
std::string TransformBuffer::WhyTornApart(const geometry_msgs::TransformStamped& msg) {
  const std::string child = BareFrame(msg.child_frame_id), parent = BareFrame(msg.header.frame_id);
  const std::string before = ParentOf(child);
  if (before.empty() || before == parent) return "";
  std::set<std::string>& left = left_[child];
  left.insert(before);
  if (left.count(parent) == 0) return "";
  return fmt::format(
      "frame '{}' hangs below '{}' and below '{}' by turns: two nodes publish it; end one of them",
      child, before, parent);
}

/// Nothing for one that is unknown or at the top.
std::string TransformBuffer::ParentOf(const std::string& frame) const {
  std::string parent;
  if (IsKnown(frame)) buffer_._getParent(frame, ros::Time(0), parent);
  return parent;
}

/// The frame and those above it: "base < odom < map".
std::string TransformBuffer::LineOf(const std::string& frame) const {
  std::string line = frame;
  std::set<std::string> seen{frame};
  for (std::string above = ParentOf(frame); !above.empty(); above = ParentOf(above)) {
    line += " < " + above;
    if (!seen.insert(above).second) break;
  }
  return line;
}

std::string TransformBuffer::WhyNot(const std::string& parent, const std::string& child,
                                    double time) const {
  const auto newest = NewestOf(parent, child);
  switch (Find(parent, child, time).status) {
    case FrameStatus::kFound:
      return "";
    case FrameStatus::kUnknown:
      return fmt::format("tf does not know frame '{}'", IsKnown(parent) ? child : parent);
    case FrameStatus::kNotThen:
      return fmt::format("tf knows where '{}' is in '{}', but not at {:.3f} s{}", child, parent,
                         time, newest ? fmt::format("; its newest is of {:.3f} s", *newest) : "");
    case FrameStatus::kInLoop:
      return fmt::format("the transforms above '{}' or '{}' lead in a circle ({}; {})", child,
                         parent, LineOf(child), LineOf(parent));
    case FrameStatus::kNotConnected:
      break;
  }
  return fmt::format("tf does not connect '{}' with '{}' (it knows {}; {})", child, parent,
                     LineOf(child), LineOf(parent));
}

std::vector<std::string> TransformBuffer::Names() const {
  std::vector<std::string> names;
  buffer_._getFrameStrings(names);
  return names;
}

bool TransformBuffer::IsKnown(const std::string& frame) const {
  return !frame.empty() && buffer_._frameExists(frame);
}

FramePose TransformBuffer::Find(const std::string& parent, const std::string& child,
                                double time) const {
  if (!IsKnown(parent) || !IsKnown(child)) return {FrameStatus::kUnknown, {}};
  try {
    const ros::Time moment = TimeOf(time, NewestOf(parent, child));
    const auto found = buffer_.lookupTransform(parent, child, moment).transform;
    geometry_msgs::Pose pose;
    pose.position.x = found.translation.x;
    pose.position.y = found.translation.y;
    pose.position.z = found.translation.z;
    pose.orientation = found.rotation;
    return {FrameStatus::kFound, FromMsg(pose)};
  } catch (const tf2::ExtrapolationException&) {
    return {FrameStatus::kNotThen, {}};
  } catch (const tf2::LookupException&) {  // both are known, but a walk up does not end
    return {FrameStatus::kInLoop, {}};
  } catch (const tf2::TransformException&) {
    return {FrameStatus::kNotConnected, {}};
  }
}

std::optional<double> TransformBuffer::NewestOf(const std::string& parent,
                                                const std::string& child) const {
  if (!IsKnown(parent) || !IsKnown(child)) return std::nullopt;
  ros::Time newest;
  const int error = buffer_._getLatestCommonTime(
      buffer_._lookupFrameNumber(parent), buffer_._lookupFrameNumber(child), newest, nullptr);
  if (error != 0) return std::nullopt;
  return newest.isZero() ? kForever : newest.toSec();
}

void TransformBuffer::ForgetMoving() {
  buffer_.clear();
  newest_.clear();
  left_.clear();
}

}  // namespace hires_ros
