#pragma once

#include <string>

namespace hires::base {

/// "2026-11-26-04-03-59": the computer's clock where it stands, as `rosbag record` names its bags.
std::string LocalTime();

}  // namespace hires::base
