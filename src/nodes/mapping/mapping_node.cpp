#include "nodes/mapping/mapping_node.h"

#include <fmt/format.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/mapping/map_doubt.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/robot/scan_messages.h"
#include "hires/ros/world/map_messages.h"

namespace hires_ros {
namespace {

namespace localisation = hires::localisation;
namespace mapping = hires::mapping;
using hires::base::ConfigError;
using hires::base::LogLevel;
using localisation::ScanOutcome;

constexpr char kDynamicMap[] = "dynamic_map";
constexpr char kSaveMap[] = "save_map";
constexpr double kJumpBack = 1.0;  // [s] by which time goes back where its clock began again
constexpr double kSilence = 5.0;   // [s] without a scan that can be used, after which it says so

}  // namespace

MappingNode::MappingNode(const MappingNodeParams& params, ros::NodeHandle* nh)
    : params_(params),
      transforms_(nh, [this](const TransformBuffer::News& news) { OnTransforms(news); }),
      scans_(
          transforms_.tree(), params.names, params.config.node,
          [this](const PlacedScan& scan) { Use(scan); },
          [this](const std::string& why) { Refuse(params_.names.base_scan, why); }) {
  BeginMap();
  map_publisher_ = nh->advertise<nav_msgs::OccupancyGrid>(params.names.map, 1, true);
  metadata_ = nh->advertise<nav_msgs::MapMetaData>("map_metadata", 1, true);
  if (params.config.node.tf_broadcast)
    transform_ = nh->advertise<tf2_msgs::TFMessage>(kTransforms, 100);
  Listen(nh);
  updater_.setHardwareID("mapping");
  updater_.add("mapping", this, &MappingNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0),
                                 [this](const ros::SteadyTimerEvent&) { OnTimer(); });
}

void MappingNode::Listen(ros::NodeHandle* nh) {
  input_ = nh->subscribe(params_.names.base_scan, PlacedScans::kMostWaiting, &MappingNode::OnScan,
                         this, ros::TransportHints().tcpNoDelay());
  services_.push_back(nh->advertiseService(kDynamicMap, &MappingNode::OnMapRequest, this));
  services_.push_back(nh->advertiseService(kSaveMap, &MappingNode::OnSave, this));
}

void MappingNode::OnTransforms(const TransformBuffer::News& news) {
  WatchClock();
  for (const std::string& warning : news.warnings) Refuse(kTransforms, warning);
  for (const std::string& doubt : news.doubts) warnings_.Tell(kTransforms, "doubtful", doubt);
  scans_.Try(false);
}

void MappingNode::OnScan(const topic_tools::ShapeShifter& msg) {
  ++num_scans_;
  WatchClock();
  try {
    scans_.Add(LaserScanOf(msg));
  } catch (const ConfigError& error) {
    Refuse(params_.names.base_scan, error.what());
  }
}

void MappingNode::OnTimer() {
  WatchClock();
  scans_.DropUseless();  // what waits grows old, also where nothing comes
  scans_.Try(true);      // the clock may have come after all else
  TakeDrawn(false);
  // Scans draw the map; the last ones have none after them that does.
  const double silence = hires::base::SteadyNow() - last_used_;
  if (is_map_old_ && !drawing_.valid() && silence >= params_.config.map_update_interval)
    BeginDrawing();
  updater_.force_update();  // also while simulated time stands still
}

std::string MappingNode::WhyNoMap() {
  TakeDrawn(true);
  if (is_map_old_) {
    BeginDrawing();
    TakeDrawn(true);
  }
  if (!why_not_drawn_.empty()) return why_not_drawn_;
  return map_ ? "" : "no scan has met anything yet";
}

bool MappingNode::OnMapRequest(nav_msgs::GetMap::Request&, nav_msgs::GetMap::Response& response) {
  const std::string why = WhyNoMap();
  if (!why.empty()) {
    Refuse(kDynamicMap, why);
    return false;
  }
  response.map = map_->msg;
  return true;
}

bool MappingNode::OnSave(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    if (params_.map_file.empty())
      throw ConfigError("~map_file is empty; name there the YAML file that is to be written");
    const std::string why = WhyNoMap();
    if (!why.empty()) throw ConfigError(why);
    hires::world::SaveMap(map_->grid, params_.map_file);
    response.message = params_.map_file;
    response.success = true;
  } catch (const ConfigError& error) {
    response.message = error.what();
    Refuse(kSaveMap, response.message);
  }
  return true;
}

/// What a bag that begins again tells has nothing to do with where the robot was at its end.
void MappingNode::WatchClock() {
  const ros::Time now = ros::Time::now();
  const double back = (now_ - now).toSec();
  now_ = now;
  if (back <= kJumpBack) return;
  scans_.Forget();
  if (!last_scan_) return;
  ++num_restarts_;
  warnings_.Tell("/clock", "went back", fmt::format("by {:.1f} s: a new map is begun", back));
  BeginMap();
}

/// The last map stays what was told until there is another one.
void MappingNode::BeginMap() {
  mapper_.emplace(params_.config.mapper);
  counts_ = {};
  is_lost_ = is_map_old_ = false;
  last_scan_.reset();
  last_drawn_.reset();
  why_not_drawn_.clear();
}

void MappingNode::Use(const PlacedScan& scan) {
  const std::string why = WhyUseless(scan);
  if (!why.empty()) return Refuse(params_.names.base_scan, why);
  AddToMap(scan);
  if (transform_) PublishTransform(scan);
  TakeDrawn(false);
  if (IsDue()) BeginDrawing();
}

std::string MappingNode::WhyUseless(const PlacedScan& scan) {
  if (last_scan_ && scan.header.stamp <= *last_scan_) {
    return fmt::format("its stamp is {:.3f} s, wanted more than the {:.3f} s of the scan before",
                       scan.header.stamp.toSec(), last_scan_->toSec());
  }
  if (!scan.X_OB.IsFinite() || !scan.X_BL.IsFinite()) return "tf places it where no number is";
  const double range_max = scan.reading.range_max;
  const double longest = range_max > 0.0 ? std::min(range_max, params_.config.mapper.max_range)
                                         : params_.config.mapper.max_range;
  const ScanOutcome outcome = localisation::Examine(scan.reading, scan.reading.range_min, longest);
  ++num_outcomes_[localisation::ToString(outcome)];
  // In the middle of a hall a robot goes by its odometry.
  if (outcome == ScanOutcome::kNothingMet && last_scan_) return "";
  return localisation::IsBad(outcome) ? WhyBad(outcome, scan.reading) : "";
}

void MappingNode::AddToMap(const PlacedScan& scan) {
  const mapping::MapCounts before = counts_;
  mapper_->AddScan({scan.header.stamp.toSec(), scan.X_BL, scan.reading, scan.X_OB});
  counts_ = mapper_->counts();
  last_scan_ = scan.header.stamp;
  last_used_ = hires::base::SteadyNow();
  is_map_old_ = true;
  is_lost_ = counts_.num_lost > before.num_lost;
  if (is_lost_) {
    warnings_.Tell(params_.names.base_scan, "doubtful",
                   "a scan fits nothing and stands where odometry says");
  }
  if (counts_.odometry_jumps > before.odometry_jumps) {
    warnings_.Tell(kTransforms, "doubtful", "odometry jumped, which counts as no motion");
  }
  if (counts_.num_loops > before.num_loops) {
    hires::base::Log(LogLevel::kInfo, fmt::format("map=tied loops={} keyframes={}",
                                                  counts_.num_loops, counts_.num_keyframes));
  }
}

void MappingNode::PublishTransform(const PlacedScan& scan) {
  const hires::control::RobotNames& names = params_.names;
  const hires::geometry::Pose2 X_MO = mapper_->newest()->X_MB * scan.X_OB.Inverse();
  tf2_msgs::TFMessage msg;
  msg.transforms.push_back(
      MakeTransform(names.map_frame, names.odometry_frame, hires::geometry::Lift(X_MO),
                    scan.header.stamp + ros::Duration(params_.config.node.transform_tolerance)));
  transform_.publish(msg);
}

bool MappingNode::IsDue() const {
  if (drawing_.valid()) return false;  // by the first scan after it
  return !last_drawn_ || (*last_scan_ - *last_drawn_).toSec() >= params_.config.map_update_interval;
}

void MappingNode::BeginDrawing() {
  is_map_old_ = false;
  last_drawn_ = last_scan_;
  std_msgs::Header header;
  header.stamp = *last_scan_;
  header.frame_id = params_.names.map_frame;
  drawing_ = std::async(std::launch::async, &MappingNode::DrawFrom, mapper_->sketch(), counts_,
                        header, num_restarts_);
}

MappingNode::DrawnMap MappingNode::DrawFrom(const mapping::MapSketch& sketch,
                                            const mapping::MapCounts& counts,
                                            const std_msgs::Header& header, long restart) {
  const double begun = hires::base::SteadyNow();
  DrawnMap drawn;
  drawn.restart = restart;
  try {
    drawn.grid = mapping::Draw(sketch);
    drawn.doubt = mapping::WhyDoubtful(counts, mapping::EvidenceOf(sketch, drawn.grid));
    drawn.msg = ToMsg(drawn.grid, header);
  } catch (const ConfigError& error) {
    drawn.why_not = error.what();
  }
  drawn.took = hires::base::SteadyNow() - begun;
  return drawn;
}

void MappingNode::TakeDrawn(bool is_awaited) {
  if (!drawing_.valid()) return;
  if (!is_awaited && drawing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  DrawnMap drawn = drawing_.get();
  if (drawn.restart != num_restarts_) return;
  drawing_took_ = drawn.took;
  why_not_drawn_ = drawn.why_not;
  if (!why_not_drawn_.empty()) return Refuse(params_.names.map, why_not_drawn_);
  map_ = std::move(drawn);
  ++num_maps_;
  if (!map_->doubt.empty()) warnings_.Tell(params_.names.map, "doubtful", map_->doubt);
  map_publisher_.publish(map_->msg);
  metadata_.publish(map_->msg.info);
}

void MappingNode::Refuse(const std::string& topic, const std::string& why) {
  ++num_dropped_[topic];
  last_drop_ = topic + ": " + why;
  warnings_.Tell(topic, "dropped", why);
}

std::string MappingNode::Complaint() const {
  if (!scans_.waits_for().empty()) return "waits for " + scans_.waits_for();
  if (!last_scan_) return "waits for scans on " + input_.getTopic();
  if ((ros::Time::now() - *last_scan_).toSec() > kSilence) {
    const std::string silence = "no scan that can be used comes any more";
    return last_drop_.empty() ? silence : silence + ": " + last_drop_;
  }
  if (is_lost_) return "lost: the last scan fits nothing and stands where odometry says";
  return map_ && !map_->doubt.empty() ? "the map is doubtful: " + map_->doubt : "";
}

void MappingNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::string complaint = Complaint();
  status.summary(DiagnosticStatus::OK, "mapping");
  if (!complaint.empty()) status.summary(DiagnosticStatus::WARN, complaint);
  if (!why_not_drawn_.empty()) status.summary(DiagnosticStatus::ERROR, "no map: " + why_not_drawn_);
  status.add("scans", num_scans_);
  for (const auto& [outcome, count] : num_outcomes_) status.add("scans, " + outcome, count);
  status.add("keyframes", counts_.num_keyframes);
  status.add("loops", counts_.num_loops);
  status.add("lost scans", counts_.num_lost);
  status.add("odometry jumps", counts_.odometry_jumps);
  status.add("doubt", map_ ? map_->doubt : "");
  status.add("clock begun again", num_restarts_);
  status.add("maps", num_maps_);
  status.add("drawing the last map [s]", drawing_took_);
  for (const auto& [topic, count] : num_dropped_) status.add("dropped, " + topic, count);
  status.add("dropped last", last_drop_);
}

}  // namespace hires_ros
