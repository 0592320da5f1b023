#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/recogniser.h"
#include "hires/robot/robot_profile.h"

namespace hires::perception {

/// A thing on a random table, as it really is.
struct TableThing {
  std::string name, model;                        ///< instance; kind
  bool is_known{true};                            ///< in the catalogue
  geometry::Pose3 X_CO{};                         ///< in the cloud's frame
  Eigen::Vector3d size{Eigen::Vector3d::Zero()};  ///< [m] of its box, along its own axes
  int num_points{0};  ///< pixels of the picture without noise that it covers, within range
  double visible_share{0.0};
};

struct RandomTable {
  PointCloud cloud{};
  CameraStand stand{};
  std::vector<TableThing> things{};
  std::vector<int> owner{};  ///< of each pixel, index of `things`; -1: something else
  double distance{0.0};      ///< [m] from the camera to the table's middle
  int torso{0};              ///< 0 down, 1 half way, 2 up
};

/// Tables of the restaurant with one to eight things that a robot looks at through its head's
/// camera, to try a recogniser on: four of five are of the catalogue, the others boxes and
/// cylinders unlike all of it; none is hidden by more than 60 % of its surface towards the camera.
/// Noise is that of DepthSensorParams.
class RandomTables {
 public:
  /// @param robot    one with an upper body.
  /// @param objects  path of a catalogue of objects; kinds larger than 0.6 m are left out.
  RandomTables(robot::Robot robot, const std::string& objects);
  ~RandomTables();

  /// The scene of a seed is always the same.
  RandomTable Make(std::uint64_t seed) const;
  const std::vector<KnownModel>& catalogue() const { return catalogue_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::vector<KnownModel> catalogue_;
};

}  // namespace hires::perception
