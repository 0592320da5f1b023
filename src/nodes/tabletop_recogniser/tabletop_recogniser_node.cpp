#include "nodes/tabletop_recogniser/tabletop_recogniser_node.h"

#include <fmt/format.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <array>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/perception/camera_view.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/perception/cloud_messages.h"
#include "hires/ros/perception/detection_messages.h"
#include "nodes/tabletop_recogniser/recognition_markers.h"

namespace hires_ros {
namespace {

namespace perception = hires::perception;
namespace sensing = hires::sensing;

constexpr std::uint64_t kSeed = 1;  // of the planes that are tried; any will do
constexpr std::array<const char*, 4> kFaultNames{"malformed", "too old", "ahead of time",
                                                 "without transform"};  // as Fault

}  // namespace

TabletopRecogniserNode::TabletopRecogniserNode(const TabletopRecogniserParams& params,
                                               ros::NodeHandle* nh)
    : params_(params),
      nh_(*nh),
      recogniser_(std::make_shared<const perception::Recogniser>(params.recogniser.catalogue,
                                                                 params.recogniser.params),
                  perception::SelfFilterParams()),
      transforms_(nh, [this](const TransformBuffer::News&) { Try(); }) {
  const ros::SubscriberStatusCallback on_listener = [this](const ros::SingleSubscriberPublisher&) {
    ListenWhereHeard();
  };
  detections_ = nh->advertise<hires::Detections>(kDetections, 10, on_listener);
  markers_ = nh->advertise<visualization_msgs::MarkerArray>("recognition_markers", 2, on_listener);
  updater_.setHardwareID("tabletop_recogniser");
  updater_.add("recognition", this, &TabletopRecogniserNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) {
    ListenWhereHeard();
    Try();  // what waits grows old, also where no transforms come
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

void TabletopRecogniserNode::OnCloud(const sensor_msgs::PointCloud2ConstPtr& msg) {
  const ros::Time& stamp = msg->header.stamp;
  if (waiting_ && waiting_->header.stamp != stamp) {
    ++num_replaced_;
    waits_for_.clear();
  }
  waiting_ = msg;
  if (stamp == last_.header.stamp && !stamp.isZero()) {
    if (RefuseIfUntimely()) return;
    waiting_.reset();
    return Tell();
  }
  ++num_clouds_;
  Try();
}

bool TabletopRecogniserNode::RefuseIfUntimely() {
  perception::CloudAgeParams limits = params_.recogniser.age;
  // There is one clock in simulated time: a cloud ahead of it came before the message on /clock.
  const bool is_simulated = ros::Time::isSimTime();
  if (is_simulated) limits.max_ahead = std::max(limits.max_ahead, limits.max_age);
  const double stamp = waiting_->header.stamp.toSec(), now = ros::Time::now().toSec();
  const perception::CloudAge age = perception::AgeOf(stamp, now, limits);
  if (age == perception::CloudAge::kTimely) return false;
  if (age == perception::CloudAge::kAhead) {
    Refuse(Fault::kAhead,
           fmt::format("its stamp lies {:.1f} s in the future, wanted {:g} at most; {}",
                       stamp - now, limits.max_ahead,
                       is_simulated ? "let what gives the time on /clock give the clouds as well"
                                    : "synchronise the clocks of the computers"));
  } else if (waits_for_.empty()) {
    Refuse(Fault::kTooOld, fmt::format("it is {:.1f} s old, wanted {:g} at most; play bags with "
                                       "--clock and use_sim_time",
                                       now - stamp, limits.max_age));
  } else {
    Refuse(Fault::kNoTransform,
           fmt::format("it waited until it was {:.1f} s old for {}", now - stamp, waits_for_));
  }
  return true;
}

void TabletopRecogniserNode::Try() {
  if (!waiting_) return;
  const std_msgs::Header& header = waiting_->header;
  const std::string frame = sensing::BareFrame(header.frame_id);
  if (header.stamp.isZero())
    return Refuse(Fault::kMalformed, "header.stamp is 0, wanted the picture's time");
  if (frame.empty())
    return Refuse(Fault::kMalformed, "header.frame_id is empty, wanted the camera's optical frame");
  if (ros::Time::now().isZero()) {
    waits_for_ = "the time on /clock";
    return;
  }
  if (RefuseIfUntimely()) return;
  const Placement placed =
      PlaceAt(transforms_.tree(), params_.base_frame, frame, header.stamp.toSec());
  if (placed.X_PC) return Recognise(*placed.X_PC);
  if (!placed.why_never.empty()) return Refuse(Fault::kNoTransform, placed.why_never);
  waits_for_ = placed.waits_for;
}

std::vector<hires::geometry::Collision> TabletopRecogniserNode::RobotShapes(double time) {
  std::vector<hires::geometry::Collision> shapes_B;
  uncut_.clear();
  for (const hires::robot::Link& link : params_.robot->model.links) {
    if (link.collisions.empty()) continue;
    const sensing::FramePose X_BL = transforms_.tree().Find(params_.base_frame, link.name, time);
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
    return Refuse(Fault::kMalformed, error.what());
  }
  const std::string why = perception::TakeOnlyAhead(&cloud);
  if (!why.empty()) {
    return Refuse(Fault::kMalformed, fmt::format("{}, '{}' is none", why, msg->header.frame_id));
  }
  num_points_ = static_cast<int>(cloud.points.size());
  num_measured_ = static_cast<int>(
      std::count_if(cloud.points.begin(), cloud.points.end(), perception::IsMeasured));
  const auto seen = recogniser_.Look(std::move(cloud), X_BC, RobotShapes(msg->header.stamp.toSec()),
                                     params_.robot->profile.tray_link,
                                     hires::base::Rng(kSeed).Fork(msg->header.stamp.toNSec()));
  num_own_points_ = seen ? seen->num_own_points : 0;
  std::optional<perception::Sighting> sighting;
  if (seen) sighting = seen->sighting;
  last_ = ToMsg(sighting, msg->header);
  num_left_out_ = seen ? seen->num_left_out : 0;
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

void TabletopRecogniserNode::Refuse(Fault fault, const std::string& why) {
  waiting_.reset();
  ++num_refused_[static_cast<std::size_t>(fault)];
  waits_for_.clear();
  refused_ = why;
  warnings_.Tell(params_.cloud, "dropped", why);
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
    status.summary(DiagnosticStatus::WARN, "waits for " + waits_for_);
  } else if (num_points_ == 0) {
    status.summary(DiagnosticStatus::WARN, "sees nothing: the cloud has no points");
  } else if (num_measured_ == 0) {
    status.summary(DiagnosticStatus::WARN, "sees nothing: no point of the cloud was measured");
  } else if (last_.is_blind) {
    status.summary(DiagnosticStatus::OK, "sees no table");
  } else if (!uncut_.empty()) {
    status.summary(DiagnosticStatus::WARN,
                   "recognises, but may take parts of the robot for things: tf does not know " +
                       hires::base::Join(uncut_, ", "));
  } else {
    status.summary(DiagnosticStatus::OK, "recognises");
  }
  status.add("clouds", num_clouds_);
  status.add("recognised", num_recognised_);
  static_assert(kFaultNames.size() == kNumFaults);
  for (std::size_t i = 0; i < kNumFaults; ++i)
    status.add(fmt::format("dropped, {}", kFaultNames[i]), num_refused_[i]);
  status.add("replaced by newer ones", num_replaced_);
  status.add("points", num_points_);
  status.add("points that were measured", num_measured_);
  status.add("points of the robot itself", num_own_points_);
  status.add("links that tf does not know", hires::base::Join(uncut_, ", "));
  status.add("things", last_.detections.size());
  status.add("things that may be beside the table",
             std::count_if(last_.detections.begin(), last_.detections.end(),
                           [](const auto& one) { return one.may_be_beside; }));
  status.add("points above the table of no thing", num_left_out_);
  status.add("time for a cloud [s]", seconds_);
  status.add("kinds", params_.recogniser.catalogue.size());
}

}  // namespace hires_ros
