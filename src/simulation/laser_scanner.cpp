#include "hires/simulation/laser_scanner.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::simulation {

std::vector<double> ScanLaser(const RobotSimulator& simulator, const LaserParams& params,
                              base::Rng* rng) {
  const auto& surroundings = simulator.scene().surroundings;
  HIRES_CHECK(surroundings, "only a robot with an upper body has surroundings to scan");
  HIRES_CHECK(params.num_beams >= 2, "a laser has two beams at least");
  const perception::LineOfSight sight(surroundings, simulator.GetWorldState().objects);
  const geometry::Pose3 X_ML = simulator.X_MLink(params.link);
  const double step = (params.angle_max - params.angle_min) / (params.num_beams - 1);
  std::vector<double> ranges;
  ranges.reserve(params.num_beams);
  for (int i = 0; i < params.num_beams; ++i) {
    const double angle = params.angle_min + i * step;
    const Eigen::Vector3d direction =
        X_ML.rotation * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const double noise = rng->Normal(0.0, params.noise);  // drawn whatever is hit
    const double range = sight.Cast(X_ML.translation, direction);
    ranges.push_back(range > params.range_max ? INFINITY
                                              : std::max(range + noise, params.range_min));
  }
  return ranges;
}

}  // namespace hires::simulation
