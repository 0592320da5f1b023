#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/inertia.h"
#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::world {

/// A liquid in an upright round vessel, for the warnings about sloshing; physics does not play it.
struct Liquid {
  double radius{0.0};  ///< [m] inner radius of the vessel at the surface
  double fill{0.0};    ///< [m] depth of the liquid
  double rim{0.0};     ///< [m] height of the rim over the inner bottom, >= fill
};

/// One kind of loose object: a single rigid body. Origin B lies at the height of its lowest point
/// (ours: centre of the supporting face); of a world's model where its file puts it.
struct ObjectModel {
  std::string name;
  geometry::MassProperties mass_properties;
  std::vector<geometry::Collision> collisions;
  std::string concept_name{};  ///< of the ontology, as the catalogue says; empty: it says none
  /// What people should know who trust an answer about it, as World::notes; of an object's file
  /// alone, as those of a world's model are the world's. No part of the hash.
  std::vector<std::string> notes{};
  std::optional<Liquid> liquid{};  ///< what it is known to hold; no part of the hash
};

/// A body that never moves: wall, table, chair.
struct StaticBody {
  std::string name;
  geometry::Pose3 X_MB;
  std::vector<geometry::Collision> collisions;
};

struct ObjectState {
  std::string name;         ///< instance, "peppermill1"
  std::string model;        ///< as World::FindModel knows it
  geometry::Pose3 X_MO;     ///< object in map
  geometry::Twist3 V_MO;    ///< in map axes
  std::string attached_to;  ///< robot link that holds it rigidly, or empty
};

/// What changes about a world: small, copyable.
struct WorldState {
  std::vector<ObjectState> objects;

  const ObjectState* Find(const std::string& name) const;  ///< case ignored; nullptr if absent
  ObjectState* Find(const std::string& name);
};

constexpr double kAreaSize = 0.35;  ///< [m] of an area that the world says no extent of

/// What does not change about a world, shared by all that use it. Names keep the case of the file
/// and compare without regard to it.
struct World {
  std::string name;
  double gravity{9.81};  ///< [m/s^2], along -z
  double floor_friction{1.0};
  std::vector<StaticBody> statics;                     ///< the floor z = 0 is implied
  std::map<std::string, geometry::Pose3> frames;       ///< areas, X_MF; lower-case keys
  std::map<std::string, std::string> frame_names;      ///< lower case -> as in the file
  std::map<std::string, Eigen::AlignedBox2d> extents;  ///< as ExtentOf, of areas that say one
  std::map<std::string, std::shared_ptr<const ObjectModel>> models;  ///< by name
  WorldState initial;
  /// [m] by which the heights of the file were lowered, as robots stand higher there than at z = 0
  /// (OnItsFloor). For people: no part of the hash.
  double lowered_by{0.0};
  /// [m] How far below the floor z = 0 ground lies where no static body bears a robot (OnItsFloor).
  /// 0: the floor is a plane without end; infinity: nothing is known to be there.
  double ground_depth{0.0};
  /// What people should know of the world who trust an answer about drives in it: whole sentences
  /// without a full stop. No part of the hash.
  std::vector<std::string> notes;
  /// Where static bodies and their shapes stand, "hall.world:12", by their names (NameOf); empty
  /// where no file of a world has them. For people: no part of the hash.
  std::map<std::string, std::string> sources;
  std::uint64_t hash{0};  ///< of everything but `initial`; independent of the file's layout

  std::optional<geometry::Pose3> FindFrame(const std::string& name) const;
  std::vector<std::string> FrameNames() const;
  /// Where things stand on an area, in the x and y of its frame [m]: what the world says of it,
  /// else the square of kAreaSize round its origin.
  Eigen::AlignedBox2d ExtentOf(const std::string& area) const;
  /// The kind of thing of that name: one of `models`, or the box that the name says
  /// (unknown_box.h). Null if it is neither.
  std::shared_ptr<const ObjectModel> FindModel(const std::string& model) const;
  /// @throws base::ConfigError naming the models that come near, or what is wrong with the box.
  std::shared_ptr<const ObjectModel> RequireModel(const std::string& model) const;
  /// What the object is made of. @throws base::ConfigError as RequireModel, naming the object.
  std::shared_ptr<const ObjectModel> ModelOf(const ObjectState& object) const;
  std::uint64_t ComputeHash() const;
};

/// What a shape of a body is called: "wall"; of a body of several shapes "house::coat_stand", as
/// far as its file gives names.
std::string NameOf(const StaticBody& body, const geometry::Collision& shape);

/// Where what is called so stands in its file; "" where that is not known.
std::string SourceOf(const std::string& name, const World& world);

/// Reads an SDF world as docs/command_line.md tells. Models that are `<static>` or fixed to the
/// world become StaticBody, those that can move and are one body loose objects (one ObjectModel per
/// distinct description), all others StaticBody as well; `<frame>` elements become areas, and
/// `<hires:extent>xmin ymin xmax ymax</hires:extent>` in one says where things stand on it. What is
/// played otherwise than it is written, or left out, is said in World::notes and to base::Log.
/// @param model_path  Where `model://name` is looked for besides (ModelFoldersFor).
/// @throws base::ConfigError naming all that is wrong, each with file, element and remedy:
/// malformed SDF, two models of one name, missing meshes or models, unphysical inertia of what can
/// move, shapes that are not supported, poses that are not finite or lie more than 1 km away.
World LoadWorld(const std::string& sdf_path, const std::vector<std::string>& model_path = {});

/// Reads a single-link object from an SDF model (.sdf, or its folder) or a URDF (.urdf), or a
/// cylinder or box of given size and mass (.yaml: docs/command_line.md). Where its origin is not at
/// the height of its lowest point, it is put there; its name has letters, digits and _ alone,
/// others become _. What is played otherwise than it is written is said in ObjectModel::notes and
/// to base::Log.
/// @throws base::ConfigError as LoadWorld, and as base::ParamReader.
ObjectModel LoadObjectModel(const std::string& path);

/// What it is called, for one that is loaded later: nothing is said.  @throws as LoadObjectModel.
std::string ObjectNameIn(const std::string& path);

/// An extent without its outermost `edge` [m]; it goes on holding the origin.
Eigen::AlignedBox2d Inset(const Eigen::AlignedBox2d& extent, double edge);

/// The same world with one more kind of object; replaces a model of the same name.
World WithModel(World world, ObjectModel model);

}  // namespace hires::world
