#include "hires/simulation/laser_scanner.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/localisation/laser_mount.h"

namespace hires::simulation {
namespace {

constexpr int kRays = 8;              // across a beam
constexpr double kOneSurface = 0.03;  // [m] by which neighbouring rays may differ on one surface

Eigen::Vector3d DirectionOf(const geometry::Pose3& X_ML, double angle) {
  return X_ML.rotation * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
}

/// What one echo, or two, are measured as.
/// @param ranges  of kRays rays; sorted here.
double MixedRange(double* ranges, double mixing_depth) {
  std::sort(ranges, ranges + kRays);
  int num_near = 1;
  while (num_near < kRays && ranges[num_near] - ranges[num_near - 1] <= kOneSurface) ++num_near;
  const auto mean = [&](int begin, int end) {
    double sum = 0.0;
    for (int i = begin; i < end; ++i) sum += ranges[i];
    return sum / (end - begin);
  };
  const double near = mean(0, num_near);
  if (num_near == kRays) return near;
  const double far = mean(num_near, kRays);
  if (far - near <= mixing_depth) return mean(0, kRays);
  return 2 * num_near >= kRays ? near : far;
}

/// [m] of each beam, without noise.
std::vector<double> RangesOf(const perception::LineOfSight& sight, const geometry::Pose3& X_ML,
                             const LaserParams& params) {
  std::vector<double> ranges;
  if (params.beam_width == 0.0) {
    for (int i = 0; i < params.num_beams; ++i)
      ranges.push_back(sight.Cast(X_ML.translation, DirectionOf(X_ML, AngleOf(params, i))));
    return ranges;
  }
  std::vector<Eigen::Vector3d> rays;
  for (int i = 0; i < params.num_beams; ++i) {
    for (int k = 0; k < kRays; ++k) {
      const double aside = params.beam_width * ((k + 0.5) / kRays - 0.5);
      rays.push_back(DirectionOf(X_ML, AngleOf(params, i) + aside));
    }
  }
  std::vector<double> met = sight.Cast(X_ML.translation, rays);
  for (int i = 0; i < params.num_beams; ++i)
    ranges.push_back(MixedRange(&met[i * kRays], params.mixing_depth));
  return ranges;
}

void RequireSurroundings(const RobotSimulator& simulator) {
  HIRES_CHECK(simulator.scene().surroundings,
              "only a robot with a base laser or an upper body has surroundings to scan");
}

std::vector<geometry::Collision> ShapesOf(const RobotSimulator& simulator) {
  const robot::RobotState state = simulator.GetRobotState();
  return perception::ShapesOf(simulator.scene().robot, state.X_MB, state.joints);
}

}  // namespace

robot::ScanReading ReadingOf(const std::vector<double>& ranges, const LaserParams& params) {
  const double increment = (params.angle_max - params.angle_min) / (params.num_beams - 1);
  return {params.angle_min, increment, params.range_min, {ranges.begin(), ranges.end()}};
}

LevelScan ScanLevel(const RobotSimulator& simulator, const LaserParams& params, base::Rng* rng) {
  LevelScan scan;
  scan.reading = ReadingOf(ScanLaser(simulator, params, rng), params);
  const geometry::Pose3 X_BL =
      geometry::Lift(simulator.base().X_MB).Inverse() * simulator.X_MLink(params.link);
  scan.X_BL = localisation::LevelLaser(X_BL, &scan.reading).value_or(geometry::Flatten(X_BL));
  return scan;
}

double AngleOf(const LaserParams& params, int beam) {
  const double step = (params.angle_max - params.angle_min) / (params.num_beams - 1);
  return params.angle_min + beam * step;
}

std::vector<double> ScanLaserFrom(const geometry::Pose3& X_ML, const RobotSimulator& simulator,
                                  const LaserParams& params, base::Rng* rng) {
  RequireSurroundings(simulator);
  HIRES_CHECK(params.num_beams >= 2, "a laser has two beams at least");
  const perception::LineOfSight sight(
      simulator.scene().surroundings, simulator.GetWorldState().objects,
      params.sees_robot ? ShapesOf(simulator) : std::vector<geometry::Collision>{});
  std::vector<double> ranges = RangesOf(sight, X_ML, params);
  for (double& range : ranges) {
    const double noise = rng->Normal(0.0, params.noise);  // drawn whatever is hit
    range = range > params.range_max ? INFINITY : std::max(range + noise, params.range_min);
  }
  return ranges;
}

std::vector<double> ScanLaser(const RobotSimulator& simulator, const LaserParams& params,
                              base::Rng* rng) {
  RequireSurroundings(simulator);
  return ScanLaserFrom(simulator.X_MLink(params.link), simulator, params, rng);
}

}  // namespace hires::simulation
