#pragma once

#include <hires/Detections.h>

#include <optional>

#include "hires/perception/detector.h"

namespace hires_ros {

/// A confidence of 0, which the recogniser did not tell, counts as 1; an empty instance as not
/// known.
hires::perception::Detection FromMsg(const hires::Detection& msg);
hires::Detection ToMsg(const hires::perception::Detection& detection);

/// @return nothing of one who could not look.
std::optional<hires::perception::Sighting> FromMsg(const hires::Detections& msg);
/// @param seen  nothing: it could not look.
hires::Detections ToMsg(const std::optional<hires::perception::Sighting>& seen,
                        const std_msgs::Header& header);

}  // namespace hires_ros
