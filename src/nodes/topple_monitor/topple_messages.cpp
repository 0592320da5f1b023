#include "nodes/topple_monitor/topple_messages.h"

namespace hires_ros {
namespace {

const ros::Duration kBack(hires::knowledge::kDynamicsDelay);

hires::Dynamics DynamicsOf(double vel, double acc, double jerk) {
  hires::Dynamics msg;
  msg.vel = static_cast<float>(vel);
  msg.acc = static_cast<float>(acc);
  msg.jerk = static_cast<float>(jerk);
  return msg;
}

hires::BaseDynamics ToMsg(const hires::knowledge::Dynamics& dynamics,
                          const std_msgs::Header& header) {
  hires::BaseDynamics msg;
  msg.header = header;
  if (header.stamp > ros::Time(0) + kBack) msg.header.stamp = header.stamp - kBack;
  msg.linear = DynamicsOf(dynamics.v, dynamics.a, dynamics.j);
  msg.angular = DynamicsOf(dynamics.angular_v, dynamics.angular_a, dynamics.angular_j);
  return msg;
}

}  // namespace

hires::ToppleEpisodePart ToMsg(const hires::knowledge::ToppleEpisodePart& part,
                               const std_msgs::Header& header, const std::string& base_frame) {
  hires::ToppleEpisodePart msg;
  msg.header = header;
  msg.EpisodeID = part.episode;
  msg.state = ToString(part.state);
  msg.obj_dev.header = header;
  msg.obj_dev.header.frame_id = base_frame;
  msg.obj_dev.vector.x = part.alpha;
  msg.obj_dev.vector.y = part.deviation;
  msg.obj_dyn = ToMsg(part.object, header);
  msg.base_dyn = ToMsg(part.base, header);
  msg.base_dyn.pose.header = header;
  msg.base_dyn.pose.x = static_cast<float>(part.x);
  msg.base_dyn.pose.y = static_cast<float>(part.y);
  msg.base_dyn.pose.alpha = static_cast<float>(part.yaw);
  return msg;
}

}  // namespace hires_ros
