#include "perception/recognition/model_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hires/perception/depth_sensor.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;

constexpr double kSamples = 700.0;  // about so many pixels are looked at
constexpr double kInside = 2e-3;    // [m] least step on a ray within a model

/// What one pixel says of a model.
class PixelJudge {
 public:
  PixelJudge(const LabelledPicture& seen, int label, const DistanceField& model,
             const geometry::Pose3& X_CO)
      : seen_(seen),
        label_(label),
        model_(model),
        X_OC_(X_CO.Inverse()),
        R_OC_(X_OC_.rotation.toRotationMatrix()) {}

  void Look(int column, int row) {
    const int index = seen_.picture.PointAt(column, row);
    const Vector3d ray = seen_.picture.DirectionAt(column, row);
    const Vector3d ray_O = R_OC_ * ray;
    const auto met = model_.Meet(X_OC_.translation, ray_O);
    if (met) ++num_covered_;
    if (index < 0) {
      num_unmeasured_ += met.has_value();
      return;
    }
    const Vector3d p_C = seen_.cloud.points[index].cast<double>();
    const bool is_own = seen_.labels[index] == label_;
    if (!met) {
      if (is_own) Count(OffBeside(p_C));
      return;
    }
    const double beyond = p_C.norm() - *met;
    const double off = std::pow(beyond * ray.z() / DepthSd(*met * ray.z(), ray_O, *met), 2);
    if (beyond < 0.0 && off > kFarthest && !is_own) {
      ++num_hidden_;
    } else {
      Count(beyond > 0.0 && !is_own ? std::min(off, OffThrough(*met, ray_O)) : off);
    }
  }

  ModelView Result() const {
    ModelView view;
    if (num_counted_ > 0) view.quality = 1.0 - sum_ / kFarthest / num_counted_;
    const double measured = num_covered_ - num_unmeasured_;
    if (measured > 0.0) view.visible_share = 1.0 - num_hidden_ / measured;
    return view;
  }

 private:
  void Count(double off) {
    sum_ += std::min(kFarthest, off);
    ++num_counted_;
  }
  double LateralSd(double z) const {
    return kLateralNoise * z / seen_.picture.focal_length.minCoeff();
  }
  double DepthSd(double z, const Vector3d& ray_O, double met) const {
    const auto surface = model_.At(X_OC_.translation + met * ray_O);
    const double cosine = surface ? -surface->gradient.normalized().dot(ray_O) : 1.0;
    return DepthNoise(z, std::acos(std::clamp(cosine, 0.0, 1.0)));
  }
  // A point of the thing that no ray to the model explains: how far is it from the surface?
  double OffBeside(const Vector3d& p_C) const {
    const auto value = model_.At(X_OC_ * p_C);
    if (!value) return kFarthest;
    return std::pow(value->distance / std::hypot(LateralSd(p_C.z()), DepthNoise(p_C.z())), 2);
  }
  // The camera looks through the model: how deep within it?
  double OffThrough(double met, const Vector3d& ray_O) const {
    double deepest = 0.0;
    for (double at = met + kInside;;) {
      const auto value = model_.At(X_OC_.translation + at * ray_O);
      if (!value || value->distance >= 0.0) break;
      deepest = std::max(deepest, -value->distance);
      at += std::max(kInside, -value->distance);
    }
    return std::pow(deepest / LateralSd(met), 2);
  }

  const LabelledPicture& seen_;
  int label_;
  const DistanceField& model_;
  geometry::Pose3 X_OC_;
  Eigen::Matrix3d R_OC_;
  double sum_{0.0}, num_counted_{0}, num_covered_{0}, num_unmeasured_{0}, num_hidden_{0};
};

}  // namespace

void PixelWindow::Include(const Eigen::Vector2d& pixel) {
  left = std::min(left, static_cast<int>(std::floor(pixel.x())));
  right = std::max(right, static_cast<int>(std::ceil(pixel.x())));
  top = std::min(top, static_cast<int>(std::floor(pixel.y())));
  bottom = std::max(bottom, static_cast<int>(std::ceil(pixel.y())));
}

ModelView CompareView(const LabelledPicture& seen, int label, PixelWindow window,
                      const DistanceField& model, const geometry::Pose3& X_CO) {
  const geometry::Aabb& bounds = model.bounds();
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p_C = X_CO * Vector3d(corner & 1 ? bounds.upper.x() : bounds.lower.x(),
                                         corner & 2 ? bounds.upper.y() : bounds.lower.y(),
                                         corner & 4 ? bounds.upper.z() : bounds.lower.z());
    if (p_C.z() > 0.05) window.Include(seen.picture.Project(p_C));
  }
  window.left = std::max(window.left, 0);
  window.top = std::max(window.top, 0);
  window.right = std::min(window.right, seen.picture.width - 1);
  window.bottom = std::min(window.bottom, seen.picture.height - 1);
  const double area = std::max(0.0, window.right - window.left + 1.0) *
                      std::max(0.0, window.bottom - window.top + 1.0);
  const int stride = std::max(1, static_cast<int>(std::sqrt(area / kSamples)));
  PixelJudge judge(seen, label, model, X_CO);
  for (int row = window.top; row <= window.bottom; row += stride)
    for (int column = window.left; column <= window.right; column += stride)
      judge.Look(column, row);
  return judge.Result();
}

}  // namespace hires::perception
