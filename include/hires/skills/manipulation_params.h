#pragma once

#include "hires/base/param_reader.h"
#include "hires/manipulation/arm_kinematics.h"
#include "hires/manipulation/arm_path.h"
#include "hires/manipulation/collision_scene.h"

namespace hires::skills {

/// When a motion of joints counts as finished. Tolerances of the PR2's own controllers.
struct JointGoalParams {
  double torso_tolerance{0.01};    ///< [m]
  double arm_tolerance{0.02};      ///< [rad] each joint
  double head_tolerance{0.02};     ///< [rad] each joint
  double settling_time{0.1};       ///< [s] within tolerance at the end of a motion
  double time_limit_factor{1.5};   ///< of a trajectory's duration ...
  double time_limit_surplus{5.0};  ///< [s] ... and so much more, then it has timed out
};

struct GripperParams {
  double gap_tolerance{0.003};  ///< [m] opened as far as wanted
  double min_held_gap{0.005};   ///< [m] closed further than this, nothing is held
  double rest_time{0.2};        ///< [s] the fingers have stood still for so long: closed
  double rest_motion{0.001};    ///< [m] that is still counted as standing still
  double time_limit{3.0};       ///< [s] until opened or closed
};

struct LookParams {
  double dwell{0.5};            ///< [s] that the head rests on a target
  double margin{0.05};          ///< [rad] of the field of view's rim that does not count
  double time_limit{4.0};       ///< [s] until an object must have been seen
  int sightings{6};             ///< of an object, averaged before it is grasped
  double search_distance{1.5};  ///< [m] placing areas within it may hold an unseen object
  double part_spacing{0.07};    ///< [m] of the points that an area is looked at by
};

struct PickParams {
  int max_grasps{24};       ///< that are tried in thought before giving up
  double lift{0.10};        ///< [m] straight up after closing
  int max_return_tries{3};  ///< searches for a way back to the side
};

struct PlaceParams {
  double area_edge{0.035};       ///< [m] inside an area's extent where nothing is put
  double spot_spacing{0.025};    ///< [m] between spots that are considered
  double clearance{0.05};        ///< [m] from an object's outline to the next: room for fingers
  int max_spots{6};              ///< tried in thought before giving up
  int headings{16};              ///< of the object that are tried at each spot
  double above{0.10};            ///< [m] over the spot, where the straight way down begins
  double release_height{0.005};  ///< [m] over the support, where the fingers open
  double retreat{0.12};          ///< [m] straight back after opening
  /// [m] between where it was put and where it stands: how well it was put, not whether it fell.
  double standing_tolerance{0.05};
  double slot_distance{0.13};  ///< [m] between places on the tray
};

/// Everything that moving arms, torso and head depends on; section `manipulation` of
/// config/scene.yaml.
struct ManipulationParams {
  double period{0.05};         ///< [s] control cycle
  int seed{1};                 ///< of all searches, together with the action's text
  double speed{0.95};          ///< share of the joints' limits on free ways: room to catch up
  double straight_speed{0.3};  ///< ... on straight ways to and from objects
  double straight_step{0.01};  ///< [m] between two points of a straight way
  JointGoalParams goal;
  GripperParams gripper;
  LookParams look;
  PickParams pick;
  PlaceParams place;
  manipulation::ArmPathParams path;
  manipulation::InverseParams inverse;
  manipulation::CollisionParams collision;
};

/// @throws base::ConfigError naming file and key.
ManipulationParams ReadManipulationParams(base::ParamReader in);

}  // namespace hires::skills
