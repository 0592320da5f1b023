#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/readings.h"
#include "hires/simulation/robot_simulator.h"
#include "hires/world/standing.h"
#include "sim_robot/truth.h"

namespace hires::sim_robot {

class BumpSchedule;

/// Simulated time [ms] from one tick of the robot's sensors to the next.
inline constexpr long kSensorTick = 50;
/// Simulated time [ms] from one word of its joints and wheels to the next.
inline constexpr long kJointTick = 10;
/// Simulated time [ms] from one look for falls to the next, of world::kFallLookInterval.
inline constexpr long kLookTick = static_cast<long>(1000.0 * world::kFallLookInterval + 0.5);
static_assert(kJointTick % kLookTick == 0, "what sensors say is the end of a look");

/// Where the robot and all loose objects are at first.
/// @param scenario  file; empty: the world's own objects, the robot at `area`.
/// @throws base::ConfigError naming scenario, area, arm, posture or object.
imagination::StartState StartOf(const imagination::ImaginationSetup& setup,
                                const std::string& scenario, const std::string& area);

/// As finely as the robot can be played: level planar where something above its base moves.
simulation::LevelOfDetail LevelFor(const simulation::Scene& scene);

/// What the robot's own sensors say at one moment.
struct SensorReadings {
  robot::OdometryReading odometry;
  robot::JointReading joints;
  geometry::Pose2 X_MB;  ///< where its localisation says that it stands
  geometry::Pose2 X_MO;  ///< where its odometry began, by the same
  /// [m^2, m rad, rad^2] of x, y, yaw, as localisation has it; one that is told says 0.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  /// Of a robot that hands on what it measures (Localisation::kNothing); its odometry is then that
  /// of the wheels alone, and X_MB, X_MO are the truth.
  std::optional<robot::ImuReading> inertia;
  std::vector<geometry::Polygon> ghosts_M;  ///< seen by the laser, though not there
};

/// A pose with how sure it is: [m^2, m rad, rad^2] of x, y, yaw.
struct ToldPlace {
  geometry::Pose2 X_MB;
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
};

/// The robot and its world as they really are: a simulator with a truth that was drawn once and is
/// not published, odometry that drifts, and a command line of base velocities that stalls now and
/// then. It sees no topics and no clock but its own; the same calls give the same bits.
class SimRobotWorld {
 public:
  /// @param imagined  what imagination has; `truth` says how far from it things really are.
  /// The load settles for half a second that counts nowhere.
  /// @throws base::ConfigError as RobotSimulator.
  SimRobotWorld(const imagination::ImaginationSetup& imagined, const imagination::StartState& start,
                std::uint64_t seed, const Truth& truth = {});
  ~SimRobotWorld();

  void Apply(const robot::Command& command);
  void Advance(long milliseconds);  ///< of its own time
  SensorReadings Sense();           ///< draws noise

  long milliseconds() const { return milliseconds_; }  ///< since the start
  const simulation::RobotSimulator& simulator() const { return *simulator_; }
  const std::shared_ptr<const simulation::Scene>& scene() const { return setup_->scene; }
  const geometry::Pose2& X_OB() const { return X_OB_; }  ///< by odometry, as Sense says it
  /// What somebody who sets the robot down tells it of its place, roughly; nothing of one that
  /// tells its place itself, or that has moved since.
  std::optional<ToldPlace> ToldStart() const;
  /// How the camera's recogniser errs.
  double detection_noise() const { return variation_.detection_noise; }          ///< [m]
  double detection_noise_yaw() const { return variation_.detection_noise_yaw; }  ///< [rad]
  double recognition_errors() const { return variation_.recognition_errors; }    ///< factor

  // What tests and demonstrations do to it. All answer with why not, or empty.
  std::string Push(const geometry::Pose2& offset);  ///< new base in the old base frame
  std::string Remove(const std::string& object);
  std::string Place(const std::string& object, const std::string& model,
                    const geometry::Pose3& X_MO);
  std::string Drop(const std::string& object);  ///< off the tray or out of the hand, to the floor

 private:
  double time() const { return 0.001 * static_cast<double>(milliseconds_); }
  void Bump();
  void Walk(double dt);
  void Deliver(const geometry::Twist2& velocity);
  void DeliverLate();
  void MoveOdometry(double dt);
  geometry::Twist2 VelocityByOdometry() const;
  void BeginToMeasure(std::shared_ptr<const simulation::SelfLocalisationParams> params,
                      const base::Rng& rng);
  void Measure();
  void NoteSent(const robot::Command& command);
  robot::Command RestOfMotions(const world::WorldState& world) const;
  std::string Rebuild(world::WorldState world, const robot::RobotState& robot);
  bool RidesAlong(const world::ObjectState& object, const geometry::Pose2& X_MB) const;

  std::shared_ptr<const imagination::ImaginationSetup> setup_;
  base::Rng control_rng_, simulator_rng_;
  std::uint64_t num_rebuilt_{0};
  long steps_per_millisecond_{1};
  simulation::Variation variation_;
  double odometry_scale_{1.0};  // wheels slip: what odometry counts per metre
  std::unique_ptr<simulation::RobotSimulator> simulator_;
  long milliseconds_{0};
  geometry::Pose2 X_OB_;

  // Of a robot that hands on what it measures.
  std::optional<simulation::MotionSensors> motion_;
  double moved_{0.0};  // [s] up to which they measured
  geometry::Pose2 X_MBstart_;
  ToldPlace told_start_;

  /// What a group of joints was told last.
  struct SentTrajectory {
    double time;  // [s]
    robot::JointTrajectory trajectory;
  };
  std::map<std::string, SentTrajectory> trajectories_;     // by group
  std::map<std::string, robot::GripperCommand> grippers_;  // by arm

  // What imagination does not model.
  std::unique_ptr<BumpSchedule> bumps_;  // null: nobody bumps into it
  bool is_pushed_{false};
  LocalisationWalk walk_;
  base::Rng walk_rng_;
  geometry::Pose2 walk_error_;  // believed pose in the one that it would believe otherwise

  // A control cycle that comes late: its commands wait until then.
  double last_delivery_{-1e9};  // [s]
  double late_until_{-1e9};     // [s]
  std::optional<geometry::Twist2> held_back_;
};

}  // namespace hires::sim_robot
