#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "hires/sensing/object_memory.h"

namespace hires_ros {

/// What the last scan of the tray says, for RViz: where beams end (`clusters`), the boxes about
/// what is seen of each thing (`boxes`), those of things that nobody knows (`surplus`), and the
/// names of known objects with what became of them (`names`). Lifetime 0.5 s.
/// @param frame  of the robot's base.
visualization_msgs::MarkerArray TrayMarkers(const hires::sensing::TrayView& view,
                                            const std::string& frame);

}  // namespace hires_ros
