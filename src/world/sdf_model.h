#pragma once

#include <map>
#include <memory>
#include <optional>
#include <sdf/Model.hh>
#include <sdf/SemanticPose.hh>
#include <string>
#include <vector>

#include "hires/geometry/mesh_reader.h"
#include "hires/world/world.h"
#include "world/floor_level.h"
#include "world/resource_finder.h"
#include "world/sdf/load_notes.h"

namespace hires::world {

/// Farthest that anything that is played may lie from the origin of its frame [m].
constexpr double kMaxDistance = 1000.0;
constexpr double kMaxSize = 1e5;     ///< [m] of a shape: ground without end is written so
constexpr double kMaxWritten = 1e6;  ///< [m] from the origin; farther away it is another's

/// Each mesh file, or part of it, is read once per scale and shared by all that name it.
class MeshCache {
 public:
  /// @param scale_text  how the file gives a scale, "{}" for the numbers.
  explicit MeshCache(const char* scale_text = "<scale>{}</scale>") : scale_text_(scale_text) {}

  /// @param where  Opens the error message.  @throws base::ConfigError as geometry::ReadMesh.
  std::shared_ptr<const geometry::TriangleMesh> Read(const std::string& path,
                                                     const Eigen::Vector3d& scale,
                                                     const std::string& where,
                                                     const geometry::Submesh& submesh = {});

  /// Those that are hardly in metres, a sentence each with file, size and remedy.
  std::vector<std::string> Doubts() const;
  /// "; mesh ... is ..." of a shape that is such a mesh; else "".
  std::string DoubtAbout(const geometry::Shape& shape) const;

 private:
  std::map<std::string, std::shared_ptr<const geometry::TriangleMesh>> meshes_;
  std::map<const geometry::TriangleMesh*, std::string> doubts_;
  std::string scale_text_;
};

/// @throws base::ConfigError if `shape` has a size that is not finite and above 0, or `pose` is not
/// finite or lies beyond `farthest` [m], or the coefficients lie outside their ranges.
void CheckCollision(const geometry::Collision& collision, const std::string& where,
                    double farthest = kMaxDistance);
void CheckPose(const geometry::Pose3& pose, const std::string& where,
               double farthest = kMaxDistance);

/// The pose in the frame named `in` (of the pose's own scope), relative_to followed.
geometry::Pose3 PoseIn(const sdf::SemanticPose& pose, const std::string& in,
                       const std::string& where, double farthest = kMaxDistance);

/// "file:line: model 'x'" for messages.
std::string Where(const sdf::Model& model);

/// Shapes of a model that cannot move, in the model's frame; a link's name precedes its collisions'
/// names where there are several links.
struct StaticShapes {
  std::vector<geometry::Collision> collisions;
  std::map<std::string, std::string> places;  ///< "file:line" of each, by its name
  std::vector<FloorPlane> floors;
};

/// What a model of a world is played as: an object if it can move, else its shapes, of which there
/// may be none.
struct PlayedModel {
  StaticShapes shapes;
  std::optional<ObjectModel> object;  ///< named like the model; its origin is that of the model
};

/// How others hold a model.
enum class Hold {
  kNone,
  kFixed,  ///< to the world, or to what is
  kJoint,  ///< to another model, by a joint
};

/// What is needed to read models, and takes what there is to say of them.
struct ModelReading {
  const ResourceFinder& finder;
  MeshCache* meshes;
  LoadNotes* notes;
};

/// A model is still if it is <static>, or all its links are fixed to the world. Else links and
/// models in it that are held together by fixed joints are one object, of their masses and inertias
/// taken together. What cannot be played so (joints that move, parts that nothing holds together,
/// no mass) stands still where it is at joint zero, and what has no shape is left out; both is
/// said. Inertials of what stands still are not looked at. What is wrong becomes problems of the
/// notes.
PlayedModel PlayedModelOf(const sdf::Model& model, const geometry::Pose3& X_MB, Hold hold,
                          const ModelReading& reading);

/// A model that can move. @throws base::ConfigError if it cannot be played as one object.
ObjectModel LooseObjectOf(const sdf::Model& model, const ModelReading& reading);

}  // namespace hires::world
