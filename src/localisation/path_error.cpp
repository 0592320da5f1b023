#include "hires/localisation/path_error.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::localisation {

PathError ErrorOf(const TimedPath& path, const TimedPath& truth) {
  HIRES_CHECK(path.size() == truth.size() && !path.empty(), "one true pose for each pose");
  const double n = static_cast<double>(path.size());
  Eigen::Vector2d mean_p = Eigen::Vector2d::Zero(), mean_t = mean_p;
  for (std::size_t i = 0; i < path.size(); ++i) {
    mean_p += path[i].X_MB.position() / n;
    mean_t += truth[i].X_MB.position() / n;
  }
  double sine = 0.0, cosine = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector2d p = path[i].X_MB.position() - mean_p;
    const Eigen::Vector2d t = truth[i].X_MB.position() - mean_t;
    cosine += p.dot(t);
    sine += p.x() * t.y() - p.y() * t.x();
  }
  PathError error;
  error.X_TP.yaw = std::atan2(sine, cosine);
  const Eigen::Vector2d shift = mean_t - error.X_TP * mean_p;
  error.X_TP.x = shift.x();
  error.X_TP.y = shift.y();
  double squares = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double square =
        (error.X_TP * path[i].X_MB.position() - truth[i].X_MB.position()).squaredNorm();
    squares += square;
    error.max = std::max(error.max, std::sqrt(square));
  }
  error.rms = std::sqrt(squares / n);
  return error;
}

}  // namespace hires::localisation
