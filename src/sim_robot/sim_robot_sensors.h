#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/perception/detector.h"
#include "hires/perception/tabletop_recogniser.h"
#include "hires/simulation/laser_scanner.h"
#include "hires/simulation/truth_record.h"
#include "sim_robot/sim_robot_cameras.h"
#include "sim_robot/sim_robot_lasers.h"
#include "sim_robot/sim_robot_world.h"

namespace hires::sim_robot {

/// Lets the world go on by kJointTick; the record looks for falls meanwhile.
/// @param at_look  is called after each look (world::kFallLookInterval), if there is one.
void PlayJointTick(SimRobotWorld* world, simulation::TruthRecord* truth,
                   const std::function<void()>& at_look = {});

/// What the robot has besides wheels and joints.
struct SimSensorParams {
  simulation::LaserParams laser;  ///< its link is the robot's own
  double min_visible_share{0.3};  ///< of an object's surface towards the camera
  double detection_period{0.5};   ///< [s], a multiple of the tick
  Recogniser recogniser;          ///< what it does wrong beside its noise
  bool sees_pictures{false};      ///< objects are recognised in what the depth camera measures ...
  std::shared_ptr<const perception::Recogniser> eye;  ///< ... by this one; null: by another program
  SimCameraParams cameras;
  SimLaserParams lasers;
};

/// The blocks of the sensors of a file like config/sim_robot.yaml.
/// @throws base::ConfigError naming file and key.
SimSensorParams ReadSimSensorParams(base::ParamReader in);

/// Nothing errs by chance, and beams are lines.
void DropNoise(SimSensorParams* params);

/// How they are under this truth.
SimSensorParams SensorsOf(const Truth& truth, SimSensorParams params);

/// Sensors beside wheels and joints of the robot that stands in for a real one. Their noise is a
/// stream of its own for each moment: asked twice, they say the same twice.
class SimRobotSensors {
 public:
  /// @param seed  of all noise.
  SimRobotSensors(const SimSensorParams& params, std::uint64_t seed,
                  std::shared_ptr<const simulation::Scene> scene);

  bool has_laser() const { return !laser_.link.empty(); }
  const simulation::LaserParams& laser() const { return laser_; }
  /// [m] of each beam, obstacles that are not there included.  @pre has_laser().
  std::vector<double> Scan(const SimRobotWorld& world, const SensorReadings& readings) const;

  bool sees_pictures() const { return params_.sees_pictures; }
  /// Whether it is time to look and the head is still; the next look comes a period later. Asked
  /// twice at one moment, it says the same twice.
  bool BeginLook(const SimRobotWorld& world, const SensorReadings& readings);
  /// What the camera's recogniser sees, where it is time to look and the head is still; poses in
  /// the camera's frame. Nothing: it does not look, or where pictures are seen, sees no table.
  std::optional<perception::Sighting> Look(const SimRobotWorld& world,
                                           const SensorReadings& readings);

  /// What the thermal camera sees at the same time; null unless pictures are seen and there is one.
  std::shared_ptr<const perception::HeatView> LookForHeat(const SimRobotWorld& world,
                                                          const SensorReadings& readings) const;

  SimRobotCameras& cameras() { return cameras_; }
  const SimRobotLasers& lasers() const { return lasers_; }

 private:
  std::vector<perception::Detection> Detect(const SimRobotWorld& world) const;
  std::optional<perception::Sighting> Recognise(const SimRobotWorld& world,
                                                const SensorReadings& readings);
  void Misjudge(std::vector<perception::Detection>* seen, base::Rng rng) const;
  bool IsLookDue(const SimRobotWorld& world, const SensorReadings& readings) const;

  const SimSensorParams params_;
  const std::shared_ptr<const simulation::Scene> scene_;
  simulation::LaserParams laser_;
  std::optional<long> last_look_;                         // [ms] of the camera
  const base::Rng scan_rng_, detector_rng_, missed_rng_;  // forked for each moment
  const base::Rng bias_rng_;                              // forked for each object
  SimRobotCameras cameras_;
  SimRobotLasers lasers_;
  std::optional<perception::TabletopRecogniser> eye_;
};

}  // namespace hires::sim_robot
