#include "nodes/tabletop_recogniser/tabletop_recogniser_node.h"

#include <fmt/format.h>
#include <visualization_msgs/MarkerArray.h>

#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/base/text.h"
#include "hires/perception/camera_view.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"
#include "nodes/tabletop_recogniser/recognition_markers.h"

namespace hires_ros {
namespace {

namespace perception = hires::perception;
namespace sensing = hires::sensing;

constexpr std::uint64_t kSeed = 1;      // of the planes that are tried; any will do
constexpr double kWarningPeriod = 1.0;  // [s]
constexpr std::uint32_t kTransformQueue = 6000;

}  // namespace

TabletopRecogniserNode::TabletopRecogniserNode(const TabletopRecogniserParams& params,
                                               ros::NodeHandle* nh)
    : params_(params),
      nh_(*nh),
      recogniser_(std::make_shared<const perception::Recogniser>(params.recogniser.catalogue,
                                                                 params.recogniser.params),
                  perception::SelfFilterParams()) {
  for (const bool are_static : {false, true}) {
    transforms_.push_back(nh->subscribe<tf2_msgs::TFMessage>(
        are_static ? kStaticTransforms : kTransforms, kTransformQueue,
        boost::function<void(const tf2_msgs::TFMessage&)>(
            [this, are_static](const tf2_msgs::TFMessage& msg) { OnTransforms(msg, are_static); }),
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }
  const ros::SubscriberStatusCallback on_listener = [this](const ros::SingleSubscriberPublisher&) {
    ListenWhereHeard();
  };
  detections_ = nh->advertise<hires::Detections>(kDetections, 10, on_listener);
  markers_ = nh->advertise<visualization_msgs::MarkerArray>("recognition_markers", 2, on_listener);
  updater_.setHardwareID("tabletop_recogniser");
  updater_.add("recognition", this, &TabletopRecogniserNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) {
    ListenWhereHeard();
    updater_.update();
  });
}

/// Clouds are large: whoever does not need them does not ask for them.
void TabletopRecogniserNode::ListenWhereHeard() {
  const bool is_heard = detections_.getNumSubscribers() > 0 || markers_.getNumSubscribers() > 0;
  if (is_heard && !clouds_) {
    clouds_ = nh_.subscribe(params_.cloud, 1, &TabletopRecogniserNode::OnCloud, this,
                            ros::TransportHints().tcpNoDelay());
  } else if (!is_heard && clouds_) {
    clouds_.reset();
    waiting_.reset();
  }
}

void TabletopRecogniserNode::OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static) {
  tree_.Take(msg, are_static);
  Try();
}

void TabletopRecogniserNode::OnCloud(const sensor_msgs::PointCloud2ConstPtr& msg) {
  if (msg->header.stamp == last_.header.stamp && !last_.header.stamp.isZero()) return Tell();
  ++num_clouds_;
  if (waiting_ && waiting_->header.stamp != msg->header.stamp) ++num_replaced_;
  waiting_ = msg;
  Try();
}

void TabletopRecogniserNode::Try() {
  if (!waiting_) return;
  const std_msgs::Header& header = waiting_->header;
  const std::string frame = sensing::BareFrame(header.frame_id);
  if (header.stamp.isZero()) return Refuse("header.stamp is 0, wanted the picture's time");
  if (frame.empty()) return Refuse("header.frame_id is empty, wanted the camera's optical frame");
  const double time = header.stamp.toSec();
  const sensing::FramePose X_BC = tree_.Find(params_.base_frame, frame, time);
  if (X_BC.is_found()) return Recognise(X_BC.X_PC);
  const std::string why = tree_.WhyNot(params_.base_frame, frame, time);
  const auto newest = tree_.NewestOf(params_.base_frame, frame);
  const bool is_too_old = X_BC.status == sensing::FrameStatus::kNotThen && newest && *newest > time;
  if (is_too_old) return Refuse("older than what is kept of tf: " + why);
  if (X_BC.status == sensing::FrameStatus::kInLoop) return Refuse(why);
  waits_for_ = fmt::format("of '{}' in '{}': {}", frame, params_.base_frame, why);
}

std::vector<hires::geometry::Collision> TabletopRecogniserNode::RobotShapes(double time) {
  std::vector<hires::geometry::Collision> shapes_B;
  uncut_.clear();
  for (const hires::robot::Link& link : params_.robot->model.links) {
    if (link.collisions.empty()) continue;
    const sensing::FramePose X_BL = tree_.Find(params_.base_frame, link.name, time);
    if (X_BL.is_found()) {
      perception::AddShapesOf(link, X_BL.X_PC, &shapes_B);
    } else {
      uncut_.push_back(link.name);
    }
  }
  return shapes_B;
}

void TabletopRecogniserNode::Recognise(const hires::geometry::Pose3& X_BC) {
  const auto begin = Steady::now();
  const sensor_msgs::PointCloud2ConstPtr msg = std::exchange(waiting_, nullptr);
  perception::PointCloud cloud;
  try {
    cloud = FromMsg(*msg);
  } catch (const hires::base::ConfigError& error) {
    return Refuse(error.what());
  }
  num_points_ = static_cast<int>(cloud.points.size());
  const auto seen = recogniser_.Look(std::move(cloud), X_BC, RobotShapes(msg->header.stamp.toSec()),
                                     params_.robot->profile.tray_link,
                                     hires::base::Rng(kSeed).Fork(msg->header.stamp.toNSec()));
  num_own_points_ = seen ? seen->num_own_points : 0;
  std::optional<perception::Sighting> sighting;
  if (seen) sighting = seen->sighting;
  last_ = ToMsg(sighting, msg->header);
  waits_for_.clear();
  refused_.clear();
  ++num_recognised_;
  seconds_ = std::chrono::duration<double>(Steady::now() - begin).count();
  Tell();
}

void TabletopRecogniserNode::Tell() {
  detections_.publish(last_);
  if (markers_.getNumSubscribers() > 0) markers_.publish(RecognitionMarkers(last_));
}

void TabletopRecogniserNode::Refuse(const std::string& why) {
  waiting_.reset();
  ++num_refused_;
  waits_for_.clear();
  refused_ = why;
  if (hires::base::SteadyNow() - last_warning_ < kWarningPeriod) return;
  last_warning_ = hires::base::SteadyNow();
  hires::base::Log(hires::base::LogLevel::kWarn,
                   fmt::format("topic={} dropped why={}", params_.cloud, why));
}

void TabletopRecogniserNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!clouds_) {
    status.summary(DiagnosticStatus::OK, "rests: nobody listens");
  } else if (num_clouds_ == 0) {
    status.summary(DiagnosticStatus::WARN, "waits for clouds on " + clouds_->getTopic());
  } else if (!refused_.empty()) {
    status.summary(DiagnosticStatus::WARN, "dropped a cloud: " + refused_);
  } else if (!waits_for_.empty()) {
    status.summary(DiagnosticStatus::WARN, "waits for the transform " + waits_for_);
  } else if (!uncut_.empty()) {
    status.summary(DiagnosticStatus::WARN,
                   "recognises, but may take parts of the robot for things: tf does not know " +
                       hires::base::Join(uncut_, ", "));
  } else if (last_.is_blind) {
    status.summary(DiagnosticStatus::OK, "sees no table");
  } else {
    status.summary(DiagnosticStatus::OK, "recognises");
  }
  status.add("clouds", num_clouds_);
  status.add("recognised", num_recognised_);
  status.add("dropped", num_refused_);
  status.add("replaced by newer ones", num_replaced_);
  status.add("points", num_points_);
  status.add("points of the robot itself", num_own_points_);
  status.add("things", last_.detections.size());
  status.add("time for a cloud [s]", seconds_);
  status.add("kinds", params_.recogniser.catalogue.size());
}

}  // namespace hires_ros
