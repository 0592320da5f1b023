#include "reports/film/top_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "hires/perception/picture_scene.h"
#include "hires/perception/pinhole_camera.h"
#include "reports/film/film_colours.h"
#include "reports/film/label_layout.h"
#include "reports/film/picture_text.h"

namespace hires::reports {
namespace {

using Eigen::Vector2d;
using geometry::Aabb;
using perception::PaintedBody;
using perception::Picture;
using perception::PinholeCamera;

constexpr double kWallTop = 1.7;                     // [m]
constexpr double kCeiling = 2.0;                     // [m] what begins above stands in nobody's way
constexpr double kBorder = 0.5;                      // [m] around everything
constexpr int kMostWidth = 1200, kMostHeight = 900;  // [pixels]
constexpr double kFarAway = 40.0;   // times the picture's half width: hardly any perspective
constexpr double kArrow = 0.5;      // [m]
constexpr int kSmallestArrow = 12;  // [pixels]

Aabb BoundsOfBody(const std::vector<geometry::Collision>& shapes, const geometry::Pose3& X_MB) {
  Aabb bounds;
  for (const geometry::Collision& shape : shapes)
    bounds.Include(geometry::BoundsOf(shape.shape, X_MB * shape.X_BS));
  return bounds;
}

/// Straight down on the middle of what is to be seen.
PinholeCamera CameraOver(const Aabb& seen) {
  const Eigen::Vector3d size = seen.upper - seen.lower, middle = 0.5 * (seen.upper + seen.lower);
  const double scale = std::min(kMostWidth / size.x(), kMostHeight / size.y());  // [pixels/m]
  PinholeCamera camera;
  camera.width = std::max(1, static_cast<int>(size.x() * scale));
  camera.height = std::max(1, static_cast<int>(size.y() * scale));
  const double height = kFarAway * 0.5 * std::max(size.x(), size.y());
  camera.focal_length = height * scale;
  Eigen::Matrix3d R_MC;  // ahead is down, left is -x, up in the picture is y
  R_MC << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  camera.X_MC = {{middle.x(), middle.y(), height}, Eigen::Quaterniond(R_MC)};
  return camera;
}

cv::Point PixelOf(const PinholeCamera& camera, const Vector2d& p_M) {
  const auto at = camera.Project({p_M.x(), p_M.y(), 0.0});
  if (!at) return {};
  return {static_cast<int>(std::lround(at->x())), static_cast<int>(std::lround(at->y()))};
}

cv::Scalar ScalarOf(const perception::Colour& colour) {
  return cv::Scalar(colour[0], colour[1], colour[2]);
}

void DrawArrow(const PinholeCamera& camera, const geometry::Pose2& X_MP, cv::Mat* pixels) {
  const Vector2d heading(std::cos(X_MP.yaw), std::sin(X_MP.yaw));
  const cv::Point from = PixelOf(camera, X_MP.position());
  const cv::Point far = PixelOf(camera, X_MP.position() + kArrow * heading);
  const double length = std::max<double>(kSmallestArrow, cv::norm(far - from));
  const cv::Point to(from.x + static_cast<int>(std::lround(length * heading.x())),
                     from.y - static_cast<int>(std::lround(length * heading.y())));
  cv::circle(*pixels, from, 4, ScalarOf(kAlarm), cv::FILLED, cv::LINE_AA);
  cv::arrowedLine(*pixels, from, to, ScalarOf(kAlarm), 2, cv::LINE_AA, 0, 0.3);
}

/// Names come last, so that no arrow lies on one.
void DrawPlaces(const PinholeCamera& camera, const std::vector<MarkedPlace>& places,
                Picture* picture) {
  cv::Mat pixels(picture->height, picture->width, CV_8UC3, picture->pixels.data());
  std::vector<Labelled> points;
  for (const MarkedPlace& place : places) {
    DrawArrow(camera, place.X_MP, &pixels);
    const cv::Point at = PixelOf(camera, place.X_MP.position());
    points.push_back({at.x, at.y, WidthOf(place.name)});
  }
  const std::vector<LabelPlace> labels = PlaceLabels(points, picture->width, picture->height);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int middle = labels[i].row + kTextHeight / 2;
    if (std::abs(middle - points[i].y) > kTextHeight) {  // a line says whose name it is
      const int end = labels[i].column + (labels[i].column < points[i].x ? points[i].width : 0);
      cv::line(pixels, {points[i].x, points[i].y}, {end, middle}, ScalarOf(kAlarm), 1, cv::LINE_AA);
    }
    WriteLine(places[i].name, labels[i].column, labels[i].row, picture->width, kInk, picture);
  }
}

}  // namespace

Picture TopView(const simulation::Scene& scene, const std::vector<MarkedPlace>& places,
                const std::vector<Vector2d>& way) {
  std::vector<PaintedBody> bodies;
  Aabb seen;
  for (const world::StaticBody& body : scene.world.statics) {
    const Aabb bounds = BoundsOfBody(body.collisions, body.X_MB);
    if (bounds.lower.z() > kCeiling) continue;
    seen.Include(bounds);
    bodies.push_back(
        {body.collisions, body.X_MB, bounds.upper.z() > kWallTop ? kWall : kFurniture, false});
  }
  for (const world::ObjectState& object : scene.world.initial.objects) {
    const auto& shapes = scene.world.RequireModel(object.model)->collisions;
    seen.Include(BoundsOfBody(shapes, object.X_MO));
    bodies.push_back({shapes, object.X_MO, kOther, false});
  }
  for (const MarkedPlace& place : places) seen.Include({place.X_MP.x, place.X_MP.y, 0.0});
  for (const Vector2d& p : way) seen.Include({p.x(), p.y(), 0.0});
  if (seen.upper.x() < seen.lower.x()) seen.Include(Eigen::Vector3d::Zero());
  seen.lower.array() -= kBorder;
  seen.upper.array() += kBorder;
  const PinholeCamera camera = CameraOver(seen);
  perception::Lighting lighting;
  lighting.background = kPaper;
  lighting.sun = 0.15;  // shadows would hide more than they show
  lighting.ambient = 0.75;
  lighting.farthest = 2.0 * camera.X_MC.translation.z();
  Picture picture = perception::PictureScene(std::move(bodies)).Draw(camera, {}, lighting);
  cv::Mat pixels(picture.height, picture.width, CV_8UC3, picture.pixels.data());
  for (std::size_t i = 1; i < way.size(); ++i) {
    cv::line(pixels, PixelOf(camera, way[i - 1]), PixelOf(camera, way[i]), ScalarOf(kTrace), 2,
             cv::LINE_AA);
  }
  DrawPlaces(camera, places, &picture);
  return picture;
}

}  // namespace hires::reports
