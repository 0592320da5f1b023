#pragma once

#include <hires/ToppleEpisodePart.h>

#include <string>

#include "hires/knowledge/experience.h"

namespace hires_ros {

/// A part as a message. The dynamics bear the stamp of the moment that they are of.
/// @param header  of the moment, its frame the map.  @param base_frame  that the deviation is in.
hires::ToppleEpisodePart ToMsg(const hires::knowledge::ToppleEpisodePart& part,
                               const std_msgs::Header& header, const std::string& base_frame);

}  // namespace hires_ros
