#include "nodes/tabletop_recogniser/recognition_markers.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "hires/perception/detector.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using visualization_msgs::Marker;

constexpr double kLifetime = 2.0;       // [s]
constexpr double kLetters = 0.04;       // [m]
constexpr double kOutlineWidth = 0.01;  // [m]

std_msgs::ColorRGBA Colour(float red, float green, float blue, float opacity) {
  std_msgs::ColorRGBA colour;
  colour.r = red;
  colour.g = green;
  colour.b = blue;
  colour.a = opacity;
  return colour;
}

Marker Blank(const hires::Detections& seen, const char* name_space, int id, int type) {
  Marker marker;
  marker.header = seen.header;
  marker.ns = name_space;
  marker.id = id;
  marker.type = type;
  marker.lifetime = ros::Duration(kLifetime);
  marker.pose.orientation.w = 1.0;
  return marker;
}

/// Things stand with their origin on the table, z up.
Marker BoxOf(const hires::Detections& seen, int id) {
  const hires::Detection& thing = seen.detections[id];
  Marker box = Blank(seen, "boxes", id, Marker::CUBE);
  hires::geometry::Pose3 X_CO = FromMsg(thing.pose);
  X_CO.translation += X_CO.rotation * Eigen::Vector3d(0.0, 0.0, 0.5 * thing.size.z);
  box.pose = ToMsg(X_CO);
  box.scale = thing.size;
  box.color = thing.label == hires::perception::kUnknownLabel ? Colour(0.95f, 0.55f, 0.1f, 0.5f)
                                                              : Colour(0.2f, 0.75f, 0.3f, 0.5f);
  return box;
}

Marker NameOf(const hires::Detections& seen, int id) {
  const hires::Detection& thing = seen.detections[id];
  Marker name = Blank(seen, "names", id, Marker::TEXT_VIEW_FACING);
  hires::geometry::Pose3 X_CO = FromMsg(thing.pose);
  X_CO.translation += X_CO.rotation * Eigen::Vector3d(0.0, 0.0, thing.size.z + kLetters);
  name.pose = ToMsg(X_CO);
  name.scale.z = kLetters;
  name.text = fmt::format("{} {:.0f} %", thing.label, 100.0f * thing.confidence);
  name.color = Colour(1.0f, 1.0f, 1.0f, 1.0f);
  return name;
}

}  // namespace

visualization_msgs::MarkerArray RecognitionMarkers(const hires::Detections& seen) {
  visualization_msgs::MarkerArray markers;
  for (int i = 0; i < static_cast<int>(seen.detections.size()); ++i) {
    markers.markers.push_back(BoxOf(seen, i));
    markers.markers.push_back(NameOf(seen, i));
  }
  if (seen.table.empty()) return markers;
  Marker outline = Blank(seen, "table", 0, Marker::LINE_STRIP);
  outline.points = seen.table;
  outline.points.push_back(seen.table.front());
  outline.scale.x = kOutlineWidth;
  outline.color = Colour(0.3f, 0.5f, 0.9f, 1.0f);
  markers.markers.push_back(outline);
  return markers;
}

}  // namespace hires_ros
