#include "nodes/world_tracker/world_tracker_node.h"

#include <algorithm>
#include <limits>

#include "hires/actions/catalogue.h"
#include "hires/base/action.h"
#include "hires/ros/conversions.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"
#include "hires/ros/topic_names.h"
#include "hires/skills/action_loader.h"
#include "hires/translation/task_places.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
namespace perception = hires::perception;
namespace robot = hires::robot;
namespace sensing = hires::sensing;
namespace translation = hires::translation;

constexpr double kKnownPeriod = 0.1;  // [s] at most, between words about known objects
constexpr int kQueue = 1000;          // ten seconds of what comes at 100 Hz
constexpr double kNever = -1e9;       // [s]
constexpr double kForever = std::numeric_limits<double>::infinity();

}  // namespace

WorldTrackerNode::WorldTrackerNode(const WorldTrackerParams& params,
                                   translation::TranslatorContext context, ros::NodeHandle* nh)
    : params_(params),
      context_(std::move(context)),
      actions_(hires::skills::LoadActionSet(params.action_libraries)),
      sensors_(context_.robot, std::make_shared<const perception::Surroundings>(*context_.world),
               params.files.names, params.sensing),
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
  const hires::control::RobotNames& names = params_.files.names;
  // A robot whose head must not be turned has no publisher for it.
  const auto head = names.trajectories.find("head");
  if (params_.sweep.enabled && head != names.trajectories.end()) {
    head_ = nh->advertise<trajectory_msgs::JointTrajectory>(head->second, 10);
  }
  SubscribeTo<nav_msgs::Odometry>(nh, names.odometry, kQueue,
                                  [this](const auto& msg) { sensors_.OnOdometry(msg); });
  SubscribeTo<sensor_msgs::JointState>(nh, names.joint_states, kQueue,
                                       [this](const auto& msg) { sensors_.OnJoints(msg); });
  SubscribeTo<tf2_msgs::TFMessage>(nh, kTransforms, kQueue,
                                   [this](const auto& msg) { sensors_.OnTransforms(msg, false); });
  SubscribeTo<tf2_msgs::TFMessage>(nh, kStaticTransforms, 100,
                                   [this](const auto& msg) { sensors_.OnTransforms(msg, true); });
  SubscribeTo<hires::Detections>(nh, kDetections, 100,
                                 [this](const auto& msg) { sensors_.OnDetections(msg); });
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
        Process();
      }),
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
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
  const bool is_busy = std::any_of(running_.begin(), running_.end(), [this](const auto& running) {
    return hires::actions::MayUseHead(actions_->catalogue(), running.second);
  });
  sweep_.SetBusy(is_busy, time_);
}

// What is made of it ---------------------------------------------------------------------------

void WorldTrackerNode::Process() {
  while (const auto time = NextMoment()) Handle(*time);
}

/// The next joint states or look, once nothing can change any more what is known of that time.
std::optional<double> WorldTrackerNode::NextMoment() const {
  const bool is_restarted = restarts_ != sensors_.state().num_restarts();
  const double last = is_restarted ? kNever : time_;
  const auto joints = sensors_.state().NextJoints(last);
  const auto look = sensors_.objects()->NextLook(last);
  if (!joints && !look) return std::nullopt;
  const double next = std::min(joints.value_or(kForever), look.value_or(kForever));
  if (!sensors_.state().IsSettled(next)) return std::nullopt;
  return next;
}

void WorldTrackerNode::Handle(double time) {
  if (restarts_ != sensors_.state().num_restarts()) published_ = kNever;
  restarts_ = sensors_.state().num_restarts();
  time_ = time;
  lack_ = sensors_.state().MissingAt(time);
  if (lack_ != sensing::Missing::kNothing) {
    ++num_dropped_;
    sensors_.objects()->DropUntil(time);  // else it would be the next moment for good
    return;
  }
  ++num_moments_;
  const sensing::RobotEstimate now = *sensors_.state().At(time);
  if (is_view_new_.exchange(false)) ReadView();
  const sensing::LookNews news = sensors_.Update(now);
  num_looks_ += static_cast<std::uint64_t>(news.num_looks);
  const auto known = sensors_.objects()->memory().Known(now.Body());
  const bool is_due = news.has_changed_hands || time - published_ >= kKnownPeriod;
  if (news.num_looks > 0 || (is_due && !params_.lockstep)) PublishKnown(now, known);
  const auto turn = sweep_.Update(now.Body(), news.newest_look == time, known);
  if (turn && head_) head_.publish(ToMsg(*turn));
  writer_.Post(time, Observed(now, known));
}

/// What others say of objects, and what tasks are about.
void WorldTrackerNode::ReadView() {
  writer_.view().Read([this](const knowledge::FluentView& view) {
    const translation::TranslatorContext context = writer_.ContextNow(view);
    std::vector<sensing::StatedObject> stated;
    for (const auto& object : translation::StatedObjects(context, view)) {
      stated.push_back({object.name, object.model, object.link, object.X_LO});
    }
    for (const std::string& why : sensors_.objects()->OnStated(stated)) {
      sensors_.Warn(kBlackboard, why);
    }
    sweep_.SetPlaces(translation::PlacesOfTasks(context, view), context.areas);
  });
}

void WorldTrackerNode::PublishKnown(const sensing::RobotEstimate& now,
                                    const std::vector<robot::SeenObject>& known) {
  published_ = now.time;
  hires::world::WorldState state;
  for (const robot::SeenObject& object : known) {
    state.objects.push_back({object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  hires::WorldState msg = ToMsg(state);
  msg.header.stamp.fromSec(now.time);
  msg.header.frame_id = params_.files.names.map_frame;
  known_.publish(msg);
}

translation::ObservedWorld WorldTrackerNode::Observed(
    const sensing::RobotEstimate& now, const std::vector<robot::SeenObject>& known) const {
  const sensing::ObjectMemory& memory = sensors_.objects()->memory();
  translation::ObservedWorld observed;
  observed.state.robot = {now.X_WB, now.V_B, now.posture};
  for (const robot::SeenObject& object : known) {
    const sensing::RememberedObject& remembered = memory.objects().at(object.name);
    if (!remembered.is_observed && !remembered.is_held) continue;  // others' word
    observed.state.world.objects.push_back(
        {object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  observed.vanished = memory.Vanished();
  return observed;
}

// How it is ------------------------------------------------------------------------------------

void WorldTrackerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const sensing::Missing lack = sensors_.state().MissingNow();
  const std::string missing = sensors_.NameOf(lack == sensing::Missing::kNothing ? lack_ : lack);
  if (!missing.empty()) {
    status.summary(DiagnosticStatus::WARN, "waits for " + missing);
  } else if (!writer_.view().is_connected()) {
    status.summary(DiagnosticStatus::WARN, "the Blackboard is away");
  } else {
    status.summary(DiagnosticStatus::OK, "tracks");
  }
  status.add("moments", num_moments_);
  status.add("looks", num_looks_);
  status.add("moments dropped", num_dropped_);
  status.add("looks dropped", sensors_.objects()->num_dropped());
  status.add("looks outdated", sensors_.objects()->num_outdated());
  status.add("bad messages", sensors_.num_bad());
  status.add("objects remembered", sensors_.objects()->memory().objects().size());
  status.add("objects vanished", sensors_.objects()->memory().Vanished().size());
  status.add("head looks at", sweep_.target());
  status.add("fluents written", writer_.num_written());
  status.add("failed writes", writer_.num_failures());
  status.add("last failure", writer_.last_failure());
}

}  // namespace hires_ros
