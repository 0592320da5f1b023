#pragma once

#include <embree3/rtcore.h>

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "hires/geometry/shape.h"

namespace hires::perception {

struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using ScenePointer = std::unique_ptr<RTCSceneTy, SceneDeleter>;

/// One scene for each unit shape and each mesh; constant once all meshes are in it.
class MeshLibrary {
 public:
  MeshLibrary();
  /// Makes known the mesh of `shape`; nothing to do for other shapes.
  void Add(const geometry::Shape& shape);
  RTCScene Find(const geometry::Shape& shape) const;  ///< null for a mesh that was not added

 private:
  ScenePointer box_, cylinder_, sphere_;
  std::map<std::shared_ptr<const geometry::TriangleMesh>, ScenePointer> meshes_;
};

struct RayHit {
  double distance{0.0};
  int owner{0};
  Eigen::Vector3d n_M;  ///< unit vector out of the surface
};

/// Placed shapes that rays meet, each with a number for its owner. Surfaces count from outside
/// only.
class RayScene {
 public:
  RayScene();
  /// @param library  outlives this; a mesh that is not in it is read on the spot.
  void Add(const MeshLibrary& library, const geometry::Shape& shape, const geometry::Pose3& X_MS,
           int owner);
  void Commit();  ///< after the last Add

  /// @param direction     of length 1.
  /// @param except_owner  is passed through; -1: none.
  std::optional<RayHit> FirstHit(const Eigen::Vector3d& from_M, const Eigen::Vector3d& direction,
                                 double max_distance, int except_owner = -1) const;
  bool IsBlocked(const Eigen::Vector3d& from_M, const Eigen::Vector3d& direction,
                 double max_distance, int except_owner = -1) const;

  static constexpr int kPacket = 8;
  /// Rays from one point that go side by side, which costs less than one after the other.
  /// @param hits  of each ray what was met nearer before, as its `distance`; replaced where this
  /// scene is met nearer still.
  /// @pre at most kPacket directions, each of length 1.
  void FirstHits(const Eigen::Vector3d& from_M, const std::vector<Eigen::Vector3f>& directions,
                 int owner_offset, std::vector<RayHit>* hits) const;

 private:
  struct Instance {
    int owner{0};
    Eigen::Matrix3f to_shape;  ///< turns directions in the map into those of the unscaled shape
  };
  struct Context;
  static void Accept(const RTCFilterFunctionNArguments* arguments);
  Context MakeContext(int except_owner) const;
  static Eigen::Vector3d NormalInMap(const Instance& met, const Eigen::Vector3f& n_S);

  ScenePointer scene_;
  std::vector<ScenePointer> own_;  // meshes that no library has
  std::vector<Instance> instances_;
};

}  // namespace hires::perception
