#include "nodes/imagination_client/asker_watch.h"

#include <hires/ImagineActionGoal.h>
#include <hires/ImagineActionResult.h>
#include <ros/single_subscriber_publisher.h>

#include <algorithm>
#include <iterator>

#include "hires/base/process.h"

namespace hires_ros {

/// What is read here of an ImagineActionGoal. A type of its own, because roscpp shares one reader
/// among subscribers of a type, and where bytes are no message, the second one that reads them
/// reads freed memory. The action server subscribes, too.
struct AskedGoal {
  std::string id;
};

}  // namespace hires_ros

namespace ros::message_traits {

template <>
struct MD5Sum<hires_ros::AskedGoal> : MD5Sum<hires::ImagineActionGoal> {};
template <>
struct DataType<hires_ros::AskedGoal> : DataType<hires::ImagineActionGoal> {};

}  // namespace ros::message_traits

namespace ros::serialization {

template <>
struct Serializer<hires_ros::AskedGoal> {
  template <typename Stream>
  static void read(Stream& stream, hires_ros::AskedGoal& goal) {  // NOLINT: roscpp's form
    std_msgs::Header header;
    actionlib_msgs::GoalID id;
    stream.next(header);
    stream.next(id);
    goal.id = id.id;
  }
};

}  // namespace ros::serialization

namespace hires_ros {
namespace {

constexpr double kPatience = 2.0;  // [s] for a connection that broke to be there again
constexpr double kRemembered =
    600.0;  // [s] who left: its goal may be read later, not so much later

}  // namespace

AskerWatch::AskerWatch(const std::string& action, ros::NodeHandle* nh) {
  goals_ = nh->subscribe(action + "/goal", 50, &AskerWatch::OnGoal, this);
  result_ = nh->advertise<hires::ImagineActionResult>(
      action + "/result", 50,
      [this](const ros::SingleSubscriberPublisher& peer) {
        ++num_links_[peer.getSubscriberName()];
        left_.erase(peer.getSubscriberName());
      },
      [this](const ros::SingleSubscriberPublisher& peer) { OnLeft(peer.getSubscriberName()); });
}

/// A link that was made again may be told of before the end of the old one.
void AskerWatch::OnLeft(const std::string& node) {
  if (--num_links_[node] > 0) return;
  num_links_.erase(node);
  const double now = hires::base::SteadyNow();
  for (auto it = left_.begin(); it != left_.end();) {
    it = now - it->second > kRemembered ? left_.erase(it) : std::next(it);
  }
  left_[node] = now;
}

void AskerWatch::OnGoal(const ros::MessageEvent<const AskedGoal>& event) {
  asker_of_[event.getMessage()->id] = {event.getPublisherName(), hires::base::SteadyNow()};
}

std::string AskerWatch::GoneFor(const std::string& goal_id, double now) const {
  const auto asker = asker_of_.find(goal_id);
  if (asker == asker_of_.end()) return "";
  const auto left = left_.find(asker->second.node);
  if (left == left_.end()) return "";
  const double since = std::max(left->second, asker->second.asked);
  return now - since > kPatience ? asker->second.node : "";
}

}  // namespace hires_ros
