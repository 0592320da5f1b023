#include "hires/simulation/fall_watch.h"

namespace hires::simulation {

world::Fall FallWatch::Look(const RobotSimulator& simulator, int object) {
  const bool is_held = !simulator.HolderOf(object).empty();
  if (!is_held && !was_free_) stands_on_robot_ = simulator.StandsOnRobot(object);
  was_free_ = !is_held;
  return detector_.Update(simulator.PoseOf(object), is_held, simulator.time(),
                          stands_on_robot_ ? simulator.X_MB() : geometry::Pose3());
}

void FallWatch::Reset() {
  detector_.Reset();
  was_free_ = false;
}

}  // namespace hires::simulation
