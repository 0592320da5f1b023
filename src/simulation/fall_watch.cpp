#include "hires/simulation/fall_watch.h"

namespace hires::simulation {

world::Fall FallWatch::Look(const RobotSimulator& simulator, int object) {
  const bool is_held = !simulator.HolderOf(object).empty();
  if (!is_held && !was_free_) stands_on_robot_ = simulator.StandsOnRobot(object);
  was_free_ = !is_held;
  geometry::Pose3 X_MO = simulator.PoseOf(object);
  if (simulator.IsBall(object) && X_MO.IsFinite()) X_MO.rotation.setIdentity();
  return detector_.Update(X_MO, is_held, simulator.time(),
                          stands_on_robot_ ? simulator.X_MB() : geometry::Pose3());
}

void FallWatch::Reset() {
  detector_.Reset();
  was_free_ = false;
}

}  // namespace hires::simulation
