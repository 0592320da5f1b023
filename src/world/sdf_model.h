#pragma once

#include <map>
#include <memory>
#include <optional>
#include <sdf/Model.hh>
#include <sdf/SemanticPose.hh>
#include <string>
#include <vector>

#include "hires/world/world.h"
#include "world/resource_finder.h"

namespace hires::world {

/// Farthest that anything may lie from the origin of its frame [m].
constexpr double kMaxDistance = 1000.0;

/// Each mesh file is read once per scale and shared by all that name it.
class MeshCache {
 public:
  /// @param where  Opens the error message.  @throws base::ConfigError as geometry::ReadMesh.
  std::shared_ptr<const geometry::TriangleMesh> Read(const std::string& path,
                                                     const Eigen::Vector3d& scale,
                                                     const std::string& where);

  /// Those that are hardly in metres, a sentence each with file, size and remedy.
  std::vector<std::string> Doubts() const;
  /// "; mesh ... is ..." of a shape that is such a mesh; else "".
  std::string DoubtAbout(const geometry::Shape& shape) const;

 private:
  std::map<std::string, std::shared_ptr<const geometry::TriangleMesh>> meshes_;
  std::map<const geometry::TriangleMesh*, std::string> doubts_;
};

/// @throws base::ConfigError if `shape` has a size that is not finite and above 0, or `pose` is not
/// finite or lies beyond kMaxDistance, or the coefficients lie outside their ranges.
void CheckCollision(const geometry::Collision& collision, const std::string& where);
void CheckPose(const geometry::Pose3& pose, const std::string& where);

/// The pose in the frame named `in` (of the pose's own scope), relative_to followed.
geometry::Pose3 PoseIn(const sdf::SemanticPose& pose, const std::string& in,
                       const std::string& where);

/// "file:line: model 'x'" for messages.
std::string Where(const sdf::Model& model);

/// A model that cannot move: <static>, or its only link is fixed to the world by its only joint.
bool IsStatic(const sdf::Model& model);

/// Shapes of a model that cannot move, in the model's frame; a link's name precedes its collisions'
/// names where there are several links.
struct StaticShapes {
  std::vector<geometry::Collision> collisions;
  std::map<std::string, std::string> places;  ///< "file:line" of each, by its name
  std::optional<double> floor_friction;  ///< of a plane z = 0 in the world, if the model has one
};
StaticShapes StaticShapesOf(const sdf::Model& model, const geometry::Pose3& X_MB,
                            const ResourceFinder& finder, MeshCache* meshes);

/// A model that can move, named like the model. Its origin is that of the model.
ObjectModel LooseObjectOf(const sdf::Model& model, const ResourceFinder& finder, MeshCache* meshes);

}  // namespace hires::world
