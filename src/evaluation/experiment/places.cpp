#include "evaluation/experiment/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/imagination/evidence.h"

namespace hires::evaluation {
namespace {

constexpr double kInside = 7.815;  // 95 % of chi squared with three degrees of freedom

/// What all moments have in common.
struct Summary {
  explicit Summary(const PlaceTrail& moments) {
    if (moments.empty()) return;
    std::vector<double> distances, yaws;
    double squares = 0.0;
    int num_inside = 0;
    for (const PlaceMoment& moment : moments) {
      const Eigen::Vector2d off = moment.X_MBelieved.position() - moment.X_MB.position();
      distances.push_back(off.norm());
      yaws.push_back(std::abs(geometry::WrapToPi(moment.X_MBelieved.yaw - moment.X_MB.yaw)));
      squares += distances.back() * distances.back();
      num_inside += moment.is_inside;
    }
    const double n = static_cast<double>(moments.size());
    inside = num_inside / n;
    rms = std::sqrt(squares / n);
    std::sort(distances.begin(), distances.end());
    std::sort(yaws.begin(), yaws.end());
    distance = {imagination::Quantile(distances, 50), imagination::Quantile(distances, 95),
                distances.back()};
    yaw = {imagination::Quantile(yaws, 50), imagination::Quantile(yaws, 95), yaws.back()};
  }

  struct Spread {
    double median{NAN}, most{NAN}, largest{NAN};  // `most`: 95 %
  };
  Spread distance, yaw;
  double rms{NAN}, inside{NAN};
};

}  // namespace

PlaceMoment MomentOf(const simulation::SelfLocaliser& localiser) {
  const localisation::PoseEstimate estimate = localiser.Estimate();
  const geometry::Pose2& X_MB = localiser.X_MBtrue();
  const Eigen::Vector3d off(estimate.X_MB.x - X_MB.x, estimate.X_MB.y - X_MB.y,
                            geometry::WrapToPi(estimate.X_MB.yaw - X_MB.yaw));
  const Eigen::LDLT<Eigen::Matrix3d> covariance(estimate.covariance);
  const double squared = off.dot(covariance.solve(off));
  const bool is_inside = covariance.isPositive() && covariance.rcond() > 0.0 && squared <= kInside;
  return {X_MB, estimate.X_MB, localiser.X_OB(), is_inside};
}

TextTable PlaceTable(const PlaceTrail& moments) {
  const Summary all(moments);
  const auto spread = [](const Summary::Spread& of, const char* unit) {
    return std::vector<std::string>{fmt::format("{:.3f} {}", of.median, unit),
                                    fmt::format("{:.3f} {}", of.most, unit),
                                    fmt::format("{:.3f} {}", of.largest, unit)};
  };
  std::vector<std::string> position = spread(all.distance, "m"), yaw = spread(all.yaw, "rad");
  position.insert(position.begin(), "position");
  yaw.insert(yaw.begin(), "heading");
  position.push_back(fmt::format("{:.3f} m", all.rms));
  yaw.emplace_back("");
  position.push_back(fmt::format("{:.1f} %", 100.0 * all.inside));
  yaw.emplace_back("");
  return {fmt::format("How far off the robot took itself to be, {} moments", moments.size()),
          {{"", "median", "95 %", "largest", "rms", "in the 95 % ellipsoid"}, position, yaw}};
}

std::vector<Measure> PlaceMeasures(const PlaceTrail& moments) {
  const Summary all(moments);
  return {{"place_median", all.distance.median},   {"place_95", all.distance.most},
          {"place_largest", all.distance.largest}, {"place_rms", all.rms},
          {"place_yaw_largest", all.yaw.largest},  {"place_inside", all.inside}};
}

}  // namespace hires::evaluation
