#include "perception/recognition/cloud_picture.h"

#include <algorithm>
#include <cmath>

namespace hires::perception {
namespace {

constexpr double kFocalLength = 400.0;  // [pixels] of a picture that is drawn
constexpr int kWidest = 1600;           // [pixels] likewise: 127 degrees
constexpr double kExact = 0.5;          // [pixels] rms error of a pinhole camera's own points
constexpr std::size_t kSample = 4000;   // points that the camera is found by

bool IsInFront(const Eigen::Vector3f& p_C) { return IsMeasured(p_C) && p_C.z() > 1e-3F; }

/// Least squares of pixel = focal length * tangent + middle along one axis of the picture.
struct Line {
  void Add(double tangent, double pixel) {
    n += 1.0, t += tangent, p += pixel, tt += tangent * tangent, tp += tangent * pixel;
    pp += pixel * pixel;
  }
  double slope() const { return (n * tp - t * p) / (n * tt - t * t); }
  double offset() const { return (p - slope() * t) / n; }
  double rms() const {
    const double rest = pp - offset() * p - slope() * tp;
    return std::sqrt(std::max(0.0, rest / n));
  }
  double n{0.0}, t{0.0}, p{0.0}, tt{0.0}, tp{0.0}, pp{0.0};
};

std::optional<CloudPicture> OwnPixels(const PointCloud& cloud) {
  if (cloud.height < 2) return std::nullopt;
  Line across, down;
  const std::size_t step = std::max<std::size_t>(1, cloud.points.size() / kSample);
  for (std::size_t i = 0; i < cloud.points.size(); i += step) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    if (!IsInFront(cloud.points[i])) continue;
    across.Add(p.x() / p.z(), static_cast<double>(i % cloud.width));
    down.Add(p.y() / p.z(), static_cast<double>(i / cloud.width));
  }
  if (!(across.rms() < kExact && down.rms() < kExact)) return std::nullopt;
  CloudPicture picture;
  picture.width = cloud.width;
  picture.height = cloud.height;
  picture.focal_length = {across.slope(), down.slope()};
  picture.middle = {across.offset(), down.offset()};
  if (!(picture.focal_length > 1.0).all()) return std::nullopt;
  picture.point.resize(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    picture.point[i] = IsInFront(cloud.points[i]) ? static_cast<int>(i) : -1;
  return picture;
}

std::optional<CloudPicture> Drawn(const PointCloud& cloud) {
  Eigen::Array2d lower = Eigen::Array2d::Constant(1e9), upper = -lower;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!IsInFront(p)) continue;
    const Eigen::Array2d tangents = (p.head<2>() / p.z()).cast<double>();
    lower = lower.min(tangents);
    upper = upper.max(tangents);
  }
  if (lower.x() > upper.x()) return std::nullopt;
  const double widest = kWidest / 2.0 / kFocalLength;
  lower = lower.max(-widest);
  upper = upper.min(widest);
  if ((lower > upper).any()) return std::nullopt;
  CloudPicture picture;
  picture.focal_length.setConstant(kFocalLength);
  picture.middle = -lower * kFocalLength;
  picture.width = static_cast<int>((upper.x() - lower.x()) * kFocalLength) + 1;
  picture.height = static_cast<int>((upper.y() - lower.y()) * kFocalLength) + 1;
  picture.point.assign(static_cast<std::size_t>(picture.width) * picture.height, -1);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!IsInFront(cloud.points[i])) continue;
    const Eigen::Vector2d pixel = picture.Project(cloud.points[i].cast<double>());
    const auto column = std::lround(pixel.x()), row = std::lround(pixel.y());
    if (column < 0 || row < 0 || column >= picture.width || row >= picture.height) continue;
    int& there = picture.point[static_cast<std::size_t>(row) * picture.width + column];
    if (there < 0 || cloud.points[i].z() < cloud.points[there].z()) there = static_cast<int>(i);
  }
  return picture;
}

}  // namespace

Eigen::Vector3d CloudPicture::DirectionAt(int column, int row) const {
  const Eigen::Array2d tangents = (Eigen::Array2d(column, row) - middle) / focal_length;
  return Eigen::Vector3d(tangents.x(), tangents.y(), 1.0).normalized();
}

Eigen::Vector2d CloudPicture::Project(const Eigen::Vector3d& p_C) const {
  return p_C.head<2>().array() / p_C.z() * focal_length + middle;
}

std::optional<CloudPicture> PictureOf(const PointCloud& cloud) {
  auto own = OwnPixels(cloud);
  return own ? std::move(own) : Drawn(cloud);
}

}  // namespace hires::perception
