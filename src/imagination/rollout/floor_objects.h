#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/imagination/rollout.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::imagination {

/// Whether an object stands where the base's laser scans, so that the robot drives around it.
bool IsInLaserPlane(const simulation::Scene& scene, const world::ObjectState& object);

/// What a rollout's robot sees of the loose objects in its laser's plane: their outlines where it
/// believes them, up to 2.5 m away (obstacle_range of the PR2's costmaps).
class FloorObjects {
 public:
  static constexpr double kRange = 2.5;  ///< [m] from the base to an object's origin

  /// @param objects  as the simulator has them, by index.
  FloorObjects(const simulation::Scene& scene, const std::vector<world::ObjectState>& objects);

  /// @param X_MB  where the robot believes to stand.
  std::vector<geometry::Polygon> SeenBy(const simulation::RobotSimulator& simulator,
                                        const geometry::Pose2& X_MB) const;

 private:
  struct Object {
    int index{0};
    std::shared_ptr<const world::ObjectModel> model;
  };
  double height_{0.0};  // [m] of the laser above the floor
  std::vector<Object> objects_;
};

}  // namespace hires::imagination
