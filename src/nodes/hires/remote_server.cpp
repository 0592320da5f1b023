#include "nodes/hires/remote_server.h"

#include <fmt/format.h>
#include <ros/duration.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/time.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/process.h"

namespace hires_ros {

bool PollUntil(const std::function<bool()>& is_so, double wait,
               const std::function<bool()>& cancelled) {
  const double give_up = hires::base::SteadyNow() + wait;
  while (!is_so()) {
    if (cancelled() || hires::base::SteadyNow() > give_up) return false;
    ros::WallDuration(kPollPeriod).sleep();
  }
  return true;
}

void RequireMaster(const std::string& launch_file, const std::string& otherwise) {
  if (ros::master::check()) return;
  throw hires::base::ConfigError(fmt::format(
      "no ROS master answers at {}; start one (roslaunch hires {}){} set ROS_MASTER_URI{}",
      ros::master::getURI(), launch_file, otherwise.empty() ? ", or" : ",",
      otherwise.empty() ? "" : ", or " + otherwise));
}

double AwaitPublisher(const std::string& topic, double wait, const std::function<bool()>& cancelled,
                      const std::string& launch_file) {
  const double give_up = hires::base::SteadyNow() + wait;
  const std::string name = ros::names::resolve(topic);
  const auto is_published = [&] {
    ros::master::V_TopicInfo topics;
    if (!ros::master::check() || !ros::master::getTopics(topics)) return false;
    return std::any_of(topics.begin(), topics.end(),
                       [&](const ros::master::TopicInfo& each) { return each.name == name; });
  };
  while (!is_published() && !cancelled() && hires::base::SteadyNow() < give_up) {
    ros::WallDuration(kPollPeriod).sleep();
  }
  RequireMaster(launch_file);
  return std::max(0.0, give_up - hires::base::SteadyNow());
}

void RequireTime(double wait, const std::function<bool()>& cancelled) {
  ros::start();  // listens to /clock
  if (PollUntil([] { return ros::Time::isValid(); }, wait, cancelled)) return;
  throw hires::base::ConfigError(
      fmt::format("/use_sim_time is true at {}, and nobody publishes /clock: start what simulates "
                  "the time, or, where that has ended, rosparam set use_sim_time false",
                  ros::master::getURI()));
}

}  // namespace hires_ros
