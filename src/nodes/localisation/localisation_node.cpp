#include "nodes/localisation/localisation_node.h"

#include <fmt/format.h>
#include <geometry_msgs/PoseArray.h>
#include <nav_msgs/GetMap.h>
#include <ros/service.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/localisation/laser_mount.h"
#include "hires/ros/conversions.h"
#include "hires/ros/place/map_messages.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"

namespace hires_ros {
namespace {

namespace localisation = hires::localisation;
using hires::base::ConfigError;
using hires::base::LogLevel;
using localisation::LocalisationStatus;
using localisation::ScanOutcome;

constexpr char kInitialPose[] = "initialpose";
constexpr char kAmclPose[] = "amcl_pose";
constexpr double kPatience = 5.0;          // [s] for a latched map, before static_map is asked
constexpr std::size_t kMostWaiting = 100;  // scans: 2.5 s at 40 Hz

hires::robot::ScanReading FromMsg(const sensor_msgs::LaserScan& msg) {
  return {msg.angle_min, msg.angle_increment, msg.range_min, msg.ranges, msg.range_max};
}

/// @pre outcome is bad
std::string WhyBad(ScanOutcome outcome, const sensor_msgs::LaserScan& scan) {
  const std::string name = localisation::ToString(outcome);
  if (outcome == ScanOutcome::kTimeWentBack || outcome == ScanOutcome::kOdometryJumped) {
    return name + ": it goes on from this odometry, and keeps what it believes";
  }
  return fmt::format("{}: {} ranges, angle_min {:g}, angle_increment {:g} rad, {:g} to {:g} m",
                     name, scan.ranges.size(), scan.angle_min, scan.angle_increment, scan.range_min,
                     scan.range_max);
}

geometry_msgs::PoseArray ToMsg(const std::vector<hires::geometry::Pose2>& poses,
                               const std_msgs::Header& header) {
  geometry_msgs::PoseArray msg;
  msg.header = header;
  msg.poses.reserve(poses.size());
  for (const hires::geometry::Pose2& pose : poses)
    msg.poses.push_back(hires_ros::ToMsg(hires::geometry::Lift(pose)));
  return msg;
}

}  // namespace

std::string LocalisationNode::Mount::waits_for() const {
  return X_OB.waits_for.empty() ? X_BL.waits_for : X_OB.waits_for;
}

std::string LocalisationNode::Mount::why_never() const {
  return X_OB.why_never.empty() ? X_BL.why_never : X_OB.why_never;
}

LocalisationNode::LocalisationNode(const LocalisationNodeParams& params, ros::NodeHandle* nh)
    : params_(params),
      nh_(*nh),
      transforms_(nh, [this](const TransformBuffer::News& news) { OnTransforms(news); }),
      begun_(hires::base::SteadyNow()) {
  const std::string& told = params.names.localisation;
  pose_ = nh->advertise<geometry_msgs::PoseWithCovarianceStamped>(told.empty() ? kAmclPose : told,
                                                                  2, true);
  particles_ = nh->advertise<geometry_msgs::PoseArray>("particlecloud", 2);
  if (params.config.node.tf_broadcast)
    transform_ = nh->advertise<tf2_msgs::TFMessage>(kTransforms, 100);
  Listen(nh);
  updater_.setHardwareID("localisation");
  updater_.add("localisation", this, &LocalisationNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) {
    if (!map_ && hires::base::SteadyNow() - begun_ > kPatience) AskForMap();
    DropUseless();            // what waits grows old, also where nothing comes
    updater_.force_update();  // also while simulated time stands still
  });
}

void LocalisationNode::Listen(ros::NodeHandle* nh) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  inputs_.push_back(nh->subscribe(params_.names.map, 1, &LocalisationNode::OnMap, this, hints));
  inputs_.push_back(nh->subscribe(kInitialPose, 10, &LocalisationNode::OnInitialPose, this, hints));
  inputs_.push_back(
      nh->subscribe(params_.names.base_scan, kMostWaiting, &LocalisationNode::OnScan, this, hints));
  services_.push_back(
      nh->advertiseService("global_localization", &LocalisationNode::OnGlobalLocalisation, this));
  services_.push_back(
      nh->advertiseService("request_nomotion_update", &LocalisationNode::OnNoMotionUpdate, this));
}

void LocalisationNode::OnMap(const nav_msgs::OccupancyGrid& msg) {
  const std::string& topic = params_.names.map;
  const std::string frame = hires::sensing::BareFrame(msg.header.frame_id);
  if (frame != params_.names.map_frame) {
    return Refuse(topic, fmt::format("header.frame_id is '{}', wanted '{}'", msg.header.frame_id,
                                     params_.names.map_frame));
  }
  // A map server that starts again says the same.
  if (map_ && map_->info.resolution == msg.info.resolution && map_->info.width == msg.info.width &&
      map_->info.origin == msg.info.origin && map_->data == msg.data) {
    return;
  }
  try {
    const hires::world::OccupancyGrid map = hires_ros::FromMsg(msg);
    const std::string why = localisation::WhyUseless(map);
    if (!why.empty()) return Refuse(topic, why);
    BeginWith(map);
    map_ = msg;
  } catch (const ConfigError& error) {
    return Refuse(topic, error.what());
  }
  Try(true);
}

/// In another map than before it goes on from where it was.
/// @throws ConfigError  where its resolution is too fine for the likelihood field
void LocalisationNode::BeginWith(const hires::world::OccupancyGrid& map) {
  std::optional<UncertainPose> before = std::exchange(told_, std::nullopt);
  if (filter_ && is_updated_) {
    const auto estimate = filter_->Estimate(0.0);
    before = UncertainPose{estimate.X_MB, estimate.covariance};
  }
  filter_.emplace(map, params_.config.filter, hires::base::Rng(params_.seed));
  is_updated_ = false;
  hires::base::Log(LogLevel::kInfo, fmt::format("map=used width={} height={} resolution={:g}",
                                                map.width, map.height, map.resolution));
  if (before) SetPose(*before);
}

void LocalisationNode::AskForMap() {
  if (params_.names.static_map.empty()) return;
  nav_msgs::GetMap call;
  const std::string service = nh_.resolveName(params_.names.static_map);
  // First a probe: see ServiceLinks.
  if (ros::service::exists(service, false) && ros::service::call(service, call))
    OnMap(call.response.map);
}

void LocalisationNode::OnInitialPose(const geometry_msgs::PoseWithCovarianceStamped& msg) {
  const std::string frame = hires::sensing::BareFrame(msg.header.frame_id);
  if (frame != params_.names.map_frame) {
    return Refuse(kInitialPose, fmt::format("header.frame_id is '{}', wanted '{}'",
                                            msg.header.frame_id, params_.names.map_frame));
  }
  try {
    const UncertainPose pose = hires_ros::FromMsg(msg.pose);
    if (filter_) {
      SetPose(pose);
    } else {
      told_ = pose;
    }
  } catch (const ConfigError& error) {
    Refuse(kInitialPose, error.what());
  }
}

void LocalisationNode::SetPose(const UncertainPose& pose) {
  filter_->SetPose(pose.X_AB, pose.covariance);
  hires::base::Log(LogLevel::kInfo, fmt::format("pose=set x={:.3f} y={:.3f} yaw={:.3f}",
                                                pose.X_AB.x, pose.X_AB.y, pose.X_AB.yaw));
}

bool LocalisationNode::OnGlobalLocalisation(Empty::Request&, Empty::Response&) {
  if (!filter_) {
    Refuse("global_localization", "there is no map yet, wanted one on " + params_.names.map);
    return false;
  }
  filter_->GlobalLocalisation();
  return true;
}

bool LocalisationNode::OnNoMotionUpdate(Empty::Request&, Empty::Response&) {
  if (!filter_) {
    Refuse("request_nomotion_update", "there is no map yet, wanted one on " + params_.names.map);
    return false;
  }
  filter_->UseNextScan();
  return true;
}

void LocalisationNode::OnTransforms(const TransformBuffer::News& news) {
  for (const std::string& warning : news.warnings) Refuse(kTransforms, warning);
  for (const std::string& doubt : news.doubts) warnings_.Tell(kTransforms, "doubtful", doubt);
  Try(false);
}

void LocalisationNode::OnScan(const sensor_msgs::LaserScanConstPtr& msg) {
  ++num_scans_;
  const std::string why = WhyMalformed(msg->header);
  if (!why.empty()) return Refuse(params_.names.base_scan, why);
  waiting_.push_back(msg);
  DropUseless();
  Try(true);
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  Refuse(params_.names.base_scan,
         fmt::format("{} newer scans wait as well, for {}", kMostWaiting, waits_for_));
}

std::string LocalisationNode::WhyMalformed(const std_msgs::Header& header) const {
  if (header.stamp.isZero()) return "header.stamp is 0, wanted the scan's time";
  if (hires::sensing::BareFrame(header.frame_id).empty())
    return "header.frame_id is empty, wanted the laser's frame";
  return "";
}

std::string LocalisationNode::WhyUntimely(const ros::Time& stamp) const {
  const localisation::LiveScanParams& limits = params_.config.node;
  const double age = (ros::Time::now() - stamp).toSec();
  if (age < -limits.max_ahead) {
    return fmt::format(
        "its stamp lies {:.1f} s in the future, wanted {:g} at most; synchronise the clocks of the "
        "computers",
        -age, limits.max_ahead);
  }
  if (age <= limits.max_age) return "";
  if (waits_for_.empty()) {
    return fmt::format(
        "it is {:.1f} s old, wanted {:g} at most; play bags with --clock and "
        "use_sim_time",
        age, limits.max_age);
  }
  return fmt::format("it waited until it was {:.1f} s old for {}", age, waits_for_);
}

LocalisationNode::Mount LocalisationNode::MountOf(const sensor_msgs::LaserScan& scan) const {
  const hires::control::RobotNames& names = params_.names;
  const TransformBuffer& tree = transforms_.tree();
  const double time = scan.header.stamp.toSec();
  return {PlaceAt(tree, names.odometry_frame, names.base_frame, time),
          PlaceAt(tree, names.base_frame, hires::sensing::BareFrame(scan.header.frame_id), time)};
}

void LocalisationNode::Try(bool are_all_tried) {
  if (waiting_.empty()) return;
  if (ros::Time::now().isZero()) {
    waits_for_ = "the time on /clock";
    return;
  }
  if (!filter_) {
    waits_for_ = "a map on " + nh_.resolveName(params_.names.map);
    return;
  }
  for (std::size_t i = 0; i < waiting_.size();) {
    const Mount mount = MountOf(*waiting_[i]);
    if (!mount.is_known()) {
      if (i == 0) waits_for_ = mount.waits_for();
      if (!are_all_tried) return;
      ++i;
      continue;
    }
    // What is known of a later scan will not become known of an earlier one.
    for (; i > 0; --i) {
      const Mount earlier = MountOf(*waiting_.front());
      waiting_.pop_front();
      Refuse(params_.names.base_scan, "tf knows all of a later scan already, but of this one not " +
                                          earlier.waits_for() + earlier.why_never());
    }
    const sensor_msgs::LaserScanConstPtr scan = waiting_.front();
    waiting_.pop_front();
    waits_for_.clear();
    Use(*scan, mount);
  }
}

/// Those that can no longer be used, whatever comes.
void LocalisationNode::DropUseless() {
  if (ros::Time::now().isZero()) return;
  for (auto scan = waiting_.begin(); scan != waiting_.end();) {
    std::string why = WhyUntimely((*scan)->header.stamp);
    if (why.empty()) why = MountOf(**scan).why_never();
    if (why.empty()) {
      ++scan;
      continue;
    }
    scan = waiting_.erase(scan);
    Refuse(params_.names.base_scan, why);
  }
  if (waiting_.empty()) waits_for_.clear();
}

void LocalisationNode::Use(const sensor_msgs::LaserScan& scan, const Mount& mount) {
  hires::robot::ScanReading reading = FromMsg(scan);
  const auto X_BL = localisation::LevelLaser(*mount.X_BL.X_PC, &reading);
  if (!X_BL) {
    return Refuse(
        params_.names.base_scan,
        fmt::format("its laser '{}' is tilted by {:.2f} rad in '{}', wanted a level one, "
                    "or one upside down, within {:g} rad",
                    scan.header.frame_id, hires::geometry::TiltOf(mount.X_BL.X_PC->rotation),
                    params_.names.base_frame, localisation::kMostLaserTilt));
  }
  const ScanOutcome outcome = filter_->Update(
      scan.header.stamp.toSec(), hires::geometry::Flatten(*mount.X_OB.X_PC), reading, *X_BL);
  ++num_outcomes_[localisation::ToString(outcome)];
  if (localisation::IsBad(outcome)) Refuse(params_.names.base_scan, WhyBad(outcome, scan));
  const bool is_new = outcome == ScanOutcome::kUpdated;
  is_updated_ = is_updated_ || is_new;
  // The odometry goes on below the map, also where the laser sees nothing.
  if (is_updated_ && outcome != ScanOutcome::kNotFinite) Publish(scan.header.stamp, is_new);
}

void LocalisationNode::Publish(const ros::Time& stamp, bool is_new) {
  const hires::control::RobotNames& names = params_.names;
  if (transform_) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(
        names.map_frame, names.odometry_frame, hires::geometry::Lift(filter_->CorrectedOdometry()),
        stamp + ros::Duration(params_.config.node.transform_tolerance)));
    transform_.publish(msg);
  }
  if (!is_new) return;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = names.map_frame;
  const auto estimate = filter_->Estimate(stamp.toSec());
  pose_.publish(hires_ros::ToMsg(UncertainPose{estimate.X_MB, estimate.covariance}, header));
  if (particles_.getNumSubscribers() > 0)
    particles_.publish(ToMsg(filter_->ParticlePoses(), header));
}

void LocalisationNode::Refuse(const std::string& topic, const std::string& why) {
  ++num_dropped_[topic];
  last_drop_ = topic + ": " + why;
  warnings_.Tell(topic, "dropped", why);
}

void LocalisationNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!filter_) {
    status.summary(DiagnosticStatus::WARN,
                   "waits for a map on " + nh_.resolveName(params_.names.map));
  } else if (!waits_for_.empty()) {
    status.summary(DiagnosticStatus::WARN, "waits for " + waits_for_);
  } else if (!is_updated_) {
    status.summary(DiagnosticStatus::WARN,
                   "waits for scans on " + nh_.resolveName(params_.names.base_scan));
  }
  if (filter_) DiagnoseBelief(status);
  status.add("scans", num_scans_);
  for (const auto& [outcome, count] : num_outcomes_) status.add("scans, " + outcome, count);
  for (const auto& [topic, count] : num_dropped_) status.add("dropped, " + topic, count);
  status.add("dropped last", last_drop_);
}

void LocalisationNode::DiagnoseBelief(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const auto estimate = filter_->Estimate(ros::Time::now().toSec());
  if (is_updated_ && waits_for_.empty()) {
    switch (estimate.status) {
      case LocalisationStatus::kGood:
        status.summary(DiagnosticStatus::OK, "good");
        break;
      case LocalisationStatus::kAmbiguous:
        status.summary(DiagnosticStatus::WARN,
                       fmt::format("uncertain: {} places fit", estimate.num_clusters));
        break;
      case LocalisationStatus::kUnexplained:
        status.summary(DiagnosticStatus::ERROR,
                       "lost: the map explains too little of what the laser sees; tell where the "
                       "robot is (initialpose), or call global_localization and drive");
        break;
      case LocalisationStatus::kSpread:
        status.summary(DiagnosticStatus::ERROR,
                       "lost: it may be in too many places; drive, or tell where it is "
                       "(initialpose)");
        break;
      case LocalisationStatus::kNoScan:
        status.summary(DiagnosticStatus::ERROR,
                       last_drop_.empty()
                           ? "no scan that can be used comes any more"
                           : "no scan that can be used comes any more: " + last_drop_);
        break;
    }
  }
  const Eigen::Vector3d sd = estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  status.add("standard deviation of x [m]", sd.x());
  status.add("standard deviation of y [m]", sd.y());
  status.add("standard deviation of yaw [rad]", sd.z());
  status.add("particles", estimate.num_particles);
  status.add("effective particles", estimate.effective_size);
  status.add("places", estimate.num_clusters);
  status.add("share of the best place", estimate.best_share);
  status.add("beams explained", estimate.explained);
}

}  // namespace hires_ros
