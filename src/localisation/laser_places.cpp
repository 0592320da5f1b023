#include "localisation/laser_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;

constexpr double kSameMounting = 0.05;  // [m], [rad] between two lines
constexpr double kSameDigits = 0.005;   // [m], [rad] up to the digits that are written
constexpr double kFarthestPlace = 3.0;  // [m] from the base
constexpr std::size_t kMostLasers = 4;
constexpr int kFewOfALaser = 10;         // scans
constexpr double kLeastOfALaser = 0.05;  // of the scans

bool AreWithin(const Pose2& a, const Pose2& b, double most) {
  return (a.position() - b.position()).norm() <= most &&
         std::abs(geometry::WrapToPi(a.yaw - b.yaw)) <= most;
}

}  // namespace

void LaserPlaces::Take(const Pose2& X_BL) {
  ++num_scans_;
  is_any_far_ = is_any_far_ || X_BL.position().norm() > kFarthestPlace;
  do_vary_ = do_vary_ || is_any_far_ ||
             (!places_.empty() && !AreWithin(X_BL, places_.front().X_BL, kSameMounting));
  for (Place& place : places_) {
    if (!AreWithin(X_BL, place.X_BL, kSameDigits)) continue;
    ++place.num_scans;
    return;
  }
  if (places_.size() <= kMostLasers) places_.push_back({X_BL, 1});
}

std::string LaserPlaces::TextOfLasers() const {
  if (is_any_far_ || places_.size() > kMostLasers) return "";
  std::vector<std::string> lasers;
  for (const auto& [X_BL, num_scans] : places_) {
    if (num_scans < std::max<double>(kFewOfALaser, kLeastOfALaser * num_scans_)) return "";
    lasers.push_back(
        fmt::format("{} from ({:.3f} {:.3f} {:.3f})", num_scans, X_BL.x, X_BL.y, X_BL.yaw));
  }
  return base::Join(lasers, ", ");
}

}  // namespace hires::localisation
