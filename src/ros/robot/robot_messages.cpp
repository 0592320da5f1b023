#include "hires/ros/robot/robot_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/ros/conversions.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::robot::JointTrajectory;
using hires::robot::TrajectoryPoint;

bool AllFinite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

void RequireJoints(const std::vector<std::string>& joints, const std::vector<std::string>& known,
                   const std::string& where) {
  if (joints.empty()) {
    throw ConfigError(where + ": names no joints; a trajectory moves at least one");
  }
  std::set<std::string> seen;
  for (const std::string& joint : joints) {
    if (std::find(known.begin(), known.end(), joint) == known.end()) {
      throw ConfigError(where + ": " + hires::base::UnknownName("joint", joint, known));
    }
    if (!seen.insert(joint).second) {
      throw ConfigError(fmt::format("{}: names joint '{}' twice; once is enough", where, joint));
    }
  }
}

TrajectoryPoint PointFrom(const trajectory_msgs::JointTrajectoryPoint& msg, std::size_t joints,
                          const std::string& where) {
  if (msg.positions.size() != joints) {
    throw ConfigError(
        fmt::format("{} has {} positions for {} joints", where, msg.positions.size(), joints));
  }
  if (!msg.velocities.empty() && msg.velocities.size() != joints) {
    throw ConfigError(fmt::format("{} has {} velocities for {} joints; give all or none", where,
                                  msg.velocities.size(), joints));
  }
  if (!AllFinite(msg.positions) || !AllFinite(msg.velocities)) {
    throw ConfigError(where + " has a number that is not finite");
  }
  return {msg.time_from_start.toSec(), msg.positions, msg.velocities};
}

/// [bytes] from the begin of a point.
std::uint32_t OffsetOf(const sensor_msgs::PointCloud2& msg, const std::string& name) {
  for (const sensor_msgs::PointField& field : msg.fields) {
    if (field.name != name) continue;
    if (field.datatype == sensor_msgs::PointField::FLOAT32 &&
        field.offset + sizeof(float) <= msg.point_step) {
      return field.offset;
    }
    throw hires::base::ConfigError(
        fmt::format("field '{}' has datatype {} at {} of {} bytes, wanted FLOAT32 ({}) within them",
                    name, field.datatype, field.offset, msg.point_step,
                    static_cast<int>(sensor_msgs::PointField::FLOAT32)));
  }
  throw hires::base::ConfigError(fmt::format("field '{}' is missing", name));
}

}  // namespace

geometry_msgs::Twist ToMsg(const hires::geometry::Twist2& V_B) {
  geometry_msgs::Twist out;
  out.linear.x = V_B.vx;
  out.linear.y = V_B.vy;
  out.angular.z = V_B.wz;
  return out;
}

hires::geometry::Twist2 FromMsg(const geometry_msgs::Twist& twist, const std::string& where) {
  if (!AllFinite({twist.linear.x, twist.linear.y, twist.angular.z})) {
    throw ConfigError(where + ": linear.x, linear.y or angular.z is not finite; give numbers");
  }
  return {twist.linear.x, twist.linear.y, twist.angular.z};
}

trajectory_msgs::JointTrajectory ToMsg(const JointTrajectory& trajectory) {
  trajectory_msgs::JointTrajectory out;
  out.joint_names = trajectory.joints;
  for (const TrajectoryPoint& point : trajectory.points) {
    trajectory_msgs::JointTrajectoryPoint p;
    p.time_from_start = ros::Duration(point.time);
    p.positions = point.positions;
    p.velocities = point.velocities;
    out.points.push_back(std::move(p));
  }
  return out;
}

JointTrajectory FromMsg(const trajectory_msgs::JointTrajectory& msg,
                        const std::vector<std::string>& known, const std::string& where) {
  RequireJoints(msg.joint_names, known, where);
  if (msg.points.empty()) throw ConfigError(where + ": has no points; one is the least");
  JointTrajectory out{msg.joint_names, {}};
  for (std::size_t i = 0; i < msg.points.size(); ++i) {
    const std::string point = fmt::format("{}: point {}", where, i);
    out.points.push_back(PointFrom(msg.points[i], msg.joint_names.size(), point));
    const double earliest = i == 0 ? 0.0 : out.points[i - 1].time;
    if (out.points[i].time < earliest || (i > 0 && out.points[i].time == earliest)) {
      throw ConfigError(fmt::format("{} comes at {:g} s, wanted after {:g} s; times ascend", point,
                                    out.points[i].time, earliest));
    }
  }
  return out;
}

hires::robot::JointReading FromMsg(const sensor_msgs::JointState& msg) {
  hires::robot::JointReading out;
  for (std::size_t i = 0; i < msg.name.size(); ++i) {
    if (i < msg.position.size()) out.positions[msg.name[i]] = msg.position[i];
    if (i < msg.velocity.size()) out.velocities[msg.name[i]] = msg.velocity[i];
  }
  return out;
}

sensor_msgs::JointState ToMsg(const hires::robot::JointReading& joints, const ros::Time& stamp) {
  sensor_msgs::JointState out;
  out.header.stamp = stamp;
  for (const auto& [name, position] : joints.positions) {
    out.name.push_back(name);
    out.position.push_back(position);
    const auto velocity = joints.velocities.find(name);
    out.velocity.push_back(velocity == joints.velocities.end() ? 0.0 : velocity->second);
  }
  return out;
}

hires::robot::OdometryReading FromMsg(const nav_msgs::Odometry& msg) {
  const geometry_msgs::Twist& twist = msg.twist.twist;
  return {hires::geometry::Flatten(FromMsg(msg.pose.pose)),
          {twist.linear.x, twist.linear.y, twist.angular.z}};
}

hires::perception::PointCloud FromMsg(const sensor_msgs::PointCloud2& msg) {
  const std::array<std::uint32_t, 3> offsets{OffsetOf(msg, "x"), OffsetOf(msg, "y"),
                                             OffsetOf(msg, "z")};
  const std::uint64_t row = std::uint64_t{msg.width} * msg.point_step;
  if (msg.is_bigendian || msg.row_step < row ||
      msg.data.size() < std::uint64_t{msg.row_step} * msg.height) {
    throw hires::base::ConfigError(
        fmt::format("{} bytes of {} x {} points, point_step {}, row_step {}{}: wanted row_step to "
                    "hold width * point_step, data to hold height * row_step, little-endian",
                    msg.data.size(), msg.width, msg.height, msg.point_step, msg.row_step,
                    msg.is_bigendian ? ", big-endian" : ""));
  }
  hires::perception::PointCloud cloud{
      static_cast<int>(msg.width), static_cast<int>(msg.height), {}};
  cloud.points.resize(std::size_t{msg.width} * msg.height);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::uint8_t* point =
        msg.data.data() + i / msg.width * msg.row_step + i % msg.width * msg.point_step;
    for (int axis = 0; axis < 3; ++axis) {
      std::memcpy(&cloud.points[i][axis], point + offsets[axis], sizeof(float));
    }
  }
  return cloud;
}

hires::perception::Detection FromMsg(const hires::Detection& msg) {
  hires::perception::Detection out;
  if (!msg.instance.empty()) out.instance = msg.instance;
  out.label = msg.label;
  out.X_CO = FromMsg(msg.pose);
  out.visible_share = msg.visible_share;
  out.category = msg.category;
  out.confidence = msg.confidence == 0.0f ? 1.0 : msg.confidence;
  for (const hires::LabelConfidence& other : msg.alternatives) {
    out.alternatives.push_back({other.label, other.confidence});
  }
  out.size = {msg.size.x, msg.size.y, msg.size.z};
  out.num_points = static_cast<int>(msg.num_points);
  return out;
}

hires::Detection ToMsg(const hires::perception::Detection& detection) {
  hires::Detection out;
  out.instance = detection.instance.value_or("");
  out.label = detection.label;
  out.pose = ToMsg(detection.X_CO);
  out.visible_share = static_cast<float>(detection.visible_share);
  out.category = detection.category;
  out.confidence = static_cast<float>(detection.confidence);
  for (const hires::perception::LabelConfidence& other : detection.alternatives) {
    out.alternatives.emplace_back();
    out.alternatives.back().label = other.label;
    out.alternatives.back().confidence = static_cast<float>(other.confidence);
  }
  out.size.x = detection.size.x();
  out.size.y = detection.size.y();
  out.size.z = detection.size.z();
  out.num_points = static_cast<std::uint32_t>(detection.num_points);
  return out;
}

std::optional<hires::perception::Sighting> FromMsg(const hires::Detections& msg) {
  if (msg.is_blind) return std::nullopt;
  hires::perception::Sighting seen;
  for (const hires::Detection& detection : msg.detections)
    seen.detections.push_back(FromMsg(detection));
  for (const geometry_msgs::Point& corner : msg.table)
    seen.table.emplace_back(corner.x, corner.y, corner.z);
  return seen;
}

hires::Detections ToMsg(const std::optional<hires::perception::Sighting>& seen,
                        const std_msgs::Header& header) {
  hires::Detections out;
  out.header = header;
  out.is_blind = !seen;
  if (!seen) return out;
  for (const hires::perception::Detection& detection : seen->detections)
    out.detections.push_back(ToMsg(detection));
  for (const Eigen::Vector3d& corner : seen->table) {
    out.table.emplace_back();
    out.table.back().x = corner.x();
    out.table.back().y = corner.y();
    out.table.back().z = corner.z();
  }
  return out;
}

std::vector<geometry_msgs::TransformStamped> LinkTransforms(
    const hires::robot::Robot& robot, const hires::robot::JointPositions& joints,
    const ros::Time& stamp) {
  const auto& model = robot.model;
  const auto X_RL = hires::robot::ForwardKinematics(model, joints);
  std::vector<geometry_msgs::TransformStamped> links;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto& joint = model.links[i].joint;
    // What hangs below the base's link; that itself stands in the map.
    if (!joint || model.links[i].name == robot.profile.base_link) continue;
    links.push_back(MakeTransform(model.links[joint->parent].name, model.links[i].name,
                                  X_RL[joint->parent].Inverse() * X_RL[i], stamp));
  }
  return links;
}

geometry_msgs::TransformStamped MakeTransform(const std::string& parent, const std::string& child,
                                              const hires::geometry::Pose3& X_PC,
                                              const ros::Time& stamp) {
  geometry_msgs::TransformStamped out;
  out.header.frame_id = parent;
  out.header.stamp = stamp;
  out.child_frame_id = child;
  const geometry_msgs::Pose pose = ToMsg(X_PC);
  out.transform.translation.x = pose.position.x;
  out.transform.translation.y = pose.position.y;
  out.transform.translation.z = pose.position.z;
  out.transform.rotation = pose.orientation;
  return out;
}

}  // namespace hires_ros
