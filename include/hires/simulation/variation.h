#pragma once

#include <Eigen/Core>

#include "hires/geometry/pose.h"

namespace hires::simulation {

/// The hidden truth of one rollout: how far this world, this robot and this control loop are from
/// the nominal ones. The default is "exactly nominal".
struct Variation {
  double mass_factor{1.0};                  ///< of every loose object
  double radius_factor{1.0};                ///< of the faces on which round objects stand
  double com_height_factor{1.0};            ///< of the centre of mass above the supporting face
  Eigen::Vector2d com_offset{0.0, 0.0};     ///< [m] of the centre of mass, in the object's frame
  double friction_factor{1.0};              ///< of every contact with a loose object
  Eigen::Vector2d object_offset{0.0, 0.0};  ///< [m] where objects stand on the tray, in its frame
  geometry::Pose2 start_offset;  ///< where the robot really starts, in its nominal start frame

  geometry::Pose2 localisation_bias;   ///< believed pose in the true base frame
  double localisation_noise{0.0};      ///< [m] sd of each believed x and y
  double localisation_noise_yaw{0.0};  ///< [rad] sd of each believed yaw
  double ghost_rate{0.0};              ///< [1/s] obstacles seen that do not exist, each for 4.6 s

  double wheel_slip{0.0};              ///< sd of the relative speed error, correlated over 0.1 s
  double floor_roughness{0.0};         ///< [m] sd of the floor's height
  double command_delay{0.0};           ///< [s] more than the robot's nominal lag
  double late_cycle_probability{0.0};  ///< of each control cycle
  double late_cycle_delay{0.0};        ///< [s] how late such a cycle comes
  double loop_damping_factor{1.0};     ///< of the base's velocity loop
  double wheel_damping_factor{1.0};    ///< of the rolling of wheels on casters
  double sway_factor{1.0};             ///< of the base's leaning

  /// How far off the hand objects are that are held at the start: [m] along the x axis (where the
  /// hand points) and the z axis of the link that holds them ...
  Eigen::Vector2d grasp_offset{0.0, 0.0};
  double grasp_turn{0.0};  ///< [rad] ... and turned about its y axis (from finger to finger)

  double detection_noise{0.0};      ///< [m] sd of each coordinate of a seen object
  double detection_noise_yaw{0.0};  ///< [rad] sd of a seen object's turn about its own z axis
  double recognition_errors{0.0};   ///< times those that a recogniser was found to make
  double scan_noise{0.0};           ///< [m] sd of each echo of the base's laser
  double encoder_noise{0.0};        ///< [rad] or [m] sd of each measured joint
};

}  // namespace hires::simulation
