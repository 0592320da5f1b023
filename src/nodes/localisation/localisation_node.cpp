#include "nodes/localisation/localisation_node.h"

#include <fmt/format.h>
#include <geometry_msgs/PoseArray.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/robot/scan_messages.h"
#include "hires/ros/values/geometry_messages.h"
#include "hires/ros/world/map_messages.h"

namespace hires_ros {
namespace {

namespace localisation = hires::localisation;
using hires::base::ConfigError;
using hires::base::LogLevel;
using localisation::LocalisationStatus;
using localisation::ScanOutcome;

constexpr char kAmclPose[] = "amcl_pose";
constexpr char kStaticMap[] = "static_map";
constexpr double kPatience = 5.0;  // [s] for a latched map, before static_map is asked; and for it

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

LocalisationNode::LocalisationNode(const LocalisationNodeParams& params, ros::NodeHandle* nh)
    : params_(params),
      nh_(*nh),
      transforms_(nh, [this](const TransformBuffer::News& news) { OnTransforms(news); }),
      scans_(
          transforms_.tree(), params.names, params.config.node,
          [this](const PlacedScan& scan) { Use(scan); },
          [this](const std::string& why) { Refuse(params_.names.base_scan, why); }),
      map_server_(nh->resolveName(params.names.static_map)),
      kept_(params.kept),
      keeper_(ros::NodeHandle("~")),
      has_place_(params.is_start_given),
      begun_(hires::base::SteadyNow()) {
  const std::string& told = params.names.localisation;
  pose_ = nh->advertise<geometry_msgs::PoseWithCovarianceStamped>(told.empty() ? kAmclPose : told,
                                                                  2, true);
  particles_ = nh->advertise<geometry_msgs::PoseArray>("particlecloud", 2);
  if (params.config.node.tf_broadcast)
    transform_ = nh->advertise<tf2_msgs::TFMessage>(kTransforms, 100);
  if (params.map) {
    ServeMap(nh);
  } else {
    scans_.Need("a map on " + nh->resolveName(params.names.map));
  }
  Listen(nh);
  updater_.setHardwareID("localisation");
  updater_.add("localisation", this, &LocalisationNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) {
    if (!filter_ && hires::base::SteadyNow() - begun_ > kPatience) AskForMap();
    scans_.DropUseless();     // what waits grows old, also where nothing comes
    scans_.Try(true);         // the clock may have come after all else
    updater_.force_update();  // also while simulated time stands still
  });
}

void LocalisationNode::Listen(ros::NodeHandle* nh) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  if (!params_.map)
    inputs_.push_back(nh->subscribe(params_.names.map, 1, &LocalisationNode::OnMap, this, hints));
  inputs_.push_back(nh->subscribe(kInitialPose, 10, &LocalisationNode::OnInitialPose, this, hints));
  inputs_.push_back(nh->subscribe(params_.names.base_scan, PlacedScans::kMostWaiting,
                                  &LocalisationNode::OnScan, this, hints));
  services_.push_back(
      nh->advertiseService("global_localization", &LocalisationNode::OnGlobalLocalisation, this));
  services_.push_back(
      nh->advertiseService("request_nomotion_update", &LocalisationNode::OnNoMotionUpdate, this));
}

void LocalisationNode::ServeMap(ros::NodeHandle* nh) {
  BeginWith(*params_.map);
  std_msgs::Header header;
  header.frame_id = params_.names.map_frame;
  const nav_msgs::OccupancyGrid map = hires_ros::ToMsg(*params_.map, header);
  map_publisher_ = nh->advertise<nav_msgs::OccupancyGrid>(params_.names.map, 1, true);
  map_publisher_.publish(map);
  const std::string& service = params_.names.static_map;
  services_.push_back(nh->advertiseService(
      service.empty() ? kStaticMap : service,
      boost::function<bool(nav_msgs::GetMapRequest&, nav_msgs::GetMapResponse&)>(
          [map](nav_msgs::GetMapRequest&, nav_msgs::GetMapResponse& response) {
            response.map = map;
            return true;
          })));
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
    scans_.Need("");
  } catch (const ConfigError& error) {
    return Refuse(topic, error.what());
  }
  scans_.Try(true);
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
  extent_ = localisation::ExtentOf(map);
  is_updated_ = false;
  hires::base::Log(LogLevel::kInfo, fmt::format("map=used width={} height={} resolution={:g}",
                                                map.width, map.height, map.resolution));
  if (before) SetPose(*before);
}

void LocalisationNode::AskForMap() {
  if (params_.names.static_map.empty()) return;
  if (const auto map = map_server_.Take()) return OnMap(*map);
  map_server_.Ask();
}

void LocalisationNode::OnInitialPose(const geometry_msgs::PoseWithCovarianceStamped& msg) {
  const std::string frame = hires::sensing::BareFrame(msg.header.frame_id);
  if (frame != params_.names.map_frame) {
    return Refuse(kInitialPose, fmt::format("header.frame_id is '{}', wanted '{}'",
                                            msg.header.frame_id, params_.names.map_frame));
  }
  try {
    const UncertainPose pose = hires_ros::FromMsg(msg.pose);
    if (!filter_) {
      told_ = pose;
    } else if (!SetPose(pose)) {
      return;
    }
    kept_.reset();
  } catch (const ConfigError& error) {
    Refuse(kInitialPose, error.what());
  }
}

/// False: it is none of that map.
bool LocalisationNode::SetPose(const UncertainPose& pose) {
  const std::string why = localisation::WhyOutside(pose.X_AB, extent_);
  if (!why.empty()) {
    Refuse(kInitialPose, why);
    return false;
  }
  filter_->SetPose(pose.X_AB, pose.covariance);
  has_place_ = true;
  hires::base::Log(LogLevel::kInfo, fmt::format("pose=set x={:.3f} y={:.3f} yaw={:.3f}",
                                                pose.X_AB.x, pose.X_AB.y, pose.X_AB.yaw));
  return true;
}

bool LocalisationNode::OnGlobalLocalisation(Empty::Request&, Empty::Response&) {
  if (!filter_) {
    Refuse("global_localization", "there is no map yet, wanted one on " + params_.names.map);
    return false;
  }
  kept_.reset();
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
  scans_.Try(false);
}

void LocalisationNode::OnScan(const topic_tools::ShapeShifter& msg) {
  ++num_scans_;
  try {
    scans_.Add(LaserScanOf(msg));
  } catch (const ConfigError& error) {
    Refuse(params_.names.base_scan, error.what());
  }
}

/// Where the robot drove on while nobody localised it, its odometry tells.
void LocalisationNode::GoOnFromKept(const PlacedScan& scan) {
  const auto kept = std::exchange(kept_, std::nullopt);
  if (!kept) return;
  const auto X_MB =
      PlaceNow(*kept, scan.X_OB, scan.header.stamp.toSec(), params_.config.filter.max_linear_speed);
  if (X_MB) SetPose({*X_MB, kept->variance.asDiagonal()});
}

/// A place that is none is not worth keeping.
void LocalisationNode::Keep(const PlacedScan& scan) {
  if (is_lost_) return;
  const double time = scan.header.stamp.toSec();
  keeper_.Note({filter_->CorrectedOdometry() * scan.X_OB,
                filter_->Estimate(time).covariance.diagonal().cwiseMax(0.0), scan.X_OB, time});
}

void LocalisationNode::Use(const PlacedScan& scan) {
  GoOnFromKept(scan);
  const ScanOutcome outcome =
      filter_->Update(scan.header.stamp.toSec(), scan.X_OB, scan.reading, scan.X_BL);
  ++num_outcomes_[localisation::ToString(outcome)];
  if (outcome == ScanOutcome::kTimeWentBack || outcome == ScanOutcome::kOdometryJumped) {
    Refuse(params_.names.base_scan, localisation::ToString(outcome) +
                                        ": it goes on from this odometry, and keeps what it "
                                        "believes");
  } else if (outcome == ScanOutcome::kLate) {
    Refuse(
        params_.names.base_scan,
        "late: its stamp is a little older than that of the scan before, wanted rising ones; two "
        "lasers on one topic do so");
  } else if (localisation::IsBad(outcome)) {
    Refuse(params_.names.base_scan, WhyBad(outcome, scan.reading));
  }
  const bool is_followed = outcome != ScanOutcome::kNotFinite && outcome != ScanOutcome::kLate;
  is_updated_ = is_updated_ || outcome == ScanOutcome::kUpdated;
  const bool is_new = NoteLost(scan.header.stamp.toSec()) || outcome == ScanOutcome::kUpdated ||
                      (localisation::IsBad(outcome) && IsLessSure(scan.header.stamp.toSec()));
  has_place_ = has_place_ || (is_updated_ && !is_lost_);
  // The odometry goes on below the map, also where the laser sees nothing.
  if (!is_updated_ || !has_place_ || !is_followed) return;
  Publish(scan.header.stamp, is_new);
  Keep(scan);
}

/// Whether the place has become less certain than was told, as where scans cannot be used.
bool LocalisationNode::IsLessSure(double stamp) const {
  const Eigen::Matrix3d now = filter_->Estimate(stamp).covariance;
  return ((now - told_covariance_).diagonal().array() > 0.0).any();
}

/// Whether it is lost since this scan, or not any more: that is told also where the robot stands.
bool LocalisationNode::NoteLost(double stamp) {
  const auto estimate = filter_->Estimate(stamp);
  const bool is_lost = estimate.status == LocalisationStatus::kUnexplained ||
                       estimate.status == LocalisationStatus::kSpread ||
                       estimate.status == LocalisationStatus::kNoScan;
  if (is_lost == is_lost_) return false;
  is_lost_ = is_lost;
  hires::base::Log(is_lost ? LogLevel::kWarn : LogLevel::kInfo,
                   fmt::format("place={} x={:.3f} y={:.3f} yaw={:.3f} explained={:.2f} searches={}",
                               is_lost ? "lost" : "found", estimate.X_MB.x, estimate.X_MB.y,
                               estimate.X_MB.yaw, estimate.explained, estimate.num_searches));
  return true;
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
  told_covariance_ = estimate.covariance;
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
    status.summary(DiagnosticStatus::WARN, WhatMapItWaitsFor());
  } else if (!scans_.waits_for().empty()) {
    status.summary(DiagnosticStatus::WARN, "waits for " + scans_.waits_for());
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

std::string LocalisationNode::WhatMapItWaitsFor() const {
  const std::string waits = "waits for a map on " + nh_.resolveName(params_.names.map);
  if (map_server_.Waiting() < kPatience) return waits;
  return waits + "; " + nh_.resolveName(params_.names.static_map) +
         " is there and does not answer, restart the map server";
}

void LocalisationNode::DiagnoseBelief(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const auto estimate = filter_->Estimate(ros::Time::now().toSec());
  if (is_updated_ && scans_.waits_for().empty()) {
    switch (estimate.status) {
      case LocalisationStatus::kGood:
        status.summary(DiagnosticStatus::OK, "good");
        break;
      case LocalisationStatus::kAmbiguous:
        status.summary(DiagnosticStatus::WARN,
                       fmt::format("uncertain: {} places fit", estimate.num_clusters));
        break;
      case LocalisationStatus::kUnexplained:
        status.summary(
            DiagnosticStatus::ERROR,
            "lost: the map explains too little of what the laser sees; it looks everywhere "
            "after relocate_after, or tell where the robot is (initialpose)");
        break;
      case LocalisationStatus::kSpread:
        status.summary(DiagnosticStatus::ERROR,
                       "lost: its place is not known well enough; drive, or tell it "
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
  status.add("effective particles, when last weighed", estimate.effective_size);
  status.add("places", estimate.num_clusters);
  status.add("share of the best place", estimate.best_share);
  status.add("beams explained", estimate.explained);
  status.add("looked everywhere by itself", estimate.num_searches);
}

}  // namespace hires_ros
