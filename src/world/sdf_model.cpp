#include "world/sdf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sdf/Box.hh>
#include <sdf/Collision.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Geometry.hh>
#include <sdf/Link.hh>
#include <sdf/Mesh.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>
#include <set>

#include "geometry/mesh_units.h"
#include "hires/base/error.h"
#include "hires/geometry/mesh_reader.h"
#include "world/mend_object.h"
#include "world/sdf/link_mass.h"
#include "world/sdf/model_links.h"
#include "world/sdf/prune_sdf.h"
#include "world/sdf/shapes.h"
#include "world/sdf_file.h"

namespace hires::world {
namespace {

/// A plane counts as the floor within this height [m] and tilt [rad].
constexpr double kFloorTolerance = 1e-6;

Eigen::Vector3d ToEigen(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

geometry::Pose3 ToPose(const ignition::math::Pose3d& pose) {
  const auto& q = pose.Rot();
  Eigen::Quaterniond rotation(q.W(), q.X(), q.Y(), q.Z());
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;  // one pose, one hash
  return {ToEigen(pose.Pos()), rotation.normalized()};
}

double NumberAt(sdf::ElementPtr element, const std::vector<std::string>& path, double otherwise) {
  for (const std::string& name : path) {
    if (!element->HasElement(name)) return otherwise;
    element = element->GetElement(name);
  }
  return element->Get<double>();
}

std::string WhereIs(const sdf::Collision& collision) {
  return fmt::format("{}: collision '{}'", PlaceOf(collision.Element()), collision.Name());
}

/// Of ODE's friction pyramid the smaller side, as a thing slips that way first.
double FrictionOf(const sdf::Collision& collision) {
  const double otherwise = geometry::Collision().friction;
  const auto along = [&](const char* direction, double not_there) {
    return NumberAt(collision.Element(), {"surface", "friction", "ode", direction}, not_there);
  };
  const double mu = along("mu", otherwise);
  return std::min(mu, along("mu2", mu));
}

/// "hall.world:5 'door'" for notes.
std::string NotePlace(const sdf::Model& model) {
  return fmt::format("{} '{}'", PlaceOf(model.Element()), model.Name());
}

/// The line of its <uri>.
std::string WhereIsMesh(const sdf::Collision& collision) {
  const sdf::ElementPtr mesh =
      collision.Element()->GetElement("geometry")->GetElement("mesh")->GetElement("uri");
  return fmt::format("{}: collision '{}'", PlaceOf(mesh), collision.Name());
}

geometry::Shape MeshOf(const sdf::Mesh& mesh, const ModelReading& reading,
                       const std::string& where) {
  const std::string path = reading.finder.FindMesh(mesh.Uri(), mesh.FilePath(), where);
  return reading.meshes->Read(path, ToEigen(mesh.Scale()), where,
                              {mesh.Submesh(), mesh.CenterSubmesh()});
}

/// Of what PruneSdf left to libsdformat.
geometry::Shape ShapeOf(const sdf::Collision& collision, const ModelReading& reading) {
  const sdf::Geometry& geom = *collision.Geom();
  switch (geom.Type()) {
    case sdf::GeometryType::BOX:
      return geometry::Box{ToEigen(geom.BoxShape()->Size())};
    case sdf::GeometryType::CYLINDER:
      return geometry::Cylinder{geom.CylinderShape()->Radius(), geom.CylinderShape()->Length()};
    case sdf::GeometryType::SPHERE:
      return geometry::Sphere{geom.SphereShape()->Radius()};
    case sdf::GeometryType::MESH:
      return MeshOf(*geom.MeshShape(), reading, WhereIsMesh(collision));
    default:
      throw base::ConfigError(WhereIs(collision) +
                              ": its shape is not supported; use box, cylinder, sphere, mesh, or a "
                              "plane for the floor");
  }
}

std::vector<ShapePart> ShapesOf(const sdf::Collision& collision, const ModelReading& reading) {
  if (!OtherShapeOf(collision).empty()) return ShapePartsOf(collision, WhereIs(collision));
  return {{"", ShapeOf(collision, reading), {}}};
}

bool IsPlane(const sdf::Collision& collision) {
  return collision.Geom()->Type() == sdf::GeometryType::PLANE;
}

/// <empty/>, or a <geometry> that holds nothing.
bool IsEmpty(const sdf::Collision& collision) {
  return collision.Geom()->Type() == sdf::GeometryType::EMPTY && OtherShapeOf(collision).empty();
}

void AppendCollision(const sdf::Collision& collision, const geometry::Pose3& X_BL,
                     const std::string& prefix, const ModelReading& reading, StaticShapes* shapes) {
  const std::string where = WhereIs(collision);
  const geometry::Pose3 X_BC = X_BL * PoseIn(collision.SemanticPose(), "", where, kMaxWritten);
  for (const ShapePart& part : ShapesOf(collision, reading)) {
    geometry::Collision result;
    result.name = prefix + collision.Name() + part.suffix;
    result.shape = part.shape;
    result.X_BS = X_BC * part.X_CS;
    result.friction = FrictionOf(collision);
    result.restitution =
        NumberAt(collision.Element(), {"surface", "bounce", "restitution_coefficient"}, 0.0);
    CheckCollision(result, where, kMaxWritten);
    shapes->places[result.name] = PlaceOf(collision.Element());
    shapes->collisions.push_back(std::move(result));
  }
}

void AppendPlane(const sdf::Collision& collision, const geometry::Pose3& X_WL,
                 StaticShapes* shapes) {
  const std::string where = WhereIs(collision);
  const geometry::Pose3 X_WS = X_WL * PoseIn(collision.SemanticPose(), "", where, kMaxWritten);
  const Eigen::Vector3d normal = X_WS.rotation * ToEigen(collision.Geom()->PlaneShape()->Normal());
  if ((normal - Eigen::Vector3d::UnitZ()).norm() > kFloorTolerance) {
    throw base::ConfigError(
        where +
        ": the only planes supported are level ones that face up, of which the highest is "
        "the floor; use a static box instead");
  }
  geometry::Collision floor;
  floor.friction = FrictionOf(collision);
  CheckCollision(floor, where);
  shapes->floors.push_back({X_WS.translation.z(), floor.friction, where});
}

/// All shapes of all links, where they stand at joint zero.
StaticShapes ShapesOf(const ModelLinks& model, const geometry::Pose3& X_MB,
                      const ModelReading& reading) {
  StaticShapes shapes;
  for (const PlacedLink& link : model.links) {
    const std::string prefix = model.links.size() == 1 ? "" : link.name + "::";
    for (std::uint64_t i = 0; i < link.link->CollisionCount(); ++i) {
      const sdf::Collision& collision = *link.link->CollisionByIndex(i);
      if (IsEmpty(collision)) continue;
      try {
        if (IsPlane(collision)) {
          AppendPlane(collision, X_MB * link.X_ML, &shapes);
        } else {
          AppendCollision(collision, link.X_ML, prefix, reading, &shapes);
        }
      } catch (const base::ConfigError& error) {
        reading.notes->AddProblem(error.what());
      }
    }
  }
  std::sort(shapes.collisions.begin(), shapes.collisions.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return shapes;
}

/// A collision whose shape somebody forgot, other than <empty/>.
bool LacksShape(const sdf::Collision& collision) {
  const sdf::ElementPtr element = collision.Element();
  return IsEmpty(collision) &&
         !(element->HasElement("geometry") && element->GetElement("geometry")->HasElement("empty"));
}

void NoteMissingShapes(const ModelLinks& model, LoadNotes* notes) {
  for (const PlacedLink& link : model.links) {
    for (std::uint64_t i = 0; i < link.link->CollisionCount(); ++i) {
      const sdf::Collision& collision = *link.link->CollisionByIndex(i);
      if (!LacksShape(collision)) continue;
      notes->Add("collision", "whose <geometry> has no shape left out",
                 fmt::format("{} '{}'", PlaceOf(collision.Element()), collision.Name()));
    }
  }
}

bool HasShape(const sdf::Link& link) {
  for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
    if (!IsEmpty(*link.CollisionByIndex(i))) return true;
  }
  return false;
}

template <typename Condition>
bool AnyCollision(const ModelLinks& model, Condition condition) {
  for (const PlacedLink& link : model.links) {
    for (std::uint64_t i = 0; i < link.link->CollisionCount(); ++i) {
      if (condition(*link.link->CollisionByIndex(i))) return true;
    }
  }
  return false;
}

bool AnyLinkHas(const ModelLinks& model, const char* element) {
  return std::any_of(model.links.begin(), model.links.end(), [&](const PlacedLink& link) {
    return link.link->Element()->HasElement(element);
  });
}

constexpr char kStill[] = "stands still, as an obstacle";

/// Why physics cannot play a model as one body that can move.
struct Obstacle {
  std::string kind;     ///< of model, reads after "model"; "" if it can be played
  std::string made;     ///< what is made of it
  std::string where{};  ///< "hall.world:12", if it is not the model's own place
};

/// Its mass is said, and its inertia to be that of its shapes.
bool LacksInertia(const PlacedLink& link) {
  return HasShape(*link.link) && HasMassAlone(*link.link) && !HasAutomaticInertia(*link.link);
}

/// @param is_object  it is meant to move: a mass alone will do.
Obstacle WhyStill(const ModelLinks& model, Hold hold, bool is_object) {
  constexpr char kAtZero[] = "stands still where it is at joint zero, as an obstacle";
  if (!model.broken_joint.empty()) return {model.broken_joint, kAtZero, model.place_of_broken};
  if (model.has_moving_joint || hold == Hold::kJoint) return {"with joints", kAtZero};
  std::set<int> groups;
  for (const PlacedLink& link : model.links) {
    if (HasShape(*link.link)) groups.insert(link.group);
  }
  if (groups.size() > 1) return {"of parts that no fixed joint holds together", kStill};
  if (AnyLinkHas(model, kFloats)) return {"that is <kinematic> or without gravity", kStill};
  if (AnyCollision(model, IsPlane)) return {"with a plane that is not <static>", kStill};
  const auto is_faceted = [](const sdf::Collision& collision) {
    return OtherShapeOf(collision) == "ellipsoid";
  };
  if (AnyCollision(model, is_faceted))
    return {"with an <ellipsoid>, which physics plays still only", kStill};
  for (const PlacedLink& link : model.links) {
    if (!HasShape(*link.link) || HasWholeInertial(*link.link)) continue;
    if (is_object && LacksInertia(link)) continue;
    if (HasAutomaticInertia(*link.link)) {
      if (AutomaticMassOf(*link.link, link.X_ML)) continue;
      return {
          "whose inertia is to be worked out from its shape (<inertial auto='true'>), which is "
          "done for boxes, cylinders and spheres alone",
          kStill};
    }
    return {"without mass or inertia (<inertial>)", kStill};
  }
  return {"", ""};
}

/// Of all links that hold together with those that have shapes, as one body in the model's frame.
/// @pre WhyStill has nothing to say, and there are shapes.
geometry::MassProperties MassOf(const ModelLinks& model) {
  const auto shaped = std::find_if(model.links.begin(), model.links.end(),
                                   [](const PlacedLink& link) { return HasShape(*link.link); });
  std::vector<geometry::MassProperties> parts;
  for (const PlacedLink& link : model.links) {
    if (link.group != shaped->group) continue;
    const auto automatic = HasAutomaticInertia(*link.link)
                               ? AutomaticMassOf(*link.link, link.X_ML)
                               : std::nullopt;  // what is written beside it is not meant, then
    if (automatic) {
      parts.push_back(*automatic);
    } else if (HasWholeInertial(*link.link) || LacksInertia(link)) {
      parts.push_back(MassPropertiesOf(*link.link, link.X_ML));
    }
  }
  return parts.size() == 1 ? parts.front() : geometry::Together(parts);
}

/// Without shapes where something is wrong with all of them, which is told.
ObjectModel ObjectOf(const sdf::Model& model, const ModelLinks& links,
                     std::vector<geometry::Collision> shapes, LoadNotes* notes) {
  ObjectModel object{model.Name(), MassOf(links), std::move(shapes)};
  const bool is_said = std::none_of(links.links.begin(), links.links.end(), LacksInertia);
  const std::string mended = object.collisions.empty() ? "" : MendInertia(is_said, &object);
  if (!mended.empty()) notes->Add("model", mended, NotePlace(model));
  return object;
}

}  // namespace

std::shared_ptr<const geometry::TriangleMesh> MeshCache::Read(const std::string& path,
                                                              const Eigen::Vector3d& scale,
                                                              const std::string& where,
                                                              const geometry::Submesh& submesh) {
  const std::string key = fmt::format("{} {} {} {} {}\n{}", scale.x(), scale.y(), scale.z(),
                                      submesh.is_centred, submesh.name, path);
  auto& mesh = meshes_[key];
  if (mesh == nullptr) {
    try {
      mesh =
          std::make_shared<const geometry::TriangleMesh>(geometry::ReadMesh(path, scale, submesh));
    } catch (const base::ConfigError& error) {
      throw base::ConfigError(fmt::format("{}: {}", where, error.what()));
    }
    const std::string doubt = geometry::DoubtedUnit(path, *mesh, scale, {}, scale_text_);
    if (!doubt.empty()) doubts_[mesh.get()] = doubt;
  }
  return mesh;
}

std::vector<std::string> MeshCache::Doubts() const {
  std::set<std::string> doubts;  // in an order that no address decides
  for (const auto& [mesh, doubt] : doubts_) doubts.insert(doubt);
  return {doubts.begin(), doubts.end()};
}

std::string MeshCache::DoubtAbout(const geometry::Shape& shape) const {
  const auto* mesh = std::get_if<std::shared_ptr<const geometry::TriangleMesh>>(&shape);
  const auto found = mesh == nullptr ? doubts_.end() : doubts_.find(mesh->get());
  return found == doubts_.end() ? "" : "; " + found->second;
}

void CheckPose(const geometry::Pose3& pose, const std::string& where, double farthest) {
  if (!pose.IsFinite()) {
    throw base::ConfigError(where + ": its pose is not finite; write six finite numbers");
  }
  const Eigen::Vector3d& p = pose.translation;
  if (p.norm() > farthest) {
    throw base::ConfigError(fmt::format(
        "{}: lies at ({:g}, {:g}, {:g}) m, farther than {:g} m from the origin; move the origin "
        "closer",
        where, p.x(), p.y(), p.z(), farthest));
  }
}

void CheckCollision(const geometry::Collision& collision, const std::string& where,
                    double farthest) {
  std::vector<double> sizes;
  if (const auto* box = std::get_if<geometry::Box>(&collision.shape)) {
    sizes = {box->size.x(), box->size.y(), box->size.z()};
  } else if (const auto* cylinder = std::get_if<geometry::Cylinder>(&collision.shape)) {
    sizes = {cylinder->radius, cylinder->length};
  } else if (const auto* sphere = std::get_if<geometry::Sphere>(&collision.shape)) {
    sizes = {sphere->radius};
  }
  for (const double size : sizes) {
    if (size > 0.0 && size <= kMaxSize) continue;
    throw base::ConfigError(fmt::format("{}: has a size of {} m, wanted above 0 and at most {} m",
                                        where, size, kMaxSize));
  }
  CheckPose(collision.X_BS, where, farthest);
  if (!(collision.friction >= 0.0) || !std::isfinite(collision.friction)) {
    throw base::ConfigError(fmt::format("{}: friction <mu> is {}, wanted a finite number from 0 up",
                                        where, collision.friction));
  }
  if (!(collision.restitution >= 0.0 && collision.restitution <= 1.0)) {
    throw base::ConfigError(
        fmt::format("{}: restitution is {}, wanted between 0 and 1", where, collision.restitution));
  }
}

geometry::Pose3 PoseIn(const sdf::SemanticPose& pose, const std::string& in,
                       const std::string& where, double farthest) {
  ignition::math::Pose3d resolved;
  ThrowIfAny(pose.Resolve(resolved, in), where);
  const geometry::Pose3 result = ToPose(resolved);
  CheckPose(result, where, farthest);
  return result;
}

std::string Where(const sdf::Model& model) {
  return fmt::format("{}: model '{}'", PlaceOf(model.Element()), model.Name());
}

PlayedModel PlayedModelOf(const sdf::Model& model, const geometry::Pose3& X_MB, Hold hold,
                          const ModelReading& reading) {
  PlayedModel played;
  const ModelLinks links = LinksOf(model);
  const bool is_still =
      hold == Hold::kFixed || std::all_of(links.links.begin(), links.links.end(),
                                          [](const PlacedLink& link) { return link.group == 0; });
  const auto note = [&](const std::string& rest) {
    reading.notes->Add("model", rest, NotePlace(model));
  };
  NoteMissingShapes(links, reading.notes);
  const auto has_shape = [](const PlacedLink& link) { return HasShape(*link.link); };
  if (std::none_of(links.links.begin(), links.links.end(), has_shape)) {
    if (!is_still || AnyLinkHas(links, kVisual))
      note("without any <collision> left out: stops no drive, and nothing stands on it");
    return played;
  }
  played.shapes = ShapesOf(links, X_MB, reading);
  if (is_still) return played;
  const Obstacle obstacle = WhyStill(links, hold, false);
  if (!obstacle.kind.empty()) {
    const std::string where = obstacle.where.empty() ? PlaceOf(model.Element()) : obstacle.where;
    reading.notes->Add("model", obstacle.kind + ": " + obstacle.made,
                       fmt::format("{} '{}'", where, model.Name()));
    return played;
  }
  try {
    played.object = ObjectOf(model, links, played.shapes.collisions, reading.notes);
    for (const std::string& doubt : DoubtsOfMass(*played.object)) note(doubt);
  } catch (const base::ConfigError& error) {
    reading.notes->AddProblem(error.what());
  }
  return played;
}

ObjectModel LooseObjectOf(const sdf::Model& model, const ModelReading& reading) {
  const std::string where = Where(model);
  const ModelLinks links = LinksOf(model);
  const auto has_shape = [](const PlacedLink& link) { return HasShape(*link.link); };
  if (std::none_of(links.links.begin(), links.links.end(), has_shape)) {
    throw base::ConfigError(
        where + ": can move but has no <collision>, so it would fall through the floor; add one");
  }
  const Obstacle obstacle = WhyStill(links, Hold::kNone, true);
  if (!obstacle.kind.empty()) {
    throw base::ConfigError(
        fmt::format("{}: is no object, as it is a model {}; an object is one body with mass, "
                    "inertia and shapes",
                    where, obstacle.kind));
  }
  ObjectModel object =
      ObjectOf(model, links, ShapesOf(links, {}, reading).collisions, reading.notes);
  reading.notes->ThrowIfProblems(where);
  return object;
}

}  // namespace hires::world
