#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/world/world.h"

namespace hires::perception {

/// A point of an object's surface, with a share of it.
struct SurfacePoint {
  Eigen::Vector3d p_O;  ///< [m] in the object's frame
  Eigen::Vector3d n_O;  ///< unit vector outwards
  double area{0.0};     ///< [m^2] that it stands for
};

/// What lines of sight need of a world and what never changes: its static bodies and the meshes
/// that rays meet (Embree), made once, and a fixed pattern of points on the hull of each of its
/// models. Constant; any number of LineOfSight in any threads share it.
///
/// Round shapes are prisms and globes of 64 sides inside of the true ones: distances are up to
/// 0.24 % of the radius too long. Embree counts in single precision: 1e-6 m at 10 m.
class Surroundings {
 public:
  explicit Surroundings(const world::World& world);
  ~Surroundings();
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;

  /// @throws base::ConfigError naming the models that come near.
  const world::ObjectModel& Model(const std::string& model) const;
  bool Has(const std::string& model) const;
  /// Points that lie within another shape of the model are left out.
  /// @throws base::ConfigError as Model.
  const std::vector<SurfacePoint>& Surface(const std::string& model) const;

 private:
  friend class LineOfSight;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::perception
