// Tells on standard output, one line each, how requests and workers get on:
//
//   imagination_watcher <n>
//
//   feedback done=<rollouts> wanted=<rollouts> workers=<alive> goal=<id>
//   result outcome=<code> status=<actionlib code> predictions=<number> goal=<id>
//   worker=<k> active=<goals waiting or being played>      on each change, k = 1 .. n
//
// "watching" comes first, when the imagination client is connected.

#include <actionlib_msgs/GoalStatusArray.h>
#include <hires/ImagineActionFeedback.h>
#include <hires/ImagineActionResult.h>
#include <ros/ros.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace {

using actionlib_msgs::GoalStatus;

bool IsActive(const GoalStatus& goal) {
  return goal.status == GoalStatus::PENDING || goal.status == GoalStatus::ACTIVE ||
         goal.status == GoalStatus::PREEMPTING || goal.status == GoalStatus::RECALLING;
}

class Watcher {
 public:
  Watcher(int num_workers, ros::NodeHandle* nh) {
    subscribers_.push_back(nh->subscribe("imagine/feedback", 1000, &Watcher::OnFeedback, this));
    subscribers_.push_back(nh->subscribe("imagine/result", 1000, &Watcher::OnResult, this));
    for (int k = 1; k <= num_workers; ++k) {
      const boost::function<void(const actionlib_msgs::GoalStatusArrayConstPtr&)> on_status =
          [this, k](const actionlib_msgs::GoalStatusArrayConstPtr& status) {
            OnStatus(k, *status);
          };
      subscribers_.push_back(
          nh->subscribe("/worker_" + std::to_string(k) + "/rollout/status", 1000, on_status));
    }
    timer_ = nh->createWallTimer(ros::WallDuration(0.01), &Watcher::OnTick, this);
  }

 private:
  void OnTick(const ros::WallTimerEvent& /*event*/) {
    if (subscribers_[0].getNumPublishers() == 0 || subscribers_[1].getNumPublishers() == 0) return;
    std::cout << "watching" << std::endl;
    timer_.stop();
  }

  void OnFeedback(const hires::ImagineActionFeedback& message) {
    std::cout << "feedback done=" << message.feedback.rollouts_done
              << " wanted=" << message.feedback.rollouts_wanted
              << " workers=" << message.feedback.workers << " goal=" << message.status.goal_id.id
              << std::endl;
  }

  void OnResult(const hires::ImagineActionResult& message) {
    std::cout << "result outcome=" << static_cast<int>(message.result.outcome)
              << " status=" << static_cast<int>(message.status.status)
              << " predictions=" << message.result.predictions.size()
              << " goal=" << message.status.goal_id.id << std::endl;
  }

  void OnStatus(int worker, const actionlib_msgs::GoalStatusArray& status) {
    const auto active =
        std::count_if(status.status_list.begin(), status.status_list.end(), IsActive);
    const auto known = active_.find(worker);
    if (known != active_.end() && known->second == active) return;
    active_[worker] = active;
    std::cout << "worker=" << worker << " active=" << active << std::endl;
  }

  std::vector<ros::Subscriber> subscribers_;
  std::map<int, long> active_;
  ros::WallTimer timer_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "imagination_watcher", ros::init_options::AnonymousName);
  ros::NodeHandle nh;
  const Watcher watcher(argc > 1 ? std::stoi(argv[1]) : 0, &nh);
  ros::spin();
  return 0;
}
