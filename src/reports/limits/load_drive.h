#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/start_state.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::reports {

/// What the base is told next: to come to a velocity, by steps of a local planner.
struct DriveStep {
  geometry::Twist2 V_B;      ///< [m/s], [rad/s]
  double linear_rate{0.5};   ///< [m/s^2] at which commands approach it
  double angular_rate{0.5};  ///< [rad/s^2]
  double hold{0.0};          ///< [s] that it is commanded for
  bool is_silent{false};     ///< nothing is commanded: the controller's time-out strikes
  /// Where a base comes no nearer to V_B (wheels slip, motors are at their end), what it does then
  /// is what is driven; else that is an error.
  bool may_fall_short{false};
};
using LoadDrive = std::vector<DriveStep>;

/// What became of the payloads, in the order in which they were named.
struct DriveOutcome {
  /// It fell, or slid by more than standing.slide in one step of the drive.
  std::vector<bool> fell;
  /// [m] The largest distance on the tray, level, from where it was when a step of the drive began.
  std::vector<double> slide;
  double simulated{0.0};  ///< [s]

  bool AnyFell() const;
  double MaxSlide() const;  ///< [m]
};

/// Where drives are played: an even, empty floor, the payloads alone on the tray.
struct DriveStage {
  const imagination::ImaginationSetup* setup{nullptr};
  std::shared_ptr<const simulation::Scene> scene;
  imagination::StartState start;
  double command_period{0.1};     ///< [s]
  bool ends_at_first_fall{true};  ///< false: when all payloads fell
  /// Called after each step of a drive, to record it; may be empty.
  std::function<void(const simulation::RobotSimulator&)> on_step{};
};

/// @throws base::ConfigError as imagination::StartOnTray.
DriveStage MakeDriveStage(const imagination::ImaginationSetup& setup,
                          const std::vector<std::string>& objects, double command_period);

/// Plays the drive in one truth, until a payload has fallen or nothing shakes any more. Each step
/// begins when the payloads have come to rest on the tray (for 5 s at most), so that what one step
/// lets them slide does not offset what the next one does.
/// @pre the last step that may fall short is followed by one that commands a stand, or nothing.
/// @param rng  of the truth, and of what the simulator draws.
DriveOutcome PlayDrive(const DriveStage& stage, const LoadDrive& drive, const base::Rng& rng);

/// What PlayDrive draws of robot, floor and object.
simulation::Variation VariationOfDrive(const DriveStage& stage, const base::Rng& rng);

}  // namespace hires::reports
