#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hires/perception/detector_errors.h"
#include "hires/perception/recogniser.h"
#include "hires/perception/surroundings.h"
#include "hires/robot/robot_profile.h"
#include "hires/sensing/object_memory.h"
#include "hires/simulation/floor_places.h"
#include "hires/simulation/laser_params.h"
#include "hires/simulation/robot_clearance.h"
#include "hires/world/world.h"

namespace hires::simulation {

class SelfLocalisation;
struct PoseErrorParams;

/// Scans of the base's laser that skills get to see.
struct ScanParams {
  LaserParams laser;   ///< its link is that of the robot's profile
  double period{0.2};  ///< [s]
};

/// What the robot's senses are played by.
struct Sight {
  /// How a quick detector errs that stands in for a recogniser; null: by noise alone.
  std::shared_ptr<const perception::DetectorErrors> errors;
  /// A recogniser that looks at what the camera measures, instead; null: the quick detector.
  std::shared_ptr<const perception::Recogniser> recogniser;
  std::optional<ScanParams> scans;  ///< none: skills see no scan
};

/// A constant world with a constant robot in it, shared by all simulators of it.
struct Scene {
  world::World world;
  robot::Robot robot;
  std::vector<geometry::Collision> robot_shapes_B;  ///< joints frozen in the driving posture
  RobotClearance clearance;
  geometry::Pose3 X_BO;  ///< where an object is put on the tray, in the base frame

  /// The parts that move with the base whatever the joints do; all, if there is no upper body.
  std::vector<geometry::Collision> base_shapes_B;
  RobotClearance base_clearance;  ///< of those
  /// What the robot's camera and laser look at; null where it has neither.
  std::shared_ptr<const perception::Surroundings> surroundings;
  sensing::MemoryParams memory;  ///< of what that camera sees
  Sight sight;
  std::optional<double> laser_height;  ///< [m] of the base's laser above the floor; none: no laser
  /// How the robot finds its place by itself; null: it is told.
  std::shared_ptr<const SelfLocalisation> self_localisation;
  /// How what it is told errs, where it does not find its place by itself; null: as drawn.
  std::shared_ptr<const PoseErrorParams> pose_error;
  FloorPlaces floor;  ///< what the floor has that no map tells; imagination: nothing

  /// Whether the robot sees objects; if not, it knows of none by itself.
  bool has_camera() const { return robot.profile.upper_body.has_value(); }
  /// What that camera looks at; null without one.
  std::shared_ptr<const perception::Surroundings> in_camera() const {
    return has_camera() ? surroundings : nullptr;
  }
};

/// Collision shapes in the base frame with the joints frozen in `posture`.
/// @throws base::ConfigError as robot::ForwardKinematics.
std::vector<geometry::Collision> FrozenShapes(const robot::Robot& robot,
                                              const robot::JointPositions& posture);

/// @throws base::ConfigError if robot and profile do not fit.
std::shared_ptr<const Scene> MakeScene(world::World world, robot::Robot robot,
                                       const sensing::MemoryParams& memory = {},
                                       const Sight& sight = {});

}  // namespace hires::simulation
