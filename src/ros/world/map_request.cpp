#include "hires/ros/world/map_request.h"

#include <nav_msgs/GetMap.h>
#include <ros/service.h>

#include <utility>

#include "hires/base/process.h"

namespace hires_ros {

void MapRequest::Ask() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (asked_) return;
    asked_ = hires::base::SteadyNow();
  }
  thread_.Post([this] { Call(); });
}

void MapRequest::Call() {
  nav_msgs::GetMap call;
  // First a probe: see ServiceLinks.
  const bool came = ros::service::exists(service_, false) && ros::service::call(service_, call);
  const std::lock_guard<std::mutex> lock(mutex_);
  asked_.reset();
  if (came) answer_ = std::move(call.response.map);
}

std::optional<nav_msgs::OccupancyGrid> MapRequest::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(answer_, std::nullopt);
}

double MapRequest::Waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return asked_ ? hires::base::SteadyNow() - *asked_ : 0.0;
}

}  // namespace hires_ros
