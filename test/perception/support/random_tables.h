#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/recogniser.h"
#include "hires/robot/robot_profile.h"

namespace hires::test_support {

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
  perception::PointCloud cloud{};
  perception::CameraStand stand{};
  std::vector<TableThing> things{};
  std::vector<int> owner{};  ///< of each pixel, index of `things`; -1: something else
  double distance{0.0};      ///< [m] from the camera to the table's middle
  int torso{0};              ///< 0 down, 1 half way, 2 up
};

/// Tables of the restaurant with one to eight things that a PR2 looks at through its head's camera.
class RandomTables {
 public:
  /// @param config  folder of the package that has robots and objects.
  explicit RandomTables(const std::string& source);
  ~RandomTables();

  /// Whatever the generator is given, the scene of a seed is the same.
  RandomTable Make(std::uint64_t seed) const;
  const std::vector<perception::KnownModel>& catalogue() const { return catalogue_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::vector<perception::KnownModel> catalogue_;
};

}  // namespace hires::test_support
