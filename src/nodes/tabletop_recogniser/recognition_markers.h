#pragma once

#include <hires/Detections.h>
#include <visualization_msgs/MarkerArray.h>

namespace hires_ros {

/// Boxes and names of what is recognised, and the table's outline, in the frame of the detections;
/// lifetime 2 s. What is known is green, what is unknown orange.
visualization_msgs::MarkerArray RecognitionMarkers(const hires::Detections& seen);

}  // namespace hires_ros
