#include "nodes/imagination_client/asker_watch.h"

#include <hires/ImagineActionResult.h>
#include <ros/single_subscriber_publisher.h>

#include <algorithm>

#include "hires/base/process.h"

namespace hires_ros {
namespace {

constexpr double kPatience = 2.0;  // [s] for a connection that broke to be there again

}  // namespace

AskerWatch::AskerWatch(const std::string& action, ros::NodeHandle* nh) {
  goals_ = nh->subscribe(action + "/goal", 50, &AskerWatch::OnGoal, this);
  result_ = nh->advertise<hires::ImagineActionResult>(
      action + "/result", 50,
      [this](const ros::SingleSubscriberPublisher& peer) { left_.erase(peer.getSubscriberName()); },
      [this](const ros::SingleSubscriberPublisher& peer) {
        if (IsAsker(peer.getSubscriberName())) {
          left_[peer.getSubscriberName()] = hires::base::SteadyNow();
        }
      });
}

bool AskerWatch::IsAsker(const std::string& node) const {
  return std::any_of(asker_of_.begin(), asker_of_.end(),
                     [&](const auto& goal) { return goal.second == node; });
}

void AskerWatch::Forget(const std::string& goal_id) {
  const auto goal = asker_of_.find(goal_id);
  if (goal == asker_of_.end()) return;
  const std::string asker = goal->second;
  asker_of_.erase(goal);
  if (!IsAsker(asker)) left_.erase(asker);
}

void AskerWatch::OnGoal(const ros::MessageEvent<const hires::ImagineActionGoal>& event) {
  asker_of_[event.getMessage()->goal_id.id] = event.getPublisherName();
}

std::string AskerWatch::GoneFor(const std::string& goal_id, double now) const {
  const auto asker = asker_of_.find(goal_id);
  if (asker == asker_of_.end()) return "";
  const auto left = left_.find(asker->second);
  return left != left_.end() && now - left->second > kPatience ? asker->second : "";
}

}  // namespace hires_ros
