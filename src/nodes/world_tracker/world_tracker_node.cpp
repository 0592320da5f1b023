#include "nodes/world_tracker/world_tracker_node.h"

#include "hires/base/error.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/perception/cloud_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/robot/scan_messages.h"
#include "hires/ros/world/world_messages.h"
#include "hires/skills/action_loader.h"
#include "nodes/world_tracker/tray_markers.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
namespace perception = hires::perception;
namespace robot = hires::robot;
namespace sensing = hires::sensing;
namespace translation = hires::translation;

constexpr int kQueue = 6000;  // a minute of what comes at 100 Hz

std::optional<sensing::FloorWatch> FloorOf(const translation::TranslatorContext& context,
                                           const sensing::RobotStateEstimator& state,
                                           const WorldTrackerParams& params) {
  const hires::control::RobotNames& names = params.files.names;
  sensing::GroundWatchParams ground = params.sensing.ground;
  ground.is_enabled = ground.is_enabled && !names.sensors.tilt_cloud.empty();
  if (!params.floor.is_enabled || (names.base_scan.empty() && !ground.is_enabled))
    return std::nullopt;
  return sensing::FloorWatch(&state, context.world, context.robot, params.floor, ground);
}

}  // namespace

WorldTrackerNode::WorldTrackerNode(const WorldTrackerParams& params,
                                   translation::TranslatorContext context, ros::NodeHandle* nh)
    : params_(params),
      context_(std::move(context)),
      actions_(hires::skills::LoadActionSet(params.action_libraries)),
      sensors_(context_.robot, std::make_shared<const perception::Surroundings>(*context_.world),
               params.files.names, params.sensing),
      floor_(FloorOf(context_, sensors_.state(), params)),
      tracker_(&sensors_.state(), sensors_.objects(), floor_ ? &*floor_ : nullptr,
               hires::control::HeadSweep(context_.robot, params.sweep), params.lockstep,
               TrackerHooks()),
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
  const hires::control::RobotNames& names = params_.files.names;
  // A robot whose head must not be turned has no publisher for it.
  const auto head = names.trajectories.find("head");
  if (params_.sweep.enabled && head != names.trajectories.end()) {
    head_ = {names.trajectory_interface, head->second, nh};
  }
  SubscribeTo<nav_msgs::Odometry>(nh, names.odometry, kQueue,
                                  [this](const auto& msg) { sensors_.OnOdometry(msg); });
  SubscribeTo<sensor_msgs::JointState>(nh, names.joint_states, kQueue,
                                       [this](const auto& msg) { sensors_.OnJoints(msg); });
  SubscribeTo<tf2_msgs::TFMessage>(nh, kTransforms, kQueue,
                                   [this](const auto& msg) { sensors_.OnTransforms(msg, false); });
  SubscribeTo<tf2_msgs::TFMessage>(nh, kStaticTransforms, 100,
                                   [this](const auto& msg) { sensors_.OnTransforms(msg, true); });
  if (floor_ && !names.base_scan.empty()) {
    SubscribeTo<sensor_msgs::LaserScan>(nh, names.base_scan, kQueue,
                                        [this](const auto& msg) { OnScan(msg); });
  }
  if (floor_ && floor_->hears_clouds()) {
    SubscribeTo<sensor_msgs::PointCloud2>(nh, names.sensors.tilt_cloud, 2,
                                          [this](const auto& msg) { OnCloud(msg); });
  }
  if (!names.sensors.tray_scan.empty() && !context_.robot->profile.tray_link.empty()) {
    tray_markers_ = nh->advertise<visualization_msgs::MarkerArray>("tray_markers", 2);
    SubscribeTo<sensor_msgs::LaserScan>(nh, names.sensors.tray_scan, 100,
                                        [this](const auto& msg) { sensors_.OnTrayScan(msg); });
  }
  SubscribeTo<hires::Detections>(nh, kDetections, 100,
                                 [this](const auto& msg) { sensors_.OnDetections(msg); });
  SubscribeTo<hires::ObjectTemperatures>(nh, kObjectTemperatures, 100, [this](const auto& msg) {
    tracker_.OnTemperatures(sensors_.TemperaturesOf(msg));
  });
  subscribers_.push_back(nh->subscribe(action + "/goal", 10, &Self::OnGoal, this, hints));
  subscribers_.push_back(nh->subscribe(action + "/result", 10, &Self::OnResult, this, hints));
}

// What comes in --------------------------------------------------------------------------------

/// After each message, whatever it made complete is made use of.
template <typename Message>
void WorldTrackerNode::SubscribeTo(ros::NodeHandle* nh, const std::string& topic, int queue,
                                   std::function<void(const Message&)> take) {
  subscribers_.push_back(nh->subscribe<Message>(
      topic, static_cast<std::uint32_t>(queue),
      boost::function<void(const Message&)>([this, take = std::move(take)](const Message& msg) {
        take(msg);
        tracker_.Process();
        ShowTray();
      }),
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

void WorldTrackerNode::OnScan(const sensor_msgs::LaserScan& msg) {
  const auto receipt =
      floor_->OnScan(msg.header.stamp.toSec(), msg.header.frame_id, ReadingOf(msg));
  for (const sensing::Receipt& one : {receipt, floor_->receipt()})
    if (one.is_bad()) sensors_.Refuse(params_.files.names.base_scan, sensing::ToString(one));
}

void WorldTrackerNode::OnCloud(const sensor_msgs::PointCloud2& msg) {
  const std::string& topic = params_.files.names.sensors.tilt_cloud;
  try {
    const auto receipt =
        floor_->OnCloud(msg.header.stamp.toSec(), msg.header.frame_id, FromMsg(msg));
    for (const sensing::Receipt& one : {receipt, floor_->cloud_receipt()})
      if (one.is_bad()) sensors_.Refuse(topic, sensing::ToString(one));
  } catch (const hires::base::ConfigError& error) {
    sensors_.Refuse(topic, error.what());
  }
}

void WorldTrackerNode::OnGoal(const hires::ExecuteActionActionGoal& msg) {
  running_[msg.goal_id.id] = msg.goal.action.name;
  TellActions();
}

void WorldTrackerNode::OnResult(const hires::ExecuteActionActionResult& msg) {
  running_.erase(msg.status.goal_id.id);
  TellActions();
}

void WorldTrackerNode::TellActions() {
  std::vector<std::string> names;
  for (const auto& [goal, name] : running_) names.push_back(name);
  tracker_.OnActions(actions_->catalogue(), names);
}

// What is made of it ---------------------------------------------------------------------------

hires::control::WorldTracker::Hooks WorldTrackerNode::TrackerHooks() {
  return {[this](const sensing::RobotEstimate& now, const std::vector<robot::SeenObject>& known) {
            PublishKnown(now, known);
          },
          [this](const robot::JointTrajectory& turn) { head_.Send(turn); },
          [this](double time, translation::ObservedWorld observed) {
            writer_.Post(time, std::move(observed));
          },
          [this](const std::string& why) { sensors_.Warn(kDetections, why); },
          [this] {
            if (is_view_new_.exchange(false)) ReadView();
          }};
}

void WorldTrackerNode::ReadView() {
  writer_.view().Read([this](const knowledge::FluentView& view) {
    for (const std::string& why : tracker_.OnView(context_, view)) sensors_.Warn(kBlackboard, why);
  });
}

void WorldTrackerNode::PublishKnown(const sensing::RobotEstimate& now,
                                    const std::vector<robot::SeenObject>& known) {
  hires::WorldState msg = ToMsg(hires::control::WorldOf(known));
  msg.header.stamp.fromSec(now.time);
  msg.header.frame_id = params_.files.names.map_frame;
  known_.publish(msg);
}

void WorldTrackerNode::ShowTray() {
  const sensing::ObjectEstimator& objects = *sensors_.objects();
  if (objects.num_scans() == num_shown_) return;
  num_shown_ = objects.num_scans();
  if (tray_markers_.getNumSubscribers() == 0) return;
  tray_markers_.publish(TrayMarkers(*objects.memory().tray(), params_.files.names.base_frame));
}

// How it is ------------------------------------------------------------------------------------

void WorldTrackerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const sensing::Missing lack = sensors_.state().MissingNow();
  const std::string missing =
      sensors_.NameOf(lack == sensing::Missing::kNothing ? tracker_.lack() : lack);
  if (!missing.empty()) {
    status.summary(DiagnosticStatus::WARN, "waits for " + missing);
  } else if (!writer_.view().is_connected()) {
    status.summary(DiagnosticStatus::WARN, "the Blackboard is away");
  } else {
    status.summary(DiagnosticStatus::OK, "tracks");
  }
  status.add("moments", tracker_.num_moments());
  status.add("looks", tracker_.num_looks());
  status.add("moments dropped", tracker_.num_dropped());
  status.add("looks dropped", sensors_.objects()->num_dropped());
  status.add("looks outdated", sensors_.objects()->num_outdated());
  status.add("bad messages", sensors_.num_bad());
  status.add("objects remembered", sensors_.objects()->memory().objects().size());
  if (floor_) status.add("things on the floor", floor_->things().size());
  if (tray_markers_) {
    const auto& tray = sensors_.objects()->memory().tray();
    status.add("scans of the tray", sensors_.objects()->num_scans());
    status.add("things on the tray", tray ? tray->reading.things.size() : 0);
  }
  status.add("objects vanished", sensors_.objects()->memory().Vanished().size());
  status.add("things ambiguous in the last look", sensors_.objects()->memory().num_ambiguous());
  status.add("things that may be beside the table", sensors_.objects()->memory().num_beside());
  status.add("head looks at", tracker_.sweep().target());
  status.add("fluents written", writer_.num_written());
  status.add("failed writes", writer_.num_failures());
  status.add("last failure", writer_.last_failure());
}

}  // namespace hires_ros
