#include "nodes/heat_reader/heat_reader_node.h"

#include <fmt/format.h>

#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/perception/camera_view.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/world/world_messages.h"
#include "nodes/heat_reader/heat_messages.h"

namespace hires_ros {
namespace {

namespace perception = hires::perception;
namespace sensing = hires::sensing;
using hires::geometry::Pose3;

constexpr double kStaleObjects = 10.0;  // [s] that the tracker's last words may be older

}  // namespace

HeatReaderNode::HeatReaderNode(const HeatReaderParams& params, ros::NodeHandle* nh)
    : params_(params),
      nh_(*nh),
      surroundings_(std::make_shared<const perception::Surroundings>(*params.world)),
      transforms_(nh, [this](const TransformBuffer::News&) { Try(); }) {
  const ros::SubscriberStatusCallback on_listener = [this](const ros::SingleSubscriberPublisher&) {
    ListenWhereHeard();
  };
  temperatures_ = nh->advertise<hires::ObjectTemperatures>(kObjectTemperatures, 10, on_listener);
  updater_.setHardwareID("heat_reader");
  updater_.add("heat", this, &HeatReaderNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) {
    ListenWhereHeard();
    updater_.update();
  });
}

/// Pictures are large: whoever does not need them does not ask for them.
void HeatReaderNode::ListenWhereHeard() {
  const bool is_heard = temperatures_.getNumSubscribers() > 0;
  if (is_heard && inputs_.empty()) {
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    inputs_.push_back(nh_.subscribe<sensor_msgs::CameraInfo>(
        params_.names.sensors.thermal_info, 1,
        [this](const sensor_msgs::CameraInfoConstPtr& msg) {
          info_ = msg;
          Try();
        },
        ros::VoidConstPtr(), hints));
    inputs_.push_back(nh_.subscribe<hires::WorldState>(
        kKnownObjects, 1,
        [this](const hires::WorldStateConstPtr& msg) {
          known_ = msg;
          Try();
        },
        ros::VoidConstPtr(), hints));
    inputs_.push_back(nh_.subscribe(params_.names.sensors.thermal_image, 1,
                                    &HeatReaderNode::OnPicture, this, hints));
  } else if (!is_heard && !inputs_.empty()) {
    inputs_.clear();
    waiting_.reset();
  }
}

void HeatReaderNode::OnPicture(const sensor_msgs::ImageConstPtr& msg) {
  ++num_pictures_;
  // A clock that began again is no picture too early.
  const double since = (msg->header.stamp - read_).toSec();
  if (since > 0.0 && since < params_.warm.period) return;
  waiting_ = msg;
  Try();
}

void HeatReaderNode::Try() {
  if (!waiting_) return;
  const std_msgs::Header& header = waiting_->header;
  const std::string frame = sensing::BareFrame(header.frame_id), map = params_.names.map_frame;
  if (header.stamp.isZero()) return Refuse("header.stamp is 0, wanted the picture's time");
  if (frame.empty()) return Refuse("header.frame_id is empty, wanted the camera's optical frame");
  waits_for_ = WhyUnknown(header);
  if (!waits_for_.empty()) return;
  const Placement placed = PlaceAt(transforms_.tree(), map, frame, header.stamp.toSec());
  if (placed.X_PC) return Read(*placed.X_PC * perception::OpticalFrame().Inverse());
  if (!placed.why_never.empty()) return Refuse(placed.why_never);
  waits_for_ = placed.waits_for;
}

/// What is not known yet of camera and objects; empty: nothing is missing.
std::string HeatReaderNode::WhyUnknown(const std_msgs::Header& header) const {
  if (!info_) return nh_.resolveName(params_.names.sensors.thermal_info);
  if (!known_) return nh_.resolveName(kKnownObjects);
  const double age = (header.stamp - known_->header.stamp).toSec();
  if (age <= kStaleObjects) return "";
  return fmt::format("{}, whose last is {:.1f} s older than the picture, wanted {:g} s at most",
                     nh_.resolveName(kKnownObjects), age, kStaleObjects);
}

/// What the map says, where the world has it.
Pose3 HeatReaderNode::InWorld(const Pose3& X_MF) const {
  const hires::geometry::MapToWorld& map_to_world = params_.names.map_to_world;
  Pose3 X_WF = hires::geometry::Lift(map_to_world.X_WM) * X_MF;
  X_WF.translation.head<2>() = map_to_world.ToWorld(Eigen::Vector2d(X_MF.translation.head<2>()));
  return X_WF;
}

std::vector<hires::geometry::Collision> HeatReaderNode::RobotShapes(double time) {
  std::vector<hires::geometry::Collision> shapes_W;
  unplaced_.clear();
  for (const hires::robot::Link& link : params_.robot->model.links) {
    if (link.collisions.empty()) continue;
    const sensing::FramePose X_ML =
        transforms_.tree().Find(params_.names.map_frame, link.name, time);
    if (X_ML.is_found()) {
      perception::AddShapesOf(link, InWorld(X_ML.X_PC), &shapes_W);
    } else {
      unplaced_.push_back(link.name);
    }
  }
  return shapes_W;
}

void HeatReaderNode::Read(const Pose3& X_MC) {
  const sensor_msgs::ImageConstPtr msg = std::exchange(waiting_, nullptr);
  perception::HeatReading reading;
  try {
    perception::HeatView view{HeatFromMsg(*msg), CameraFromMsg(*info_),
                              RobotShapes(msg->header.stamp.toSec())};
    if (view.heat.width != view.camera.width || view.heat.height != view.camera.height) {
      return Refuse(fmt::format("the picture has {} x {} pixels, its camera_info says {} x {}",
                                view.heat.width, view.heat.height, view.camera.width,
                                view.camera.height));
    }
    view.camera.X_MC = InWorld(X_MC);
    reading = perception::ReadHeat(view, surroundings_, FromMsg(*known_).objects, params_.warm);
  } catch (const hires::base::ConfigError& error) {
    return Refuse(error.what());
  }
  temperatures_.publish(ToMsg(reading, msg->header));
  read_ = msg->header.stamp;
  num_objects_ = reading.objects.size();
  num_regions_ = reading.regions.size();
  refused_.clear();
  ++num_read_;
}

void HeatReaderNode::Refuse(const std::string& why) {
  waiting_.reset();
  ++num_refused_;
  waits_for_.clear();
  refused_ = why;
  warnings_.Tell(params_.names.sensors.thermal_image, "dropped", why);
}

void HeatReaderNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (inputs_.empty()) {
    status.summary(DiagnosticStatus::OK, "rests: nobody listens");
  } else if (num_pictures_ == 0) {
    status.summary(DiagnosticStatus::WARN,
                   "waits for pictures on " + nh_.resolveName(params_.names.sensors.thermal_image));
  } else if (!refused_.empty()) {
    status.summary(DiagnosticStatus::WARN, "dropped a picture: " + refused_);
  } else if (!waits_for_.empty()) {
    status.summary(DiagnosticStatus::WARN, "waits for " + waits_for_);
  } else if (!unplaced_.empty()) {
    status.summary(DiagnosticStatus::WARN,
                   "reads, but may take parts of the robot for things: tf does not know " +
                       hires::base::Join(unplaced_, ", "));
  } else {
    status.summary(DiagnosticStatus::OK, "reads");
  }
  status.add("pictures", num_pictures_);
  status.add("read", num_read_);
  status.add("dropped", num_refused_);
  status.add("objects measured", num_objects_);
  status.add("warm regions", num_regions_);
}

}  // namespace hires_ros
