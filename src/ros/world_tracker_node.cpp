#include "hires/ros/world_tracker_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/actions/catalogue.h"
#include "hires/base/action.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/robot/gripper.h"
#include "hires/ros/conversions.h"
#include "hires/ros/process.h"
#include "hires/ros/robot_topics.h"
#include "hires/ros/topic_names.h"
#include "hires/translation/task_places.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
namespace perception = hires::perception;
namespace robot = hires::robot;
namespace sensing = hires::sensing;
namespace translation = hires::translation;
using hires::base::ConfigError;
using hires::base::Log;
using hires::base::LogLevel;

constexpr double kKnownPeriod = 0.1;    // [s] at most, between words about known objects
constexpr double kWarningPeriod = 1.0;  // [s] for each topic
constexpr double kNever = -1e9;         // [s]

std::map<std::string, std::pair<double, double>> LimitsOf(const robot::RobotModel& model) {
  std::map<std::string, std::pair<double, double>> limits;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const std::string& name : model.JointNames()) {
    const robot::Joint* joint = robot::FindJoint(model, name);
    const bool is_bounded = joint->limits && joint->type != robot::JointType::kContinuous;
    limits[name] = is_bounded ? std::make_pair(joint->limits->lower, joint->limits->upper)
                              : std::make_pair(-kInfinity, kInfinity);
  }
  return limits;
}

void RequireFrame(const std::string& frame, const std::string& wanted) {
  if (BareFrame(frame) == wanted) return;
  throw ConfigError(fmt::format("frame_id is '{}', wanted '{}'", frame, wanted));
}

/// Without a time a message would count as one of long ago.
void RequireStamp(const ros::Time& stamp) {
  if (stamp.isZero()) throw ConfigError("header.stamp is 0, wanted the time of the measurement");
}

void RequireFinite(const hires::geometry::Pose3& pose, const std::string& what) {
  if (!pose.IsFinite()) throw ConfigError(fmt::format("{} is not finite", what));
}

}  // namespace

WorldTrackerNode::WorldTrackerNode(const WorldTrackerParams& params,
                                   translation::TranslatorContext context, ros::NodeHandle* nh)
    : params_(params),
      context_(std::move(context)),
      surroundings_(std::make_shared<const perception::Surroundings>(*context_.world)),
      joint_limits_(LimitsOf(context_.robot->model)),
      odometry_frame_(params.files.names.odometry_frame),
      senses_(params.files.names.map_to_world),
      memory_(surroundings_, context_.robot, params.memory),
      sweep_(context_.robot, params.sweep),
      known_(nh->advertise<hires::WorldState>(kKnownObjects, 10, true)),
      writer_(&context_, params_, *nh, [this](const RemoteView::Update&) { is_view_new_ = true; }) {
  updater_.setHardwareID("world_tracker");
  updater_.add("world tracker", this, &WorldTrackerNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0),
                                 [this](const ros::SteadyTimerEvent&) { updater_.update(); });
  Subscribe(nh);
}

void WorldTrackerNode::Subscribe(ros::NodeHandle* nh) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  using Self = WorldTrackerNode;
  const std::string action = kExecuteAction;
  const RobotNames& names = params_.files.names;
  // A robot whose head nobody may turn has no publisher that could.
  const auto head = names.trajectories.find("head");
  if (params_.sweep.enabled && head != names.trajectories.end()) {
    head_ = nh->advertise<trajectory_msgs::JointTrajectory>(head->second, 10);
  }
  subscribers_ = {nh->subscribe(names.odometry, 100, &Self::OnOdometry, this, hints),
                  nh->subscribe(names.localisation, 100, &Self::OnLocalisation, this, hints),
                  nh->subscribe(names.joint_states, 1000, &Self::OnJoints, this, hints),
                  nh->subscribe(kTransforms, 100, &Self::OnTransforms, this, hints),
                  nh->subscribe(kDetections, 10, &Self::OnDetections, this, hints),
                  nh->subscribe(action + "/goal", 10, &Self::OnGoal, this, hints),
                  nh->subscribe(action + "/result", 10, &Self::OnResult, this, hints)};
}

// What comes in --------------------------------------------------------------------------------

void WorldTrackerNode::Guard(const std::string& topic, const std::function<void()>& read) {
  try {
    read();
    Process();
  } catch (const ConfigError& error) {
    ++num_bad_;
    Warn(topic, error.what());
  }
}

void WorldTrackerNode::OnOdometry(const nav_msgs::Odometry& msg) {
  Guard(params_.files.names.odometry, [&] {
    RequireStamp(msg.header.stamp);
    RequireFinite(FromMsg(msg.pose.pose), "pose");
    const double stamp = msg.header.stamp.toSec();
    const auto reading = odometry_frame_.Take(stamp, msg.header.frame_id, FromMsg(msg));
    if (reading) senses_.OnOdometry(stamp, *reading);
  });
}

void WorldTrackerNode::OnTransforms(const tf2_msgs::TFMessage& msg) {
  const RobotNames& names = params_.files.names;
  for (const geometry_msgs::TransformStamped& transform : msg.transforms) {
    const double stamp = transform.header.stamp.toSec();
    const auto X_OB = PoseBetween(transform, names.odometry_frame, names.base_frame);
    const auto X_MO = PoseBetween(transform, names.map_frame, names.odometry_frame);
    if (X_OB) odometry_frame_.OnTransform(stamp, *X_OB);
    if (X_MO) senses_.OnOdometryOrigin(stamp, *X_MO);
  }
}

void WorldTrackerNode::OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg) {
  Guard(params_.files.names.localisation, [&] {
    RequireStamp(msg.header.stamp);
    RequireFrame(msg.header.frame_id, params_.files.names.map_frame);
    const auto X_MB = FromMsg(msg.pose.pose);
    RequireFinite(X_MB, "pose");
    senses_.OnLocalisation(msg.header.stamp.toSec(), hires::geometry::Flatten(X_MB));
  });
}

/// Joints that the robot does not have, or that follow others, are not ours; sensors may see a
/// joint a little beyond its stop.
void WorldTrackerNode::OnJoints(const sensor_msgs::JointState& msg) {
  Guard(params_.files.names.joint_states, [&] {
    RequireStamp(msg.header.stamp);
    if (msg.name.size() != msg.position.size()) {
      throw ConfigError(fmt::format("{} names and {} positions, wanted one position for each name",
                                    msg.name.size(), msg.position.size()));
    }
    robot::JointPositions joints = context_.robot->profile.joints;
    for (const auto& [name, position] : FromMsg(msg).positions) {
      const auto limits = joint_limits_.find(name);
      if (limits == joint_limits_.end()) continue;
      if (!std::isfinite(position)) {
        throw ConfigError(fmt::format("position of '{}' is {}, wanted a number", name, position));
      }
      joints[name] = std::clamp(position, limits->second.first, limits->second.second);
    }
    if (context_.robot->profile.upper_body) {
      robot::CompleteGrippers(*context_.robot->profile.upper_body, &joints);
    }
    senses_.OnJoints(msg.header.stamp.toSec(), std::move(joints));
  });
}

void WorldTrackerNode::OnDetections(const hires::Detections& msg) {
  Guard(kDetections, [&] {
    if (!context_.robot->profile.upper_body) {
      throw ConfigError(fmt::format("robot '{}' has no camera (upper_body in its profile)",
                                    context_.robot->model.name));
    }
    RequireStamp(msg.header.stamp);
    RequireFrame(msg.header.frame_id, context_.robot->profile.upper_body->camera_link);
    std::vector<perception::Detection> detections;
    for (const hires::Detection& object : msg.detections) {
      try {
        if (object.instance.empty()) {
          throw ConfigError(fmt::format("a detection of a '{}' has no instance", object.label));
        }
        surroundings_->Model(object.label);
        const auto X_CO = FromMsg(object.pose);
        RequireFinite(X_CO, fmt::format("pose of '{}'", object.instance));
        detections.push_back({object.instance, object.label, X_CO, object.visible_share});
      } catch (const ConfigError& error) {  // the others are good
        ++num_bad_;
        Warn(kDetections, error.what());
      }
    }
    senses_.OnLook(msg.header.stamp.toSec(), std::move(detections));
  });
}

void WorldTrackerNode::OnGoal(const hires::ExecuteActionActionGoal& msg) {
  running_[msg.goal_id.id] = hires::base::CanonicalName(msg.goal.action.name);
  TellActions();
}

void WorldTrackerNode::OnResult(const hires::ExecuteActionActionResult& msg) {
  running_.erase(msg.status.goal_id.id);
  TellActions();
}

void WorldTrackerNode::TellActions() {
  const bool is_busy = std::any_of(running_.begin(), running_.end(), [](const auto& running) {
    return hires::actions::MayUseHead(hires::actions::OwnActions(), running.second);
  });
  sweep_.SetBusy(is_busy, time_);
}

// What is made of it ---------------------------------------------------------------------------

void WorldTrackerNode::Process() {
  while (const auto moment = senses_.Take()) Handle(*moment);
}

/// What a look says of a time before a hand took or let go of something says nothing of now.
void WorldTrackerNode::HandleLate(const TrackerMoment& moment) {
  if (moment.body.time <= hands_changed_) {
    ++num_outdated_;
    return;
  }
  ++num_looks_;
  memory_.Look(moment.body, *moment.look);
  published_ = kNever;  // with the next moment
}

void WorldTrackerNode::Handle(const TrackerMoment& moment) {
  if (moment.is_late) return HandleLate(moment);
  ++num_moments_;
  time_ = moment.body.time;
  if (is_view_new_.exchange(false)) ReadView();
  const bool has_changed = memory_.Feel(moment.body);
  if (has_changed || time_ < hands_changed_) hands_changed_ = has_changed ? time_ : kNever;
  if (moment.look) {
    ++num_looks_;
    memory_.Look(moment.body, *moment.look);
  }
  const auto known = memory_.Known(moment.body);
  const bool is_due = has_changed || time_ - published_ >= kKnownPeriod || time_ < published_;
  if (moment.look || (is_due && !params_.lockstep)) PublishKnown(moment, known);
  const auto turn = sweep_.Update(moment, known);
  if (turn && head_) head_.publish(ToMsg(*turn));
  writer_.Post(time_, Observed(moment, known));
}

/// What others say of objects, and what tasks are about.
void WorldTrackerNode::ReadView() {
  writer_.view().Read([this](const knowledge::FluentView& view) {
    const translation::TranslatorContext context = writer_.ContextNow(view);
    std::vector<std::string> stated;
    for (const auto& object : translation::StatedObjects(context, view)) {
      stated.push_back(object.name);
      try {
        memory_.Believe(object.name, object.model, object.link, object.X_LO);
      } catch (const ConfigError& error) {
        Warn(kBlackboard, error.what());
      }
    }
    std::vector<std::string> unsaid;
    for (const auto& [name, unused] : memory_.objects()) {
      if (std::find(stated.begin(), stated.end(), name) == stated.end()) unsaid.push_back(name);
    }
    for (const std::string& name : unsaid) memory_.Disbelieve(name);
    sweep_.SetPlaces(translation::PlacesOfTasks(context, view), context.areas);
  });
}

void WorldTrackerNode::PublishKnown(const TrackerMoment& moment,
                                    const std::vector<robot::SeenObject>& known) {
  published_ = moment.body.time;
  hires::world::WorldState state;
  for (const robot::SeenObject& object : known) {
    state.objects.push_back({object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  hires::WorldState msg = ToMsg(state);
  msg.header.stamp.fromSec(moment.body.time);
  msg.header.frame_id = params_.files.names.map_frame;
  known_.publish(msg);
}

translation::ObservedWorld WorldTrackerNode::Observed(
    const TrackerMoment& moment, const std::vector<robot::SeenObject>& known) const {
  translation::ObservedWorld observed;
  observed.state.robot = {moment.body.X_MB, moment.V_B, moment.body.joints};
  for (const robot::SeenObject& object : known) {
    const sensing::RememberedObject& remembered = memory_.objects().at(object.name);
    if (!remembered.is_observed && !remembered.is_held) continue;  // others' word
    observed.state.world.objects.push_back(
        {object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  observed.vanished = memory_.Vanished();
  return observed;
}

// How it is ------------------------------------------------------------------------------------

void WorldTrackerNode::Warn(const std::string& topic, const std::string& text) {
  const auto warned = warned_.find(topic);
  if (warned != warned_.end() && SteadyNow() - warned->second < kWarningPeriod) return;
  warned_[topic] = SteadyNow();
  Log(LogLevel::kWarn, fmt::format("topic={} dropped why={}", topic, text));
}

void WorldTrackerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::string missing = senses_.Missing();
  if (!missing.empty()) {
    status.summary(DiagnosticStatus::WARN, "waits for " + missing);
  } else if (!writer_.view().is_connected()) {
    status.summary(DiagnosticStatus::WARN, "the Blackboard is away");
  } else {
    status.summary(DiagnosticStatus::OK, "tracks");
  }
  status.add("moments", num_moments_);
  status.add("looks", num_looks_);
  status.add("moments dropped", senses_.num_dropped());
  status.add("looks outdated", num_outdated_);
  status.add("bad messages", num_bad_);
  status.add("objects remembered", memory_.objects().size());
  status.add("objects vanished", memory_.Vanished().size());
  status.add("head looks at", sweep_.target());
  status.add("fluents written", writer_.num_written());
  status.add("failed writes", writer_.num_failures());
  status.add("last failure", writer_.last_failure());
}

}  // namespace hires_ros
