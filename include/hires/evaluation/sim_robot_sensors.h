#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/evaluation/sim_robot_world.h"
#include "hires/perception/detector.h"
#include "hires/simulation/laser_scanner.h"
#include "hires/simulation/truth_record.h"

namespace hires::evaluation {

/// Simulated time [ms] from one tick of the robot's sensors to the next.
inline constexpr long kSensorTick = 50;
/// Simulated time [ms] from one word of its joints and wheels to the next.
inline constexpr long kJointTick = 10;

/// Lets the world go on by kJointTick; the record looks for falls meanwhile.
void PlayJointTick(SimRobotWorld* world, simulation::TruthRecord* truth);

/// What the robot has besides wheels and joints.
struct SimSensorParams {
  simulation::LaserParams laser;  ///< its link is the robot's own
  double min_visible_share{0.3};  ///< of an object's surface towards the camera
  double detection_period{0.5};   ///< [s], a multiple of the tick
  Recogniser recogniser;          ///< what it does wrong beside its noise
};

/// The blocks `laser` and `detector` of a file like config/sim_robot.yaml.
/// @throws base::ConfigError naming file and key.
SimSensorParams ReadSimSensorParams(base::ParamReader in);

/// How they are under this truth.
SimSensorParams SensorsOf(const Truth& truth, SimSensorParams params);

/// Base laser and head camera of the robot that stands in for a real one. Their noise is a stream
/// of its own for each moment: asked twice, they say the same twice.
class SimRobotSensors {
 public:
  /// @param seed  of all noise.
  SimRobotSensors(const SimSensorParams& params, std::uint64_t seed,
                  std::shared_ptr<const simulation::Scene> scene);

  bool has_laser() const { return !laser_.link.empty() && scene_->surroundings != nullptr; }
  const simulation::LaserParams& laser() const { return laser_; }
  /// [m] of each beam, obstacles that are not there included.  @pre has_laser().
  std::vector<double> Scan(const SimRobotWorld& world, const SensorReadings& readings) const;

  /// What the camera's recogniser sees, where it is time to look and the head is still; poses in
  /// the camera's frame. Nothing: it does not look.
  std::optional<std::vector<perception::Detection>> Look(const SimRobotWorld& world,
                                                         const SensorReadings& readings);

 private:
  void Misjudge(std::vector<perception::Detection>* seen, base::Rng rng) const;
  bool IsLookDue(const SimRobotWorld& world, const SensorReadings& readings) const;

  const SimSensorParams params_;
  const std::shared_ptr<const simulation::Scene> scene_;
  simulation::LaserParams laser_;
  std::optional<long> last_look_;                         // [ms] of the camera
  const base::Rng scan_rng_, detector_rng_, missed_rng_;  // forked for each moment
  const base::Rng bias_rng_;                              // forked for each object
};

}  // namespace hires::evaluation
