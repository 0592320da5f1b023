#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hires/base/check.h"
#include "hires/navigation/a_star.h"
#include "hires/navigation/dwa.h"
#include "navigation/scenes.h"
#include "navigation/velocity_window.h"

namespace hires::navigation::test_support {

inline const robot::MotionSet kFast{0.55, 1.0, 2.5, 3.2};
inline const robot::MotionSet kSlow{0.30, 1.0, 1.4, 2.0};

/// A base that follows velocity commands at its own controller's accelerations, without delay.
struct IdealBase {
  geometry::Pose2 X_MB;
  geometry::Twist2 V_B;
  double linear_acceleration{2.0}, angular_acceleration{2.0};

  void Step(const geometry::Twist2& wanted, double dt) {
    const auto ramp = [dt](double now, double to, double acceleration) {
      return std::clamp(to, now - acceleration * dt, now + acceleration * dt);
    };
    V_B.vx = ramp(V_B.vx, wanted.vx, linear_acceleration);
    V_B.vy = ramp(V_B.vy, wanted.vy, linear_acceleration);
    V_B.wz = ramp(V_B.wz, wanted.wz, angular_acceleration);
    X_MB = PoseAfter(X_MB, V_B, dt);
  }
};

struct Scene {
  world::OccupancyGrid grid;
  std::vector<geometry::Polygon> obstacles;  ///< what is in the grid, but exact

  void Add(double x_min, double y_min, double x_max, double y_max) {
    AddRectangle(&grid, x_min, y_min, x_max, y_max);
    obstacles.push_back(Rectangle(x_min, y_min, x_max, y_max));
  }
  Costmap MakeCostmap() const { return Costmap(grid, kInscribedRadius, {}); }

  static constexpr double kInscribedRadius = 0.34;
};

/// An empty floor of `width` x `height` [m] in cells of 0.05 m.
inline Scene EmptyScene(double width, double height) {
  return {FreeGrid(std::lround(width / 0.05), std::lround(height / 0.05)), {}};
}

struct Cycle {
  geometry::Pose2 X_MB;  ///< at its beginning
  geometry::Twist2 V_B;
  DwaResult result;
};

struct Drive {
  DwaStatus status{DwaStatus::kDriving};  ///< of the last cycle
  std::vector<Cycle> cycles;
  IdealBase base;                                             ///< at the end
  double duration{0.0};                                       ///< [s]
  double clearance{std::numeric_limits<double>::infinity()};  ///< [m] to the exact obstacles
};

inline geometry::Polygon PaddedFootprint() { return geometry::Padded(Pr2Footprint(), 0.015); }

/// Closed loop of planner and ideal base until the planner arrives or gives up, or time is out.
/// @param X_BBelieved  where the base takes itself to be, in the true base.
inline Drive DriveWith(DwaPlanner* planner, const Costmap& costmap, IdealBase base,
                       const std::vector<geometry::Polygon>& obstacles, double longest = 60.0,
                       const geometry::Pose2& X_BBelieved = {}) {
  const double period = DwaParams{}.control_period;
  const int substeps = 10;
  Drive drive;
  while (drive.status == DwaStatus::kDriving && drive.duration < longest) {
    const DwaResult result = planner->Update(costmap, base.X_MB * X_BBelieved, base.V_B);
    drive.cycles.push_back({base.X_MB, base.V_B, result});
    drive.status = result.status;
    if (drive.status != DwaStatus::kDriving) break;
    for (int i = 0; i < substeps; ++i) {
      base.Step(result.velocity, period / substeps);
      const auto outline = geometry::Transformed(base.X_MB, Pr2Footprint());
      for (const auto& obstacle : obstacles) {
        drive.clearance = std::min(drive.clearance, geometry::Distance(outline, obstacle));
      }
    }
    drive.duration += period;
  }
  drive.base = base;
  return drive;
}

/// Plans a path by A* and drives it. The path must exist.
inline Drive DriveTo(const Scene& scene, const geometry::Pose2& X_MStart,
                     const geometry::Pose2& X_MGoal, const robot::MotionSet& limits) {
  const Costmap costmap = scene.MakeCostmap();
  const PathResult path = PlanPath(costmap, X_MStart, X_MGoal);
  HIRES_CHECK(path.status == PathStatus::kFound, "the scene has a path");
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetMotionSet(limits);
  planner.SetPath(path.path);
  IdealBase base;
  base.X_MB = X_MStart;
  return DriveWith(&planner, costmap, base, scene.obstacles);
}

}  // namespace hires::navigation::test_support
