#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/perception/point_cloud.h"
#include "hires/simulation/laser_scanner.h"
#include "sim_robot/sim_robot_world.h"

namespace hires::sim_robot {

/// The lasers of the robot that stands in for a real one, beside that of its base. They see the
/// robot itself, as real ones do. Their links are the profile's.
struct SimLaserParams {
  simulation::LaserParams tray, tilting;
  double tilt_period{0.025};  ///< [s], a multiple of a look (world::kFallLookInterval)
};

/// The blocks `tray_laser` and `tilting_laser` of a file like config/sim_robot.yaml.
/// @throws base::ConfigError naming file and key.
SimLaserParams ReadSimLaserParams(base::ParamReader* in);

/// Scans of the tray's laser and of the one that nods, and where its scans are taken. The nodding
/// joint is no part of the simulator: it follows the robot's clock.
class SimRobotLasers {
 public:
  /// @param rng  of all noise; forked only, for each moment.
  SimRobotLasers(const SimLaserParams& params, const base::Rng& rng,
                 std::shared_ptr<const simulation::Scene> scene);

  bool has_tray_laser() const;
  bool has_tilting_laser() const;
  const simulation::LaserParams& tray() const { return params_.tray; }
  const simulation::LaserParams& tilting() const { return params_.tilting; }
  double tilt_period() const { return params_.tilt_period; }
  int num_scans_of_a_sweep() const;  ///< @pre has_tilting_laser()

  std::vector<double> TrayScan(const SimRobotWorld& world) const;  ///< [m]  @pre has_tray_laser()

  bool IsTiltDue(const SimRobotWorld& world) const;
  /// @pre of those below: has_tilting_laser().
  robot::TiltPhase TiltPhase(const SimRobotWorld& world) const;
  std::vector<double> TiltScan(const SimRobotWorld& world) const;  ///< [m]
  /// Where it is in the odometry's frame, as tf tells it.
  /// @param readings  of the last tick: of the joints below it, which move slowly.
  geometry::Pose3 X_OTilt(const SimRobotWorld& world, const SensorReadings& readings) const;

 private:
  const robot::TiltingLaser& nodding() const {
    return *scene_->robot.profile.sensors.tilting_laser;
  }

  SimLaserParams params_;
  const base::Rng tray_rng_, tilt_rng_;
  const std::shared_ptr<const simulation::Scene> scene_;
};

/// Gathers the scans of each sweep of a nodding laser to one cloud, without points that may veil an
/// edge, as a PR2 does.
class SweepCloud {
 public:
  /// @param num_scans  that a whole sweep has at least.
  explicit SweepCloud(int num_scans) : num_needed_(num_scans) {}

  /// Takes the scan of this moment; those of the way back are left out.
  /// @return once a sweep is over of which no scan was missed: its points in the frame O, not
  /// organised.
  std::optional<perception::PointCloud> Add(const robot::TiltPhase& phase,
                                            const simulation::LaserParams& laser,
                                            const std::vector<double>& ranges,
                                            const geometry::Pose3& X_OL);

 private:
  int num_needed_, num_scans_{0};
  long sweep_{-1};
  perception::PointCloud gathered_;
};

}  // namespace hires::sim_robot
