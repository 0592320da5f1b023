#include "nodes/world_tracker/tray_markers.h"

#include <algorithm>
#include <utility>

#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

namespace sensing = hires::sensing;
using hires::geometry::Pose3;
using visualization_msgs::Marker;

constexpr double kLifetime = 0.5;    // [s]
constexpr double kDot = 0.006;       // [m]
constexpr double kLetters = 0.03;    // [m]
constexpr double kBoxHeight = 0.04;  // [m] a scan tells none
constexpr double kThinnest = 0.002;  // [m] of a side of which no depth is seen

std_msgs::ColorRGBA Colour(float red, float green, float blue, float opacity) {
  std_msgs::ColorRGBA colour;
  colour.r = red;
  colour.g = green;
  colour.b = blue;
  colour.a = opacity;
  return colour;
}

std_msgs::ColorRGBA ColourOf(sensing::TrayState state) {
  switch (state) {
    case sensing::TrayState::kInPlace:
      return Colour(0.2f, 0.75f, 0.3f, 1.0f);
    case sensing::TrayState::kMoved:
      return Colour(0.3f, 0.5f, 0.9f, 1.0f);
    case sensing::TrayState::kMissing:
      return Colour(0.9f, 0.2f, 0.2f, 1.0f);
    case sensing::TrayState::kUnknown:
      break;
  }
  return Colour(0.6f, 0.6f, 0.6f, 1.0f);
}

const char* NameOf(sensing::TrayState state) {
  switch (state) {
    case sensing::TrayState::kInPlace:
      return "";
    case sensing::TrayState::kMoved:
      return " moved";
    case sensing::TrayState::kMissing:
      return " missing";
    case sensing::TrayState::kUnknown:
      break;
  }
  return " not seen";
}

/// Draws in the tray's frame, told in the base's.
class Drawing {
 public:
  Drawing(const sensing::TrayView& view, const std::string& frame) : view_(view) {
    blank_.header.frame_id = frame;
    blank_.header.stamp.fromSec(view.time);
    blank_.lifetime = ros::Duration(kLifetime);
  }

  Marker* Add(const char* name_space, int id, int type, const Pose3& X_TMarker) {
    blank_.ns = name_space;
    blank_.id = id;
    blank_.type = type;
    blank_.pose = ToMsg(view_.X_BT * X_TMarker);
    markers_.markers.push_back(blank_);
    return &markers_.markers.back();
  }
  void AddPoints(const sensing::TrayThing& thing, int id) {
    Marker* dots = Add("clusters", id, Marker::POINTS, Pose3());
    dots->scale.x = dots->scale.y = kDot;
    dots->color = Colour(0.95f, 0.85f, 0.2f, 1.0f);
    for (const Eigen::Vector2d& p_T : thing.points_T) {
      geometry_msgs::Point point;
      point.x = p_T.x();
      point.y = p_T.y();
      point.z = view_.height;
      dots->points.push_back(point);
    }
  }
  void AddBox(const sensing::TrayThing& thing, const char* name_space, int id,
              const std_msgs::ColorRGBA& colour) {
    Marker* box =
        Add(name_space, id, Marker::CUBE, hires::geometry::Lift(thing.X_TB, view_.height));
    box->scale.x = std::max(thing.size.x(), kThinnest);
    box->scale.y = std::max(thing.size.y(), kThinnest);
    box->scale.z = kBoxHeight;
    box->color = colour;
  }
  void AddName(const sensing::TrayObject& object, int id) {
    Pose3 X_TText = object.X_TO;
    X_TText.translation.z() += kLetters + view_.height;
    Marker* name = Add("names", id, Marker::TEXT_VIEW_FACING, X_TText);
    name->scale.z = kLetters;
    name->text = object.name + NameOf(object.state);
    name->color = ColourOf(object.state);
  }
  visualization_msgs::MarkerArray Take() { return std::move(markers_); }

 private:
  const sensing::TrayView& view_;
  Marker blank_;
  visualization_msgs::MarkerArray markers_;
};

}  // namespace

visualization_msgs::MarkerArray TrayMarkers(const sensing::TrayView& view,
                                            const std::string& frame) {
  Drawing drawing(view, frame);
  int id = 0;
  for (const sensing::TrayThing& thing : view.reading.things) {
    drawing.AddPoints(thing, id);
    drawing.AddBox(thing, "boxes", id++, Colour(0.8f, 0.8f, 0.8f, 0.4f));
  }
  id = 0;
  for (const sensing::TrayThing& thing : view.reading.surplus) {
    drawing.AddBox(thing, "surplus", id++, Colour(0.95f, 0.55f, 0.1f, 0.6f));
  }
  id = 0;
  for (const sensing::TrayObject& object : view.reading.objects) drawing.AddName(object, id++);
  return drawing.Take();
}

}  // namespace hires_ros
