#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/detector_errors.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/recogniser_config.h"
#include "hires/perception/tabletop_recogniser.h"
#include "hires/robot/robot_profile.h"

namespace hires::perception {

/// A thing on a random table, as it really is.
struct TableThing {
  std::string name, model;                          ///< instance; kind
  bool is_known{true};                              ///< in the catalogue
  geometry::Pose3 X_CO{};                           ///< in the cloud's frame
  Eigen::Vector3d size{Eigen::Vector3d::Zero()};    ///< [m] of its box, along its own axes
  Eigen::Vector3d middle{Eigen::Vector3d::Zero()};  ///< [m] of that box, from its own origin
  int num_points{0};   ///< pixels of the picture without noise that it covers, within range
  ThingInView view{};  ///< by the quick detector's means, which know no pixels
};

/// What random tables are like.
struct TableVariety {
  double farthest{1.4};     ///< [m] of the robot's base from the table's middle; nearest: 0.8
  double most_hidden{0.6};  ///< of the surface of each thing towards the camera
  double gap{0.02};         ///< [m] between things, at least
  Eigen::Vector3d table{1.6, 0.8, 0.71};  ///< [m] long, wide, high: the restaurant's table_160x80
  /// How wrong the robot is about where its camera sits: sd of each axis [rad], [m]; assumed.
  double mount_angle{0.005}, mount_position{0.005};
};

struct RandomTable {
  PointCloud cloud{};
  CameraStand stand{};                         ///< as the robot believes it
  geometry::Pose3 X_BC{};                      ///< cloud in the robot's base, as it is
  geometry::Pose3 X_BCknown{};                 ///< ... and as the robot believes it
  std::vector<geometry::Collision> robot_B{};  ///< as ShapesOf
  std::vector<TableThing> things{};
  std::vector<int> owner{};  ///< of each pixel, index of `things`; -1: something else
  double distance{0.0};      ///< [m] from the camera to the table's middle
  int torso{0};              ///< 0 down, 1 half way, 2 up
};

/// Tables of the restaurant with one to eight things that a robot looks at through its head's
/// camera, to try a recogniser on: four of five are of the catalogue, the others boxes and
/// cylinders unlike all of it. Noise is that of DepthSensorParams.
class RandomTables {
 public:
  /// @param robot  one with an upper body, whose profile says the camera and three or more torso
  ///               postures: torsodownposture, torsomiddleposture, torsoupposture.
  /// @param known  what stands there: its catalogue without what is too large for it.
  RandomTables(robot::Robot robot, const RecogniserConfig& known, const TableVariety& variety = {});
  ~RandomTables();

  /// The scene of a seed is always the same; each look at it has noise of its own.
  RandomTable Make(std::uint64_t seed, int look = 0) const;
  const std::vector<KnownModel>& catalogue() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// As the robot does it: its own shapes are cut out, and of the camera it knows what it believes.
/// @return in the cloud's frame; without table and detections where no table is seen.
TabletopView LookAtTable(std::shared_ptr<const Recogniser> recogniser, const RandomTable& table,
                         const robot::Robot& robot, const base::Rng& rng);

}  // namespace hires::perception
