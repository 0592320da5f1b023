#pragma once

#include "hires/simulation/robot_simulator.h"
#include "hires/world/standing.h"

namespace hires::simulation {

/// Follows one loose object of a simulator, imagined or true, and says when it falls. A thing that
/// stands on the robot is judged from where it stands on the robot, any other from where it stands
/// in the room. A ball never leans: it slides or drops.
class FallWatch {
 public:
  explicit FallWatch(const world::StandingCriterion& criterion) : detector_(criterion) {}

  /// One look at the object with that index; it may get another index if the simulator is replaced.
  /// @return the fall that this look completes.
  world::Fall Look(const RobotSimulator& simulator, int object);

  /// It was put elsewhere from outside; see FallDetector.
  void Reset();
  const world::FallDetector& detector() const { return detector_; }

 private:
  world::FallDetector detector_;
  bool was_free_{false};         // at the last look, if there was one since Reset()
  bool stands_on_robot_{false};  // where it began to stand
};

}  // namespace hires::simulation
