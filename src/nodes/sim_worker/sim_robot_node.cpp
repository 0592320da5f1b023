#include "nodes/sim_worker/sim_robot_node.h"

#include <fmt/format.h>
#include <hires/LockstepTick.h>
#include <ros/ros.h>

#include <algorithm>
#include <future>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/controller_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::base::LogLevel;
using hires::control::GripperInterface;
using hires::control::TrajectoryInterface;
using hires::robot::Command;
using hires::sim_robot::kJointTick;
using hires::sim_robot::kSensorTick;

constexpr auto kShort = std::chrono::milliseconds(20);    // between two looks at stop_
constexpr auto kRepeat = std::chrono::milliseconds(100);  // an unanswered tick is sent again
constexpr auto kLostCommand = std::chrono::seconds(2);    // announced, and has not come
constexpr auto kLag = std::chrono::milliseconds(200);     // that is made up for; more is not

}  // namespace

SimRobotNode::SimRobotNode(const SimRobotParams& params,
                           const hires::imagination::ImaginationSetup& setup, ros::NodeHandle* nh)
    : params_(params),
      robot_(setup.scene->robot),
      world_(setup, hires::sim_robot::StartOf(setup, params.scenario, params.area), params.seed,
             params.truth),
      publisher_(params, setup, world_, nh),
      truth_(setup.standing),
      is_held_(params.hold) {
  truth_.Look(world_.simulator());
  nh->setParam(params.names.robot_description,
               hires::robot::ReadUrdfOf(params.setup.robot, robot_.profile));
  AdvertiseTick(nh);
  Subscribe(nh);
  Serve(nh);
  updater_.setHardwareID("simulated " + robot_.model.name);
  updater_.add("simulation", this, &SimRobotNode::Diagnose);
  heartbeat_ = nh->createWallTimer(ros::WallDuration(1.0),
                                   boost::function<void(const ros::WallTimerEvent&)>(
                                       [this](const ros::WallTimerEvent&) { updater_.update(); }));
  thread_ = std::thread([this] { Simulate(); });
}

SimRobotNode::~SimRobotNode() {
  stop_ = true;
  thread_.join();
}

/// A subscriber that ends is gone at once; a publisher that ends is looked for for a while.
void SimRobotNode::AdvertiseTick(ros::NodeHandle* nh) {
  using Peer = ros::SingleSubscriberPublisher;
  tick_ = nh->advertise<hires::LockstepTick>(
      kLockstepTick, 10,
      [this](const Peer& peer) {
        mail_.Post([this, name = peer.getSubscriberName()] { listeners_.insert(name); });
      },
      [this](const Peer& peer) {
        mail_.Post([this, name = peer.getSubscriberName()] {
          const auto listener = listeners_.find(name);
          if (listener != listeners_.end()) listeners_.erase(listener);
          if (listeners_.count(name) == 0) inbox_.Forget(name);
        });
      });
}

// What comes from outside
// ---------------------------------------------------------------------------

template <typename Message>
void SimRobotNode::SubscribeTo(ros::NodeHandle* nh, const std::string& topic,
                               std::function<Command(const Message&)> convert) {
  using Event = ros::MessageEvent<const Message>;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Event&>(
      topic, 100, boost::function<void(const Event&)>([this, topic, convert](const Event& event) {
        Command command;  // a bad one counts as a message all the same
        try {
          command = convert(*event.getMessage());
        } catch (const ConfigError& error) {
          hires::base::Log(LogLevel::kWarn, error.what());
        }
        mail_.Post(
            [this, sender = event.getPublisherName(), command] { inbox_.Add(sender, command); });
      }));
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(nh->subscribe(options));
}

void SimRobotNode::Subscribe(ros::NodeHandle* nh) {
  SubscribeTo<geometry_msgs::Twist>(nh, kSimulatedBase, [](const geometry_msgs::Twist& msg) {
    Command command;
    command.base_velocity = FromMsg(msg, kSimulatedBase);
    return command;
  });
  for (const auto& [group, topic] : params_.names.trajectories) SubscribeToGroup(nh, group, topic);
  for (const auto& [arm, topic] : params_.names.grippers) SubscribeToGripper(nh, arm, topic);
  ack_subscriber_ = nh->subscribe<hires::LockstepAck>(
      kLockstepAck, 10,
      boost::function<void(const ros::MessageEvent<const hires::LockstepAck>&)>(
          [this](const ros::MessageEvent<const hires::LockstepAck>& event) { OnAck(event); }),
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

void SimRobotNode::SubscribeToGroup(ros::NodeHandle* nh, const std::string& group,
                                    const std::string& topic) {
  const auto joints = robot_.profile.upper_body
                          ? hires::robot::JointsOfGroup(*robot_.profile.upper_body, group)
                          : std::vector<std::string>{};
  const auto command_of = [joints, group, topic](const trajectory_msgs::JointTrajectory& msg) {
    Command command;
    command.trajectories[group] = FromMsg(msg, joints, topic);
    return command;
  };
  if (params_.names.trajectory_interface == TrajectoryInterface::kFollowJointTrajectory) {
    using Goal = FollowJointTrajectoryActionGoal;
    SubscribeTo<Goal>(nh, topic,
                      [command_of](const Goal& goal) { return command_of(goal.trajectory); });
  } else {
    SubscribeTo<trajectory_msgs::JointTrajectory>(nh, topic, command_of);
  }
}

void SimRobotNode::SubscribeToGripper(ros::NodeHandle* nh, const std::string& arm,
                                      const std::string& topic) {
  const auto command_of = [arm](const auto& msg) {
    Command command;
    command.grippers[arm] = {msg.position, msg.max_effort};
    return command;
  };
  if (params_.names.gripper_interface == GripperInterface::kGripperCommand) {
    SubscribeTo<GripperCommandActionGoal>(nh, topic, command_of);
  } else {
    SubscribeTo<Pr2GripperCommand>(nh, topic, command_of);
  }
}

void SimRobotNode::OnAck(const ros::MessageEvent<const hires::LockstepAck>& event) {
  const hires::LockstepAck& msg = *event.getMessage();
  mail_.Post([this, ack = Ack{event.getPublisherName(), msg.header.stamp, msg.num_commands}] {
    middle_layer_ = ack.sender;
    if (ack.stamp == SimRobotPublisher::StampOf(world_)) ack_ = ack;
  });
}

std::string SimRobotNode::Change(std::function<std::string()> change) {
  auto answer = std::make_shared<std::promise<std::string>>();
  auto future = answer->get_future();
  mail_.Post([change = std::move(change), answer] { answer->set_value(change()); });
  while (future.wait_for(kShort) != std::future_status::ready) {
    if (stop_ || !ros::ok()) return "the simulated robot is being shut down";
  }
  return future.get();
}

void SimRobotNode::Serve(ros::NodeHandle* nh) {
  const auto serve = [&](const std::string& name, auto request_type, auto response_type,
                         auto change) {
    using Request = decltype(request_type);
    using Response = decltype(response_type);
    services_.push_back(nh->advertiseService(
        "sim_robot/" + name, boost::function<bool(Request&, Response&)>(
                                 [this, change](Request& request, Response& response) {
                                   response.message = Change([&] { return change(request); });
                                   response.success = response.message.empty();
                                   return true;
                                 })));
  };
  serve("push", hires::PushRobotRequest(), hires::PushRobotResponse(),
        [this](const hires::PushRobotRequest& request) {
          truth_.ForgetPosition();
          return world_.Push({request.offset.x, request.offset.y, request.offset.theta});
        });
  serve("remove_object", hires::ObjectRequestRequest(), hires::ObjectRequestResponse(),
        [this](const hires::ObjectRequestRequest& request) { return world_.Remove(request.name); });
  serve("drop", hires::ObjectRequestRequest(), hires::ObjectRequestResponse(),
        [this](const hires::ObjectRequestRequest& request) { return world_.Drop(request.name); });
  serve("place_object", hires::PlaceObjectRequest(), hires::PlaceObjectResponse(),
        [this](const hires::PlaceObjectRequest& request) {
          std::string refusal = world_.Place(request.name, request.model, FromMsg(request.pose));
          if (refusal.empty()) truth_.ForgetPlaceOf(request.name);
          return refusal;
        });
  serve("hold", std_srvs::SetBoolRequest(), std_srvs::SetBoolResponse(),
        [this](const std_srvs::SetBoolRequest& request) {
          is_held_ = request.data != 0;
          num_steps_ = 0;
          return std::string();
        });
  serve("step", std_srvs::TriggerRequest(), std_srvs::TriggerResponse(),
        [this](const std_srvs::TriggerRequest&) {
          if (!is_held_) return std::string("time goes on by itself; call sim_robot/hold first");
          ++num_steps_;
          return std::string();
        });
}

// The thread that simulates
// -------------------------------------------------------------------------

void SimRobotNode::Simulate() {
  due_ = Steady::now();
  while (!stop_) {
    try {
      Tick();
    } catch (const ConfigError& error) {  // a command that the robot cannot follow
      hires::base::Log(LogLevel::kError, error.what());
    }
  }
}

void SimRobotNode::Tick() {
  readings_ = world_.Sense();
  PublishTick();
  AwaitRelease();
  if (params_.lockstep) AwaitAck();
  AwaitPace();
  AdvanceOneTick();
}

void SimRobotNode::PublishTick() {
  hires::LockstepTick tick;
  tick.header.stamp = SimRobotPublisher::StampOf(world_);
  tick.sensors = publisher_.PublishTick(world_, readings_, truth_);
  if (params_.lockstep && middle_layer_ && IsMiddleLayerThere()) tick.awaited = *middle_layer_;
  publisher_.PublishFast(world_, readings_);
  tick_.publish(tick);
}

void SimRobotNode::AdvanceOneTick() {
  for (long done = 0; done < kSensorTick; done += kJointTick) {
    if (done > 0) publisher_.PublishFast(world_, world_.Sense());
    if (done == 0 || !params_.lockstep) Listen();
    hires::sim_robot::PlayJointTick(&world_, &truth_,
                                    [this] { publisher_.PublishLook(world_, readings_); });
  }
  simulated_ = 0.001 * static_cast<double>(world_.milliseconds());
}

void SimRobotNode::Listen() {
  if (!params_.lockstep) ReadMail(std::chrono::seconds(0));
  world_.Apply(inbox_.Take());
}

void SimRobotNode::ReadMail(std::chrono::duration<double> timeout) {
  auto mail = mail_.WaitAndTake(timeout);
  for (; mail; mail = mail_.Take()) (*mail)();
}

/// A node that starts while it stands still must learn the time and what the sensors say.
void SimRobotNode::AwaitRelease() {
  auto repeat = Steady::now() + kRepeat;
  while (is_held_ && num_steps_ == 0 && !stop_) {
    ReadMail(kShort);
    if (Steady::now() < repeat) continue;
    PublishTick();
    repeat = Steady::now() + kRepeat;
  }
  num_steps_ = std::max(0, num_steps_ - 1);
}

void SimRobotNode::AwaitAck() {
  auto repeat = Steady::now() + kRepeat;
  std::optional<Steady::time_point> answered;
  while (!stop_ && IsMiddleLayerThere() && !IsAnswered()) {
    ReadMail(kShort);
    const auto now = Steady::now();
    if (ack_ && !answered) answered = now;
    if (answered && now - *answered > kLostCommand) {
      ++num_waits_given_up_;
      hires::base::Log(
          LogLevel::kWarn,
          fmt::format("lockstep: {} commanded {} times, {} have come; going on", ack_->sender,
                      ack_->num_commands, inbox_.num_from(ack_->sender)));
      break;
    }
    if (!ack_ && now > repeat) {
      PublishTick();
      repeat = now + kRepeat;
    }
  }
  ReadMail(std::chrono::seconds(0));
  if (ack_) inbox_.CountOff(ack_->sender, ack_->num_commands);
  ack_.reset();
}

bool SimRobotNode::IsMiddleLayerThere() const {
  return middle_layer_ ? listeners_.count(*middle_layer_) > 0
                       : ack_subscriber_.getNumPublishers() > 0 && !listeners_.empty();
}

bool SimRobotNode::IsAnswered() const {
  return ack_ && inbox_.num_from(ack_->sender) >= ack_->num_commands;
}

void SimRobotNode::AwaitPace() {
  if (params_.pace == 0.0) return;
  due_ = std::max(due_ + std::chrono::duration_cast<Steady::duration>(
                             std::chrono::duration<double>(0.001 * kSensorTick / params_.pace)),
                  Steady::now() - kLag);
  while (!stop_ && Steady::now() < due_) {
    ReadMail(std::min<std::chrono::duration<double>>(due_ - Steady::now(), kShort));
  }
}

void SimRobotNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, is_held_ ? "held" : "running");
  status.add("simulated [s]", simulated_.load());
  status.add("pace", params_.pace);
  status.add("lockstep", params_.lockstep);
  status.add("waits given up", num_waits_given_up_.load());
  status.add("pictures drawn", publisher_.num_drawn());
  if (publisher_.sees_pictures()) status.add("looks recognised", publisher_.num_recognised());
}

}  // namespace hires_ros
