#include "nodes/hires/drive_bag.h"

#include <fmt/format.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/MultiEchoLaserScan.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/progress.h"
#include "hires/base/text.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/robot/scan_messages.h"
#include "hires/ros/transforms/transform_buffer.h"
#include "hires/ros/values/geometry_messages.h"
#include "nodes/hires/bag_file.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::robot::ScanReading;
using hires::sensing::DriveBuilder;
using hires::sensing::DriveSource;
using hires::sensing::UnitReading;
using Types = std::vector<std::string>;

const Types kScanTypes{"sensor_msgs/LaserScan", "sensor_msgs/MultiEchoLaserScan"};
const Types kOdometryTypes{"nav_msgs/Odometry"};
const Types kInertiaTypes{"sensor_msgs/Imu"};
const Types kTransformTypes{"tf2_msgs/TFMessage"};
constexpr char kTf[] = "/tf", kTfStatic[] = "/tf_static";
constexpr double kLeastTurn = 0.1;  // length of a quaternion that means something

bool IsOf(const Types& types, const BagTopic& topic) {
  return std::find(types.begin(), types.end(), topic.type) != types.end();
}

std::string FromRoot(const std::string& topic) {
  return topic.empty() || topic[0] == '/' ? topic : "/" + topic;
}

/// What of a bag may be meant by an option.
class Choice {
 public:
  Choice(const std::string& path, const std::vector<BagTopic>& topics, std::string option,
         Types types)
      : path_(path), topics_(topics), option_(std::move(option)), types_(std::move(types)) {
    for (const BagTopic& topic : topics_)
      if (IsOf(types_, topic) && topic.num_messages > 0) candidates_.push_back(topic);
  }

  /// The topic that was named, or the only one; "" if there is none.
  std::string Choose(const std::string& wanted) const {
    if (!wanted.empty()) return Named(FromRoot(wanted));
    std::set<std::string> names;
    for (const BagTopic& topic : candidates_) names.insert(topic.name);
    if (names.size() <= 1) return names.empty() ? "" : *names.begin();
    throw ConfigError(fmt::format("{}: {} topics could be meant; choose one with {}:{}", path_,
                                  names.size(), option_, Lines(candidates_)));
  }

  std::string types() const { return hires::base::Join(types_, " or "); }

 private:
  std::string Named(const std::string& wanted) const {
    std::vector<std::string> names;
    for (const BagTopic& topic : candidates_) {
      if (topic.name == wanted) return wanted;
      names.push_back(topic.name);
    }
    for (const BagTopic& topic : topics_) {
      if (topic.name != wanted) continue;
      throw ConfigError(fmt::format("{}: {} {}: has type {} and {} messages; wanted {}{}", path_,
                                    option_, wanted, topic.type, topic.num_messages, types(),
                                    Lines(candidates_)));
    }
    throw ConfigError(fmt::format("{}: {}: {}; {}", path_, option_,
                                  hires::base::UnknownName("topic", wanted, names),
                                  ListOfTopics(topics_)));
  }

  static std::string Lines(const std::vector<BagTopic>& topics) {
    std::string lines;
    for (const BagTopic& topic : topics)
      lines += fmt::format("\n  {} ({}, {} messages)", topic.name, topic.type, topic.num_messages);
    return lines;
  }

  const std::string& path_;
  const std::vector<BagTopic>& topics_;
  std::string option_;
  Types types_;
  std::vector<BagTopic> candidates_;
};

struct DriveTopics {
  std::string scan;
  std::string odometry;  ///< kTf: transforms tell it
  std::string imu;       ///< empty: none is used
};

DriveTopics TopicsOf(const std::string& path, const std::vector<BagTopic>& topics,
                     const DriveSource& source) {
  const Choice scan(path, topics, "--scan", kScanTypes);
  const Choice odometry(path, topics, "--odometry", kOdometryTypes);
  const bool has_tf = std::any_of(topics.begin(), topics.end(), [](const BagTopic& topic) {
    return topic.name == kTf && IsOf(kTransformTypes, topic) && topic.num_messages > 0;
  });
  DriveTopics chosen;
  chosen.scan = scan.Choose(source.scan);
  if (chosen.scan.empty()) {
    throw ConfigError(fmt::format("{}: has no scan: no topic of {} with messages; {}", path,
                                  scan.types(), ListOfTopics(topics)));
  }
  if (!source.imu.empty())
    chosen.imu = Choice(path, topics, "--imu", kInertiaTypes).Choose(source.imu);
  const bool is_tf_wanted = FromRoot(source.odometry) == kTf;
  if (!is_tf_wanted) chosen.odometry = odometry.Choose(source.odometry);
  if (!chosen.odometry.empty()) return chosen;
  if (has_tf) return {chosen.scan, kTf, chosen.imu};
  throw ConfigError(fmt::format(
      "{}: has no odometry: {} with messages; {}", path,
      is_tf_wanted ? "no topic /tf of tf2_msgs/TFMessage"
                   : "neither a topic of " + odometry.types() + " nor /tf of tf2_msgs/TFMessage",
      ListOfTopics(topics)));
}

bool IsRotation(const geometry_msgs::Quaternion& q) {
  return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w) > kLeastTurn;
}

/// Hands messages of a bag to the builder.
class DriveReader {
 public:
  DriveReader(const std::string& path, const DriveSource& source, const DriveTopics& topics)
      : path_(path), topics_(topics), builder_(path, source, topics.odometry == kTf, tree_) {}

  void Take(const rosbag::MessageInstance& message) {
    const std::string& topic = message.getTopic();
    if (topic == topics_.scan) return TakeScan(message);
    if (topic == topics_.imu) return TakeInertia(message);
    if (topic == kTf || topic == kTfStatic) return TakeTransforms(message, topic == kTfStatic);
    TakeOdometry(message);
  }
  DriveBuilder& builder() { return builder_; }

 private:
  void TakeScan(const rosbag::MessageInstance& message) {
    if (const auto scan = message.instantiate<sensor_msgs::LaserScan>()) {
      return builder_.OnScan(scan->header.stamp.toSec(), scan->header.frame_id,
                             ReadingSaidOf(*scan));
    }
    if (const auto scan = message.instantiate<sensor_msgs::MultiEchoLaserScan>()) {
      return builder_.OnScan(scan->header.stamp.toSec(), scan->header.frame_id,
                             ReadingSaidOf(NearestEchoesOf(*scan)));
    }
    builder_.LeaveOut("scans of another type, or of another version of it");
  }

  ScanReading ReadingSaidOf(const sensor_msgs::LaserScan& msg) {
    ScanReading reading = ReadingOf(msg);
    if (msg.angle_increment == 0.0F && reading.angle_increment != 0.0) {
      WarnOnce(
          "angle_increment of scans is 0: the angle between two beams is taken from angle_min, "
          "angle_max and the number of ranges");
    }
    return reading;
  }

  void TakeOdometry(const rosbag::MessageInstance& message) {
    const auto odometry = message.instantiate<nav_msgs::Odometry>();
    if (!odometry)
      return builder_.LeaveOut("readings of the odometry of another type, or version of it");
    if (!IsRotation(odometry->pose.pose.orientation))
      return builder_.LeaveOut("readings of the odometry whose quaternion turns nothing");
    builder_.OnOdometry(odometry->header.stamp.toSec(), odometry->child_frame_id,
                        FromMsg(*odometry));
  }

  /// What a unit does not measure has a covariance that begins with -1 (REP-145).
  void TakeInertia(const rosbag::MessageInstance& message) {
    const auto inertia = message.instantiate<sensor_msgs::Imu>();
    if (!inertia)
      return builder_.LeaveOut("readings of the inertial unit of another type, or version of it");
    const geometry_msgs::Vector3& rate = inertia->angular_velocity;
    UnitReading reading{{}, {rate.x, rate.y, rate.z}};
    const bool has_orientation = !(inertia->orientation_covariance[0] < 0.0);
    if (has_orientation && !IsRotation(inertia->orientation))
      return builder_.LeaveOut("readings of the inertial unit whose quaternion turns nothing");
    if (!has_orientation && inertia->angular_velocity_covariance[0] < 0.0)
      return builder_.LeaveOut("readings of the inertial unit without orientation and rate");
    if (has_orientation) {
      geometry_msgs::Pose pose;
      pose.orientation = inertia->orientation;
      reading.R_WI = FromMsg(pose).rotation;
    }
    builder_.OnInertia(inertia->header.stamp.toSec(), inertia->header.frame_id, reading);
  }

  /// A message may have a frame at several moments: each is told.
  void TakeTransforms(const rosbag::MessageInstance& message, bool are_static) {
    const auto transforms = message.instantiate<tf2_msgs::TFMessage>();
    if (!transforms)
      return builder_.LeaveOut("messages of transforms of another type, or version of it");
    tf2_msgs::TFMessage part;
    std::set<std::string> frames;
    for (const geometry_msgs::TransformStamped& transform : transforms->transforms) {
      if (!frames.insert(transform.child_frame_id).second) {
        TakePart(part, are_static);
        part.transforms.clear();
        frames = {transform.child_frame_id};
      }
      part.transforms.push_back(transform);
    }
    TakePart(part, are_static);
  }

  void TakePart(const tf2_msgs::TFMessage& part, bool are_static) {
    const TransformBuffer::News news = tree_.Take(part, are_static);
    for (std::size_t i = 0; i < news.warnings.size(); ++i)
      builder_.LeaveOut("transforms without frames, or with numbers that are none");
    for (const std::string& doubt : news.doubts) WarnOnce(doubt);
    builder_.OnTransforms();
  }

  void WarnOnce(const std::string& doubt) {
    if (doubts_.insert(doubt).second)
      hires::base::Log(hires::base::LogLevel::kWarn, path_ + ": " + doubt);
  }

  const std::string& path_;
  const DriveTopics topics_;
  TransformBuffer tree_;
  DriveBuilder builder_;
  std::set<std::string> doubts_;  // that were told
};

}  // namespace

hires::localisation::RobotLog ReadDriveBag(const std::string& path, const DriveSource& source) {
  hires::localisation::RobotLog log;
  ReadBag(path, [&] {
    rosbag::Bag bag;
    OpenBag(path, &bag);
    const DriveTopics topics = TopicsOf(path, TopicsOfBag(bag), source);
    DriveReader reader(path, source, topics);
    rosbag::View view(
        bag, rosbag::TopicQuery({topics.scan, topics.odometry, topics.imu, kTf, kTfStatic}));
    const double size = view.size();
    std::size_t count = 0;
    for (const rosbag::MessageInstance& message : view) {
      reader.Take(message);
      if (++count % 1000 == 0) hires::base::ReportProgress("reading " + path, count / size);
    }
    hires::base::ReportProgress("reading " + path, 1.0);
    log = reader.builder().Take();
  });
  return log;
}

}  // namespace hires_ros
