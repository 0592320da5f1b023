#include "reports/film/film_cameras.h"

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"

namespace hires::reports {
namespace {

using Eigen::Vector3d;
using geometry::Pose3;
using imagination::RolloutRecording;
using perception::PinholeCamera;

constexpr double kCloseView = 0.85;        // [rad]
constexpr double kOverview = 0.75;         // [rad]
constexpr double kTrayReach = 0.6;         // [m] what is nearer to its middle stands on the tray
constexpr double kLeft = 0.25;             // [m] a load farther from its place has left the robot
constexpr double kMarginAround = 1.0;      // [m]
const Vector3d kBeside{0.45, -1.35, 0.5};  // [m] from the load, in the base frame
const Vector3d kOverviewFrom{-0.30, -0.62,
                             0.73};        // where the other camera is from what it looks at
const Vector3d kHalfMill{0.0, 0.0, 0.10};  // [m] things have their origin at the foot

Vector3d LoadAt(const RolloutRecording& recording, std::size_t sample, std::optional<int> load,
                const Pose3& X_BO) {
  const imagination::RolloutSample& now = recording.samples[sample];
  const Pose3 X_MO = load ? now.X_MO[*load] : now.X_MB * X_BO;
  return X_MO * kHalfMill;
}

}  // namespace

std::optional<int> LoadOf(const RolloutRecording& recording, const Pose3& X_BO) {
  for (std::size_t i = 0; i < recording.objects.size(); ++i) {
    for (const std::string& argument : recording.action.arguments) {
      if (base::ToLower(argument) == base::ToLower(recording.objects[i]))
        return static_cast<int>(i);
    }
  }
  const imagination::RolloutSample& first = recording.samples.front();
  const Vector3d place_M = first.X_MB * X_BO.translation;
  std::optional<int> load;
  double nearest = kTrayReach;
  for (std::size_t i = 0; i < first.X_MO.size(); ++i) {
    const double away = (first.X_MO[i].translation - place_M).norm();
    if (away >= nearest) continue;
    nearest = away;
    load = static_cast<int>(i);
  }
  return load;
}

std::vector<PinholeCamera> CloseCameras(const RolloutRecording& recording, std::optional<int> load,
                                        const Pose3& X_BO, int width, int height) {
  const auto& samples = recording.samples;
  const Vector3d place_B = samples[0].X_MB.Inverse() * LoadAt(recording, 0, load, X_BO);
  std::vector<PinholeCamera> cameras;
  Vector3d eye_M = Vector3d::Zero(), last_load_M = LoadAt(recording, 0, load, X_BO);
  bool has_left = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // The robot's own leaning should be seen, not shake the picture.
    const Pose3 X_MB = geometry::Lift(geometry::Flatten(samples[i].X_MB));
    const Vector3d place_M = X_MB * place_B;
    Vector3d load_M = LoadAt(recording, i, load, X_BO);
    if (!load_M.allFinite()) load_M = last_load_M;  // physics lost it
    last_load_M = load_M;
    has_left = has_left || (load_M - place_M).norm() > kLeft;
    if (!has_left) eye_M = X_MB * Vector3d(place_B + kBeside);
    const Vector3d target_M = has_left ? load_M : place_M;
    cameras.push_back(perception::LookAt(eye_M, target_M, width, height, kCloseView));
  }
  return cameras;
}

PinholeCamera OverviewCamera(const RolloutRecording& recording, int width, int height) {
  geometry::Aabb driven;
  for (const imagination::RolloutSample& sample : recording.samples) {
    driven.Include(sample.X_MB.translation);
  }
  const Vector3d middle = 0.5 * (driven.lower + driven.upper) + Vector3d(0.0, 0.0, 0.5);
  const double radius = 0.5 * (driven.upper - driven.lower).norm() + kMarginAround;
  const double half_view = std::atan(std::tan(kOverview / 2) * std::min(1.0, 1.0 * height / width));
  const double distance = radius / std::sin(half_view);
  return perception::LookAt(middle + distance * kOverviewFrom.normalized(), middle, width, height,
                            kOverview);
}

}  // namespace hires::reports
