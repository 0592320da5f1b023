#pragma once

#include <memory>
#include <optional>

#include "hires/base/rng.h"
#include "hires/robot/observation.h"
#include "hires/robot/scan_memory.h"
#include "hires/simulation/base_drive.h"
#include "hires/simulation/pose_error.h"
#include "hires/simulation/scene.h"
#include "hires/simulation/self_localisation.h"
#include "hires/simulation/variation.h"
#include "simulation/ghost_obstacles.h"
#include "simulation/planar_robot.h"

namespace hires::simulation {

/// What localisation, laser filter and encoders say. Draws their noise.
class RobotSensors {
 public:
  struct State {
    base::Rng rng;
    GhostObstacles ghosts;
    base::Rng encoder_rng;
    std::optional<SelfLocaliser> localiser;  // where the robot finds its place by itself
    std::optional<PoseErrorWalk> told;       // where it is told as if it did
    base::Rng scan_rng;
    double next_scan{0.0};                          // [s]
    std::shared_ptr<const robot::PlacedScan> scan;  // the last; null: none yet
    double scanned{0.0};                            // [s] when that was taken
    std::optional<robot::ScanMemory> memory;        // where skills see scans
    geometry::Pose2 X_OB;                           // by odometry of a robot that is told its place
    geometry::Pose2 X_MBread;                       // of the last reading
  };

  /// @param X_MB  of the base at first.
  /// @param rng   of the simulator; its forks 2, 3, 4, 6, 7 and 8 are used.
  RobotSensors(std::shared_ptr<const Scene> scene, const Variation& variation,
               const geometry::Pose2& X_MB, const base::Rng& rng);

  /// Of the base at `time`: where it is believed to be, its velocity, obstacles.
  void ReadBase(double time, const BaseMotion& motion, robot::Observation* observation);
  /// Who finds the place, if the robot does; asked before ReadBase, that it may scan.
  SelfLocaliser* localiser() { return state_.localiser ? &*state_.localiser : nullptr; }
  /// The believed base in the true one as of the last reading, unless it errs as drawn.
  std::optional<geometry::Pose2> place_error() const;
  /// Whether skills are to see a new scan at `time`, and what to draw its noise from.
  base::Rng* ScanDue(double time);
  /// @param observation  of ReadBase; gets the scan, and so do later ones until the next is due.
  void ReadScan(double time, robot::ScanReading reading, const geometry::Pose2& X_BL,
                robot::Observation* observation);
  /// Of torso, head, arms and hands.
  void ReadJoints(const PlanarRobot& robot, robot::Observation* observation);

  const State& Save() const { return state_; }
  void Restore(const State& state) { state_ = state; }

 private:
  void ReadOdometry(const BaseMotion& motion, robot::Observation* observation);
  void AddEncoderNoise(robot::JointPositions* joints);

  std::shared_ptr<const Scene> scene_;
  Variation variation_;
  double odometry_scale_;  // wheels slip: what odometry counts per metre
  State state_;
};

}  // namespace hires::simulation
