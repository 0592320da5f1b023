#pragma once

#include <ros/publisher.h>

namespace hires_ros {

/// Whether anybody listens; not to a topic that was never advertised.
inline bool IsHeard(const ros::Publisher& publisher) {
  return publisher && publisher.getNumSubscribers() > 0;
}

}  // namespace hires_ros
