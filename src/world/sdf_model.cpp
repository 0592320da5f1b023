#include "world/sdf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sdf/Box.hh>
#include <sdf/Collision.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Geometry.hh>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Mesh.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>
#include <set>

#include "geometry/mesh_units.h"
#include "hires/base/error.h"
#include "hires/geometry/mesh_reader.h"
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

struct Context {
  const ResourceFinder& finder;
  MeshCache* meshes;
};

std::string WhereIs(const sdf::Collision& collision) {
  return fmt::format("{}: collision '{}'", PlaceOf(collision.Element()), collision.Name());
}

geometry::Shape MeshOf(const sdf::Mesh& mesh, const Context& context, const std::string& where) {
  if (!mesh.Submesh().empty()) {
    throw base::ConfigError(
        fmt::format("{}: <submesh> '{}' cannot be picked; export it as a mesh file of its own",
                    where, mesh.Submesh()));
  }
  const std::string path = context.finder.FindMesh(mesh.Uri(), mesh.FilePath(), where);
  return context.meshes->Read(path, ToEigen(mesh.Scale()), where);
}

geometry::Shape ShapeOf(const sdf::Collision& collision, const Context& context) {
  const sdf::Geometry& geom = *collision.Geom();
  switch (geom.Type()) {
    case sdf::GeometryType::BOX:
      return geometry::Box{ToEigen(geom.BoxShape()->Size())};
    case sdf::GeometryType::CYLINDER:
      return geometry::Cylinder{geom.CylinderShape()->Radius(), geom.CylinderShape()->Length()};
    case sdf::GeometryType::SPHERE:
      return geometry::Sphere{geom.SphereShape()->Radius()};
    case sdf::GeometryType::MESH:
      return MeshOf(*geom.MeshShape(), context, WhereIs(collision));
    case sdf::GeometryType::PLANE:
      throw base::ConfigError(WhereIs(collision) +
                              ": a plane cannot move; use a box, or make the model <static>");
    default:
      throw base::ConfigError(WhereIs(collision) +
                              ": its shape is not supported; use box, cylinder, sphere, mesh, or a "
                              "plane for the floor");
  }
}

geometry::Collision CollisionOf(const sdf::Collision& collision, const geometry::Pose3& X_BL,
                                const std::string& prefix, const Context& context) {
  const std::string where = WhereIs(collision);
  geometry::Collision result;
  result.name = prefix + collision.Name();
  result.shape = ShapeOf(collision, context);
  result.X_BS = X_BL * PoseIn(collision.SemanticPose(), "", where);
  result.friction =
      NumberAt(collision.Element(), {"surface", "friction", "ode", "mu"}, result.friction);
  result.restitution =
      NumberAt(collision.Element(), {"surface", "bounce", "restitution_coefficient"}, 0.0);
  CheckCollision(result, where);
  return result;
}

int CountLinks(const sdf::Model& model) {
  int count = static_cast<int>(model.LinkCount());
  for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
    count += CountLinks(*model.ModelByIndex(i));
  }
  return count;
}

/// Collects the shapes of all links of a model and of the models in it.
class StaticCollector {
 public:
  StaticCollector(const geometry::Pose3& X_MB, bool has_one_link, const Context& context)
      : X_MB_(X_MB), has_one_link_(has_one_link), context_(context) {}

  void Visit(const sdf::Model& model, const geometry::Pose3& X_BModel, const std::string& prefix) {
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const geometry::Pose3 X_BL =
          X_BModel * PoseIn(link.SemanticPose(), "__model__", PlaceOf(link.Element()));
      VisitLink(link, X_BL, has_one_link_ ? "" : prefix + link.Name() + "::");
    }
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& inner = *model.ModelByIndex(i);
      Visit(inner, X_BModel * PoseIn(inner.SemanticPose(), "__model__", Where(inner)),
            prefix + inner.Name() + "::");
    }
  }

  StaticShapes result;

 private:
  void VisitLink(const sdf::Link& link, const geometry::Pose3& X_BL, const std::string& prefix) {
    for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
      const sdf::Collision& collision = *link.CollisionByIndex(i);
      if (collision.Geom()->Type() == sdf::GeometryType::PLANE) {
        VisitPlane(collision, X_BL);
      } else {
        result.collisions.push_back(CollisionOf(collision, X_BL, prefix, context_));
        result.places[result.collisions.back().name] = PlaceOf(collision.Element());
      }
    }
  }

  void VisitPlane(const sdf::Collision& collision, const geometry::Pose3& X_BL) {
    const std::string where = WhereIs(collision);
    const geometry::Pose3 X_MS = X_MB_ * X_BL * PoseIn(collision.SemanticPose(), "", where);
    const Eigen::Vector3d normal =
        X_MS.rotation * ToEigen(collision.Geom()->PlaneShape()->Normal());
    const bool is_level = (normal - Eigen::Vector3d::UnitZ()).norm() <= kFloorTolerance;
    if (!is_level || std::abs(X_MS.translation.z()) > kFloorTolerance) {
      throw base::ConfigError(where +
                              ": the only plane supported is the floor, z = 0 facing up; use a "
                              "static box instead");
    }
    if (result.floor_friction) {
      throw base::ConfigError(where + ": is a second floor; keep one plane");
    }
    geometry::Collision floor;
    floor.friction =
        NumberAt(collision.Element(), {"surface", "friction", "ode", "mu"}, floor.friction);
    CheckCollision(floor, where);
    result.floor_friction = floor.friction;
  }

  geometry::Pose3 X_MB_;
  bool has_one_link_;
  Context context_;
};

/// @throws base::ConfigError if a number that would have a silent default is missing.
void RequireInertial(const sdf::Link& link, const std::string& where) {
  const sdf::ElementPtr element = link.Element();
  const auto require = [&](const sdf::ElementPtr& parent, const char* name) {
    if (parent->HasElement(name)) {
      const sdf::ElementPtr child = parent->GetElement(name);
      if (child->GetExplicitlySetInFile()) return child;  // else libsdformat filled it in
    }
    throw base::ConfigError(
        fmt::format("{}: link '{}' has no <{}>; an object that can move needs mass and inertia, or "
                    "make the model <static>",
                    where, link.Name(), name));
  };
  const sdf::ElementPtr inertial = require(element, "inertial");
  require(inertial, "mass");
  const sdf::ElementPtr inertia = require(inertial, "inertia");
  for (const char* moment : {"ixx", "iyy", "izz"}) require(inertia, moment);
}

geometry::MassProperties MassPropertiesOf(const sdf::Link& link, const geometry::Pose3& X_BL,
                                          const std::string& where) {
  RequireInertial(link, where);
  const ignition::math::Inertiald& inertial = link.Inertial();
  const geometry::Pose3 X_BI = X_BL * ToPose(inertial.Pose());
  const auto diagonal = inertial.MassMatrix().DiagonalMoments();
  const auto products = inertial.MassMatrix().OffDiagonalMoments();
  Eigen::Matrix3d I_I;
  I_I << diagonal.X(), products.X(), products.Y(),  //
      products.X(), diagonal.Y(), products.Z(),     //
      products.Y(), products.Z(), diagonal.Z();
  const Eigen::Matrix3d R_BI = X_BI.rotation.toRotationMatrix();
  const geometry::MassProperties result{inertial.MassMatrix().Mass(), X_BI.translation,
                                        R_BI * I_I * R_BI.transpose()};
  const std::string wrong = geometry::WhyUnphysical(result);
  if (!wrong.empty()) {
    throw base::ConfigError(
        fmt::format("{}: link '{}': {}; correct its <inertial>", where, link.Name(), wrong));
  }
  CheckPose(X_BI, where + ": centre of mass");
  return result;
}

void CheckIsSingleLink(const sdf::Model& model) {
  if (model.LinkCount() == 1 && model.ModelCount() == 0 && model.JointCount() == 0) return;
  throw base::ConfigError(fmt::format(
      "{}: can move and has {} links, {} joints, {} nested models; an object is one link without "
      "joints: merge its links, or make the model <static>",
      Where(model), model.LinkCount(), model.JointCount(), model.ModelCount()));
}

}  // namespace

std::shared_ptr<const geometry::TriangleMesh> MeshCache::Read(const std::string& path,
                                                              const Eigen::Vector3d& scale,
                                                              const std::string& where) {
  const std::string key = fmt::format("{} {} {} {}", scale.x(), scale.y(), scale.z(), path);
  auto& mesh = meshes_[key];
  if (mesh == nullptr) {
    try {
      mesh = std::make_shared<const geometry::TriangleMesh>(geometry::ReadMesh(path, scale));
    } catch (const base::ConfigError& error) {
      throw base::ConfigError(fmt::format("{}: {}", where, error.what()));
    }
    const std::string doubt = geometry::DoubtedUnit(path, *mesh, scale, {}, "<scale>{}</scale>");
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

void CheckPose(const geometry::Pose3& pose, const std::string& where) {
  if (!pose.IsFinite()) {
    throw base::ConfigError(where + ": its pose is not finite; write six finite numbers");
  }
  const Eigen::Vector3d& p = pose.translation;
  if (p.norm() > kMaxDistance) {
    throw base::ConfigError(fmt::format(
        "{}: lies at ({:g}, {:g}, {:g}) m, farther than {:g} m from the origin; move the origin "
        "closer",
        where, p.x(), p.y(), p.z(), kMaxDistance));
  }
}

void CheckCollision(const geometry::Collision& collision, const std::string& where) {
  std::vector<double> sizes;
  if (const auto* box = std::get_if<geometry::Box>(&collision.shape)) {
    sizes = {box->size.x(), box->size.y(), box->size.z()};
  } else if (const auto* cylinder = std::get_if<geometry::Cylinder>(&collision.shape)) {
    sizes = {cylinder->radius, cylinder->length};
  } else if (const auto* sphere = std::get_if<geometry::Sphere>(&collision.shape)) {
    sizes = {sphere->radius};
  }
  for (const double size : sizes) {
    if (size > 0.0 && size <= 2.0 * kMaxDistance) continue;
    throw base::ConfigError(fmt::format("{}: has a size of {} m, wanted above 0 and at most {} m",
                                        where, size, 2.0 * kMaxDistance));
  }
  CheckPose(collision.X_BS, where);
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
                       const std::string& where) {
  ignition::math::Pose3d resolved;
  ThrowIfAny(pose.Resolve(resolved, in), where);
  const geometry::Pose3 result = ToPose(resolved);
  CheckPose(result, where);
  return result;
}

std::string Where(const sdf::Model& model) {
  return fmt::format("{}: model '{}'", PlaceOf(model.Element()), model.Name());
}

bool IsStatic(const sdf::Model& model) {
  if (model.Static()) return true;
  if (model.LinkCount() != 1 || model.ModelCount() != 0 || model.JointCount() != 1) return false;
  const sdf::Joint& joint = *model.JointByIndex(0);
  const bool is_to_world = joint.ParentLinkName() == "world" || joint.ChildLinkName() == "world";
  return joint.Type() == sdf::JointType::FIXED && is_to_world;
}

StaticShapes StaticShapesOf(const sdf::Model& model, const geometry::Pose3& X_MB,
                            const ResourceFinder& finder, MeshCache* meshes) {
  StaticCollector collector(X_MB, CountLinks(model) == 1, Context{finder, meshes});
  collector.Visit(model, {}, "");
  return collector.result;
}

ObjectModel LooseObjectOf(const sdf::Model& model, const ResourceFinder& finder,
                          MeshCache* meshes) {
  CheckIsSingleLink(model);
  const std::string where = Where(model);
  const sdf::Link& link = *model.LinkByIndex(0);
  const geometry::Pose3 X_BL = PoseIn(link.SemanticPose(), "__model__", where);
  ObjectModel object{model.Name(), MassPropertiesOf(link, X_BL, where), {}};
  for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
    object.collisions.push_back(
        CollisionOf(*link.CollisionByIndex(i), X_BL, "", Context{finder, meshes}));
  }
  if (object.collisions.empty()) {
    throw base::ConfigError(
        where + ": can move but has no <collision>, so it would fall through the floor; add one");
  }
  std::sort(object.collisions.begin(), object.collisions.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return object;
}

}  // namespace hires::world
