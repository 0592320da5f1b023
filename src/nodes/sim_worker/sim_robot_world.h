#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/ros/robot_messages.h"
#include "hires/simulation/robot_simulator.h"
#include "nodes/sim_worker/sim_robot_params.h"

namespace hires_ros {

/// Where the robot and all loose objects are at first: as the scenario says, or by area and world.
/// @throws hires::base::ConfigError naming scenario, area, arm, posture or object.
hires::imagination::StartState StartOf(const hires::imagination::ImaginationSetup& setup,
                                       const SimRobotParams& params);

/// As finely as the robot can be played: level planar where something above its base moves.
hires::simulation::LevelOfDetail LevelFor(const hires::simulation::Scene& scene);

/// What the robot's own sensors say at one moment.
struct SensorReadings {
  OdometryReading odometry;
  JointReading joints;
  hires::geometry::Pose2 X_MB;                     ///< where its localisation says that it stands
  hires::geometry::Pose2 X_MO;                     ///< where its odometry began, by the same
  std::vector<hires::geometry::Polygon> ghosts_M;  ///< seen by the laser, though not there
};

/// The robot and its world as they really are: a simulator with a truth that was drawn once and is
/// not published, odometry that drifts, and a command line of base velocities that stalls now and
/// then. It sees no topics and no clock but its own; the same calls give the same bits.
class SimRobotWorld {
 public:
  /// The load settles for half a second that counts nowhere.
  /// @throws hires::base::ConfigError as RobotSimulator.
  SimRobotWorld(const hires::imagination::ImaginationSetup& setup,
                const hires::imagination::StartState& start, std::uint64_t seed);

  void Apply(const hires::robot::Command& command);
  void Advance(long milliseconds);  ///< of its own time
  SensorReadings Sense();           ///< draws noise

  long milliseconds() const { return milliseconds_; }  ///< since the start
  const hires::simulation::RobotSimulator& simulator() const { return *simulator_; }
  /// How the camera's recogniser errs.
  double detection_noise() const { return variation_.detection_noise; }          ///< [m]
  double detection_noise_yaw() const { return variation_.detection_noise_yaw; }  ///< [rad]

  // What tests and demonstrations do to it. All answer with why not, or empty.
  std::string Push(const hires::geometry::Pose2& offset);  ///< new base in the old base frame
  std::string Remove(const std::string& object);
  std::string Place(const std::string& object, const std::string& model,
                    const hires::geometry::Pose3& X_MO);
  std::string Drop(const std::string& object);  ///< off the tray or out of the hand, to the floor

 private:
  double time() const { return 0.001 * static_cast<double>(milliseconds_); }
  void Deliver(const hires::geometry::Twist2& velocity);
  void DeliverLate();
  void MoveOdometry(double dt);
  void NoteSent(const hires::robot::Command& command);
  hires::robot::Command RestOfMotions(const hires::world::WorldState& world) const;
  std::string Rebuild(hires::world::WorldState world, const hires::robot::RobotState& robot);
  bool RidesAlong(const hires::world::ObjectState& object,
                  const hires::geometry::Pose2& X_MB) const;

  std::shared_ptr<const hires::imagination::ImaginationSetup> setup_;
  hires::base::Rng control_rng_, simulator_rng_;
  std::uint64_t num_rebuilt_{0};
  long steps_per_millisecond_{1};
  hires::simulation::Variation variation_;
  double odometry_scale_{1.0};  // wheels slip: what odometry counts per metre
  std::unique_ptr<hires::simulation::RobotSimulator> simulator_;
  long milliseconds_{0};
  hires::geometry::Pose2 X_OB_;

  /// What a group of joints was told last.
  struct SentTrajectory {
    double time;  // [s]
    hires::robot::JointTrajectory trajectory;
  };
  std::map<std::string, SentTrajectory> trajectories_;            // by group
  std::map<std::string, hires::robot::GripperCommand> grippers_;  // by arm

  // A control cycle that comes late: its commands wait until then.
  double last_delivery_{-1e9};  // [s]
  double late_until_{-1e9};     // [s]
  std::optional<hires::geometry::Twist2> held_back_;
};

}  // namespace hires_ros
