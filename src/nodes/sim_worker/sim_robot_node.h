#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/Twist.h>
#include <hires/LockstepAck.h>
#include <hires/ObjectRequest.h>
#include <hires/PlaceObject.h>
#include <hires/PushRobot.h>
#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "hires/base/mailbox.h"
#include "hires/simulation/command_inbox.h"
#include "hires/simulation/truth_record.h"
#include "nodes/sim_worker/sim_robot_params.h"
#include "nodes/sim_worker/sim_robot_publisher.h"
#include "sim_robot/sim_robot_world.h"

namespace hires_ros {

struct Pr2GripperCommand;

/// Plays the real robot and its world under the main master, with the topics of a PR2: a node that
/// works with the one works with the other. Its world has a truth of its own, drawn once, which
/// shows only below ground_truth/ for evaluation and which no node that decides may look at.
///
/// The world goes on in ticks of 0.05 s, at `pace` times real time. In lockstep it waits at each
/// tick until the middle layer has answered it and everything that it commanded is here, so that
/// load on the machine changes nothing about what happens. It does not wait for a middle layer that
/// is not there, or ends.
class SimRobotNode {
 public:
  SimRobotNode(const SimRobotParams& params, const hires::imagination::ImaginationSetup& setup,
               ros::NodeHandle* nh);
  ~SimRobotNode();

 private:
  using Steady = std::chrono::steady_clock;
  using Mail = std::function<void()>;  // runs on the thread that simulates

  void AdvertiseTick(ros::NodeHandle* nh);
  void Subscribe(ros::NodeHandle* nh);
  void Serve(ros::NodeHandle* nh);
  template <typename Message>
  void SubscribeTo(ros::NodeHandle* nh, const std::string& topic,
                   std::function<hires::robot::Command(const Message&)> convert);
  void SubscribeToGroup(ros::NodeHandle* nh, const std::string& group, const std::string& topic);
  void SubscribeToGripper(ros::NodeHandle* nh, const std::string& arm, const std::string& topic);
  void OnAck(const ros::MessageEvent<const hires::LockstepAck>& event);
  std::string Change(std::function<std::string()> change);  ///< waits for it; why not, or empty

  void Simulate();
  void Tick();  ///< sensors of this moment, and what follows from them
  void AdvanceOneTick();
  void Listen();  ///< hands gathered commands to the robot
  void AwaitRelease();
  void AwaitAck();
  bool IsAnswered() const;
  bool IsMiddleLayerThere() const;
  void AwaitPace();
  void ReadMail(std::chrono::duration<double> timeout);  ///< all there is; waits for the first
  void PublishTick();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const SimRobotParams params_;
  const hires::robot::Robot& robot_;
  hires::sim_robot::SimRobotWorld world_;
  SimRobotPublisher publisher_;
  hires::simulation::TruthRecord truth_;
  hires::simulation::CommandInbox inbox_;

  struct Ack {
    std::string sender;
    ros::Time stamp;
    std::uint64_t num_commands;
  };
  std::optional<Ack> ack_;                   // of the present tick
  std::optional<std::string> middle_layer_;  // who acknowledged last
  std::multiset<std::string> listeners_;     // to ticks, by node
  hires::sim_robot::SensorReadings readings_;
  std::atomic<bool> is_held_;
  int num_steps_{0};        // ticks to play while held
  Steady::time_point due_;  // when the next tick is, at the wanted pace

  hires::base::Mailbox<Mail> mail_;
  std::atomic<bool> stop_{false};
  std::atomic<double> simulated_{0.0};  // [s]
  std::atomic<long> num_waits_given_up_{0};
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber ack_subscriber_;
  ros::Publisher tick_;
  std::vector<ros::ServiceServer> services_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer heartbeat_;
  std::thread thread_;
};

}  // namespace hires_ros
