#include "simulation/ghost_obstacles.h"

#include <cmath>

namespace hires::simulation {
namespace {

using geometry::Pose2;

constexpr double kLifetime = 4.6;  // [s] persistence of ground objects in the robot's filter
constexpr double kSize = 0.10;     // [m] edge: a voxel of the obstacle filter

}  // namespace

void GhostObstacles::Update(const Pose2& X_MB, double rate, double time) {
  const double elapsed = time - last_update_;
  last_update_ = time;
  while (!ghosts_.empty() && ghosts_.front().until <= time) ghosts_.pop_front();
  const double chance = 1.0 - std::exp(-rate * elapsed);
  if (rate == 0.0 || !rng_.Bernoulli(chance)) return;
  const double distance = rng_.Uniform(0.8, 2.5), bearing = rng_.Uniform(-1.0, 1.0);
  const Pose2 X_MG = X_MB * Pose2{distance * std::cos(bearing), distance * std::sin(bearing), 0.0};
  const double h = kSize / 2;
  ghosts_.push_back(
      {geometry::Transformed(X_MG, {{-h, -h}, {h, -h}, {h, h}, {-h, h}}), time + kLifetime});
}

std::vector<geometry::Polygon> GhostObstacles::OutlinesInMap() const {
  std::vector<geometry::Polygon> outlines;
  for (const Ghost& ghost : ghosts_) outlines.push_back(ghost.outline_M);
  return outlines;
}

}  // namespace hires::simulation
