#include "hires/ros/imagination/trace_markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose3;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::size_t kMostPoints = 2000;
constexpr double kArrowLength = 0.35;       // [m]
constexpr double kSmallestTurn = 0.02;      // [rad/s] below it the path counts as straight
constexpr double kSeeThroughHeight = 1.7;   // [m]
constexpr double kShownAcceleration = 2.0;  // [m/s^2] full colour

geometry_msgs::Point PointMsg(const Eigen::Vector3d& p) {
  geometry_msgs::Point out;
  out.x = p.x();
  out.y = p.y();
  out.z = p.z();
  return out;
}

std_msgs::ColorRGBA Colour(double r, double g, double b, double a = 1.0) {
  std_msgs::ColorRGBA out;
  out.r = static_cast<float>(r);
  out.g = static_cast<float>(g);
  out.b = static_cast<float>(b);
  out.a = static_cast<float>(a);
  return out;
}

void SetScale(Marker* marker, double x, double y, double z) {
  marker->scale.x = x;
  marker->scale.y = y;
  marker->scale.z = z;
}

/// Green for speeding up, red for braking, grey between.
std_msgs::ColorRGBA AccelerationColour(double acceleration) {
  const double share = std::clamp(acceleration / kShownAcceleration, -1.0, 1.0);
  return Colour(0.5 - 0.5 * std::min(share, 0.0) - 0.5 * std::max(share, 0.0),
                0.5 + 0.5 * std::max(share, 0.0) + 0.5 * std::min(share, 0.0),
                0.5 - 0.5 * std::abs(share));
}

Marker ShapeMarker(const hires::geometry::Shape& shape, const Pose3& X_MS) {
  Marker marker;
  marker.pose = ToMsg(X_MS);
  if (const auto* box = std::get_if<hires::geometry::Box>(&shape)) {
    marker.type = Marker::CUBE;
    SetScale(&marker, box->size.x(), box->size.y(), box->size.z());
  } else if (const auto* cylinder = std::get_if<hires::geometry::Cylinder>(&shape)) {
    marker.type = Marker::CYLINDER;
    SetScale(&marker, 2 * cylinder->radius, 2 * cylinder->radius, cylinder->length);
  } else if (const auto* sphere = std::get_if<hires::geometry::Sphere>(&shape)) {
    marker.type = Marker::SPHERE;
    SetScale(&marker, 2 * sphere->radius, 2 * sphere->radius, 2 * sphere->radius);
  } else {
    marker.type = Marker::TRIANGLE_LIST;
    SetScale(&marker, 1, 1, 1);
    const auto& mesh = *std::get<std::shared_ptr<const hires::geometry::TriangleMesh>>(shape);
    for (const auto& triangle : mesh.triangles) {
      for (const int i : triangle) marker.points.push_back(PointMsg(mesh.vertices[i]));
    }
  }
  return marker;
}

void Label(Marker* marker, const std::string& name_space, int id) {
  marker->header.frame_id = "map";
  marker->ns = name_space;
  marker->id = id;
}

}  // namespace

TraceMarkers::TraceMarkers(int worker_index, const hires::world::StandingCriterion& standing)
    : name_space_("worker_" + std::to_string(worker_index)), standing_(standing) {}

void TraceMarkers::Clear() {
  points_.clear();
  load_.clear();
}

void TraceMarkers::Add(const hires::simulation::RobotSimulator& simulator) {
  const auto objects = simulator.GetWorldState().objects;
  for (const int index : simulator.carried()) {
    const hires::simulation::FallWatch watch(standing_);
    Load& load = load_.try_emplace(objects[index].name, Load{index, watch}).first->second;
    load.index = index;
    load.watch.Look(simulator, index);
  }
  if (points_.size() >= kMostPoints) return;
  const auto& motion = simulator.base();
  const double speed = std::hypot(motion.V_B.vx, motion.V_B.vy);
  const double along =
      speed > 1e-3 ? (motion.A_B.vx * motion.V_B.vx + motion.A_B.vy * motion.V_B.vy) / speed : 0.0;
  points_.push_back({{motion.X_MB.x, motion.X_MB.y, 0.02}, speed, along});
}

Marker TraceMarkers::Blank(const std::string& name, int id, int type) const {
  Marker marker;
  Label(&marker, name_space_ + "/" + name, id);
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.lifetime = ros::Duration(2.0);
  return marker;
}

void TraceMarkers::DrawTrace(MarkerArray* markers) const {
  // A line strip has one thickness: strokes across the path can show the speed by their length.
  Marker dots = Blank("trace", 0, Marker::LINE_LIST);
  dots.scale.x = 0.02;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Eigen::Vector3d along = points_[i].p_M - points_[i - 1].p_M;
    const double length = along.head<2>().norm();
    if (length < 1e-6) continue;
    const Eigen::Vector3d side =
        0.1 * points_[i].speed * Eigen::Vector3d(-along.y(), along.x(), 0.0) / length;
    for (const double sign : {-1.0, 1.0}) {
      dots.points.push_back(PointMsg(points_[i].p_M + sign * side));
      dots.colors.push_back(AccelerationColour(points_[i].acceleration));
    }
  }
  if (!dots.points.empty()) markers->markers.push_back(dots);
}

void TraceMarkers::DrawLoad(const hires::simulation::RobotSimulator& simulator, const Load& load,
                            MarkerArray* markers) const {
  const Pose3 X_MO = simulator.PoseOf(load.index);
  const hires::world::FallDetector& detector = load.watch.detector();
  const auto arrow = [&](const char* name, const Eigen::Vector3d& axis, const auto& colour) {
    Marker marker = Blank(name, load.index, Marker::ARROW);
    marker.points = {PointMsg(X_MO.translation), PointMsg(X_MO.translation + kArrowLength * axis)};
    SetScale(&marker, 0.015, 0.03, 0.05);
    marker.color = colour;
    markers->markers.push_back(marker);
  };
  arrow("up", Eigen::Vector3d::UnitZ(), Colour(0.1, 0.8, 0.1));
  arrow("tilt", X_MO.rotation * Eigen::Vector3d::UnitZ(),
        detector.is_down() ? Colour(1.0, 0.0, 0.0) : Colour(1.0, 0.7, 0.0));
  Marker text = Blank("alpha", load.index, Marker::TEXT_VIEW_FACING);
  text.pose.position = PointMsg(X_MO.translation + Eigen::Vector3d(0.0, 0.0, 0.45));
  text.scale.z = 0.08;
  text.color = Colour(1, 1, 1);
  text.text = fmt::format("{:.3f} rad", detector.now().tilt);
  markers->markers.push_back(text);
}

void TraceMarkers::DrawCircle(const hires::simulation::RobotSimulator& simulator, const Load& load,
                              MarkerArray* markers) const {
  const auto& motion = simulator.base();
  if (std::abs(motion.V_B.wz) < kSmallestTurn || load.watch.detector().is_down()) return;
  // The instantaneous centre of rotation of the base: where its velocity field vanishes.
  const Eigen::Vector2d centre =
      motion.X_MB * Eigen::Vector2d(-motion.V_B.vy / motion.V_B.wz, motion.V_B.vx / motion.V_B.wz);
  const Eigen::Vector3d p_MO = simulator.PoseOf(load.index).translation;
  const double radius = (p_MO.head<2>() - centre).norm();
  if (radius > 20.0) return;
  Marker circle = Blank("circle", 0, Marker::LINE_STRIP);
  circle.scale.x = 0.02;
  circle.color = Colour(1.0, 0.1, 0.1);
  for (int i = 0; i <= 64; ++i) {
    const double angle = 2.0 * hires::geometry::kPi * i / 64;
    circle.points.push_back(PointMsg(
        {centre.x() + radius * std::cos(angle), centre.y() + radius * std::sin(angle), p_MO.z()}));
  }
  markers->markers.push_back(circle);
}

void TraceMarkers::DrawBodies(const hires::simulation::RobotSimulator& simulator,
                              MarkerArray* markers) const {
  int id = 0;
  const auto draw = [&](const hires::geometry::Collision& part, const Pose3& X_MB,
                        const std_msgs::ColorRGBA& colour) {
    Marker marker = ShapeMarker(part.shape, X_MB * part.X_BS);
    Label(&marker, name_space_ + "/bodies", id++);
    marker.lifetime = ros::Duration(2.0);
    marker.color = colour;
    markers->markers.push_back(marker);
  };
  const auto& scene = simulator.scene();
  for (const auto& part : scene.robot_shapes_B) {
    draw(part, simulator.X_MB(), Colour(0.55, 0.6, 0.7, 0.8));
  }
  for (const auto& object : simulator.GetWorldState().objects) {
    const auto model = scene.world.RequireModel(object.model);
    for (const auto& part : model->collisions) {
      draw(part, object.X_MO, Colour(0.8, 0.45, 0.15));
    }
  }
}

MarkerArray TraceMarkers::Draw(const hires::simulation::RobotSimulator& simulator) const {
  MarkerArray markers;
  DrawBodies(simulator, &markers);
  DrawTrace(&markers);
  const std::vector<int>& carried = simulator.carried();
  for (const auto& [name, load] : load_) {
    if (std::count(carried.begin(), carried.end(), load.index) == 0) continue;
    DrawLoad(simulator, load, &markers);
    if (load.index == carried.front()) DrawCircle(simulator, load, &markers);
  }
  return markers;
}

Marker TextMarker(const std::string& name_space, const std::string& text,
                  const Eigen::Vector3d& p_M, double above, double height) {
  Marker marker;
  Label(&marker, name_space, 0);
  marker.type = Marker::TEXT_VIEW_FACING;
  marker.action = text.empty() ? Marker::DELETE : Marker::ADD;
  marker.pose.position = PointMsg(p_M + above * Eigen::Vector3d::UnitZ());
  marker.pose.orientation.w = 1.0;
  marker.scale.z = height;
  marker.color = Colour(1, 1, 1);
  marker.text = text;
  return marker;
}

MarkerArray RankingMarkers(const std::vector<hires::imagination::Prediction>& ranking,
                           int recommended, const hires::geometry::Pose2& X_MB) {
  std::string text;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const auto& e = ranking[i].evidence;
    text += fmt::format("{}{}: {:.0f} % (>= {:.0f} %), c {:.2f}, {:.1f} s\n",
                        static_cast<int>(i) == recommended ? "> " : "",
                        hires::base::ToString(ranking[i].action), 100 * e.success.share,
                        100 * e.success.lower, e.confidence_mean, e.duration.mean);
  }
  MarkerArray markers;
  markers.markers.push_back(TextMarker("ranking", text, {X_MB.x, X_MB.y, 0.0}, 2.2, 0.22));
  return markers;
}

MarkerArray WorldMarkers(const hires::world::World& world) {
  MarkerArray markers;
  int id = 0;
  for (const auto& body : world.statics) {
    for (const auto& collision : body.collisions) {
      Marker marker = ShapeMarker(collision.shape, body.X_MB * collision.X_BS);
      Label(&marker, "world", id++);
      // One looks through what is higher than the robot.
      const bool is_wall =
          hires::geometry::BoundsOf(collision.shape, body.X_MB * collision.X_BS).upper.z() >
          kSeeThroughHeight;
      marker.color = Colour(0.75, 0.7, 0.6, is_wall ? 0.2 : 0.95);
      markers.markers.push_back(marker);
    }
  }
  for (const auto& [key, X_MF] : world.frames) {
    Marker marker;
    Label(&marker, "areas", id++);
    marker.type = Marker::ARROW;
    marker.pose = ToMsg(X_MF);
    marker.pose.position.z += 0.01;
    SetScale(&marker, 0.3, 0.04, 0.02);
    marker.color = Colour(0.2, 0.4, 0.9, 0.8);
    markers.markers.push_back(marker);
  }
  return markers;
}

}  // namespace hires_ros
