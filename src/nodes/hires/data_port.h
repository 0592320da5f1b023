#pragma once

#include <optional>
#include <string>

#include "hires/relay/uri.h"

namespace hires_ros {

/// Where a node serves the data of a topic that it publishes, as it says itself; nothing if it does
/// not answer, or has no such topic.
/// @param timeout  [s]
std::optional<hires::relay::Endpoint> AskDataPort(const hires::relay::Endpoint& node,
                                                  const std::string& topic,
                                                  const std::string& caller_id, double timeout);

}  // namespace hires_ros
