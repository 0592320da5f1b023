#include "nodes/middle_layer/lockstep_client.h"

#include <ros/this_node.h>

#include <algorithm>

#include "hires/ros/names/robot_topics.h"

namespace hires_ros {
LockstepClient::LockstepClient(ros::NodeHandle* nh, std::function<void()> due)
    : due_(std::move(due)),
      ack_(nh->advertise<hires::LockstepAck>(kLockstepAck, 10)),
      ticks_(nh->subscribe(kLockstepTick, 10, &LockstepClient::OnTick, this,
                           ros::TransportHints().tcpNoDelay())) {}

void LockstepClient::OnTick(const hires::LockstepTick& msg) {
  awaited_ = msg.awaited;
  // A tick is repeated where the answer is late, or went before the robot listened.
  if (tick_ && tick_->header.stamp == msg.header.stamp) {
    if (is_taken_) return;
    tick_->sensors = msg.sensors;  // one that would have said something may have ended meanwhile
    return due_();
  }
  if (acked_ && acked_->header.stamp == msg.header.stamp) {
    ack_.publish(*acked_);
    return;
  }
  tick_ = msg;
  is_taken_ = false;
  due_();
}

void LockstepClient::NoteArrival(const std::string& topic, double stamp) {
  double& newest = arrived_[topic];
  newest = std::max(newest, stamp);
}

bool LockstepClient::IsComplete(const hires::LockstepTick& tick) const {
  const double stamp = tick.header.stamp.toSec();
  return std::all_of(tick.sensors.begin(), tick.sensors.end(), [&](const std::string& topic) {
    const auto arrived = arrived_.find(topic);
    return arrived != arrived_.end() && arrived->second >= stamp - kSameStamp;
  });
}

std::optional<double> LockstepClient::TakeDue() {
  if (!tick_ || is_taken_ || !IsComplete(*tick_)) return std::nullopt;
  is_taken_ = true;
  return tick_->header.stamp.toSec();
}

void LockstepClient::Answer(std::uint64_t num_commands) {
  hires::LockstepAck ack;
  ack.header.stamp = tick_->header.stamp;
  ack.num_commands = num_commands;
  tick_.reset();
  acked_ = ack;
  ack_.publish(ack);
}

bool LockstepClient::is_awaited() const { return awaited_ == ros::this_node::getName(); }

}  // namespace hires_ros
