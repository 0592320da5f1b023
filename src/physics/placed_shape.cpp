#include "physics/placed_shape.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "physics/box_contacts.h"
#include "physics/ode_session.h"

namespace hires::physics {
namespace {

using Eigen::Vector3d;

constexpr int kOdeContacts = 512;  // a mesh on the floor gives one for each vertex below

[[noreturn]] void Refuse(const std::string& name, const std::string& what) {
  throw base::ConfigError(fmt::format("collision '{}': {}", name, what));
}

void RequireSize(const std::string& name, const char* what, double size) {
  if (std::isfinite(size) && size > 0.0) return;
  Refuse(name, fmt::format("{} is {} m, wanted a positive, finite length", what, size));
}

void RequireSurface(const geometry::Collision& collision) {
  if (!(std::isfinite(collision.friction) && collision.friction >= 0.0)) {
    Refuse(collision.name, fmt::format("friction coefficient is {}, wanted a finite number >= 0",
                                       collision.friction));
  }
  if (!(collision.restitution >= 0.0 && collision.restitution <= 1.0)) {
    Refuse(collision.name, fmt::format("restitution is {}, wanted 0 to 1", collision.restitution));
  }
  if (!collision.X_BS.IsFinite()) Refuse(collision.name, "its pose is not finite");
}

void RequireMesh(const std::string& name, const geometry::TriangleMesh* mesh) {
  if (mesh == nullptr || mesh->triangles.empty()) {
    Refuse(name, "the mesh has no triangles; load it again or use a box or cylinder");
  }
  const int num_vertices = static_cast<int>(mesh->vertices.size());
  for (const auto& triangle : mesh->triangles) {
    for (const int index : triangle) {
      if (index >= 0 && index < num_vertices) continue;
      Refuse(name, fmt::format("a triangle names vertex {}, the mesh has vertices 0 to {}", index,
                               num_vertices - 1));
    }
  }
  for (const Vector3d& vertex : mesh->vertices) {
    if (!vertex.allFinite()) Refuse(name, "the mesh has a vertex that is not finite");
  }
}

void SetGeomPose(dGeomID geom, const Vector3d& p, const Eigen::Matrix3d& R) {
  dMatrix3 rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation[4 * row + column] = R(row, column);
    rotation[4 * row + 3] = 0.0;
  }
  dGeomSetPosition(geom, p.x(), p.y(), p.z());
  dGeomSetRotation(geom, rotation);
  if (dGeomGetClass(geom) == dTriMeshClass) {
    // ODE would take the last pose it knows for a motion, and contacts for its history.
    dMatrix4 pose;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) pose[4 * row + column] = R(row, column);
      pose[4 * row + 3] = 0.0;
    }
    for (int i = 0; i < 3; ++i) pose[12 + i] = p[i];
    pose[15] = 1.0;
    dGeomTriMeshSetLastTransform(geom, pose);
  }
}

/// Debian's ODE keeps one scratch memory for the meshes of the whole process (its configuration
/// lacks ODE_EXT_mt_collisions), so whatever touches a mesh waits for its turn.
std::unique_lock<std::mutex> LockMeshes(bool has_mesh) {
  static std::mutex mutex;
  return has_mesh ? std::unique_lock<std::mutex>(mutex) : std::unique_lock<std::mutex>();
}

bool IsMesh(const PlacedShape& shape) { return shape.kind() == PlacedShape::Kind::kMesh; }

/// Of two meshes ODE also reports pairs of triangles that merely lie side by side, with depths as
/// large as the triangles. True contacts of one step are about equally deep.
constexpr double kMeshDepthSpread = 0.005;  // [m]

double DeepestBelievable(const PlacedShape& a, const PlacedShape& b, const dContactGeom* found,
                         int count) {
  double least = HUGE_VAL;
  if (!IsMesh(a) || !IsMesh(b)) return least;
  for (int i = 0; i < count; ++i) least = std::min(least, found[i].depth);
  return least + kMeshDepthSpread;
}

void AskOde(PlacedShape& a, PlacedShape& b, ContactList* contacts) {
  const auto lock = LockMeshes(IsMesh(a) || IsMesh(b));
  thread_local std::array<dContactGeom, kOdeContacts> found;
  const int count = dCollide(a.geom(), b.geom(), kOdeContacts, found.data(), sizeof(dContactGeom));
  const double deepest = DeepestBelievable(a, b, found.data(), count);
  for (int i = 0; i < count; ++i) {
    const dContactGeom& at = found[i];
    const Vector3d normal(at.normal[0], at.normal[1], at.normal[2]);
    const double length = normal.norm();
    // Degenerate triangles give normals of no length.
    if (!(length > 0.5) || !(at.depth >= 0.0) || at.depth > deepest) continue;
    contacts->Add({at.pos[0], at.pos[1], at.pos[2]}, normal / length, at.depth);
  }
}

/// True if nothing is left to ask.
bool TryOwn(PlacedShape& a, PlacedShape& b, const Vector3d& lean, ContactList* contacts) {
  using Kind = PlacedShape::Kind;
  if (a.kind() == Kind::kBox && b.kind() == Kind::kBox) {
    AddBoxOnBox(a.box(), b.box(), contacts);
    return true;
  }
  if (a.is_polytope() && b.is_polytope()) {
    AddPolytopeOnPolytope(a.polytope(), b.polytope(), contacts);
    return true;
  }
  if (a.kind() != Kind::kCylinder) return false;
  switch (b.kind()) {
    case Kind::kFloor:
      AddCylinderOnFace(a.cylinder(), FloorFace(), lean, contacts);
      return true;
    case Kind::kBox:
      return AddCylinderOnBox(a.cylinder(), b.box(), lean, contacts) != QuickLook::kUndecided;
    case Kind::kCylinder:
      return AddCylinderOnCylinder(a.cylinder(), b.cylinder(), lean, contacts) !=
             QuickLook::kUndecided;
    case Kind::kMesh:
      return b.is_polytope() && AddCylinderOnPolytope(a.cylinder(), b.polytope(), lean, contacts) !=
                                    QuickLook::kUndecided;
    default:
      return false;
  }
}

}  // namespace

void PlacedShape::Release::operator()(dxGeom* geom) const { dGeomDestroy(geom); }
void PlacedShape::Release::operator()(dxTriMeshData* data) const { dGeomTriMeshDataDestroy(data); }

PlacedShape PlacedShape::Floor(double friction) {
  geometry::Collision collision;  // for its checks
  collision.name = "floor";
  collision.friction = friction;
  RequireSurface(collision);
  EnsureOdeIsReady();
  PlacedShape floor;
  floor.friction_ = friction;
  floor.geom_.reset(dCreatePlane(nullptr, 0.0, 0.0, 1.0, 0.0));
  return floor;
}

void RequireShape(const geometry::Collision& collision) {
  const std::string& name = collision.name;
  RequireSurface(collision);
  if (const auto* box = std::get_if<geometry::Box>(&collision.shape)) {
    RequireSize(name, "box size x", box->size.x());
    RequireSize(name, "box size y", box->size.y());
    RequireSize(name, "box size z", box->size.z());
  } else if (const auto* cylinder = std::get_if<geometry::Cylinder>(&collision.shape)) {
    RequireSize(name, "cylinder radius", cylinder->radius);
    RequireSize(name, "cylinder length", cylinder->length);
  } else if (const auto* sphere = std::get_if<geometry::Sphere>(&collision.shape)) {
    RequireSize(name, "sphere radius", sphere->radius);
  } else {
    RequireMesh(name,
                std::get<std::shared_ptr<const geometry::TriangleMesh>>(collision.shape).get());
  }
}

PlacedShape::PlacedShape(const geometry::Collision& collision)
    : friction_(collision.friction), restitution_(collision.restitution) {
  RequireShape(collision);
  EnsureOdeIsReady();
  if (const auto* box = std::get_if<geometry::Box>(&collision.shape)) {
    MakeBox(*box);
  } else if (const auto* cylinder = std::get_if<geometry::Cylinder>(&collision.shape)) {
    MakeCylinder(*cylinder);
  } else if (const auto* sphere = std::get_if<geometry::Sphere>(&collision.shape)) {
    MakeSphere(*sphere);
  } else {
    MakeMesh(*std::get<std::shared_ptr<const geometry::TriangleMesh>>(collision.shape));
  }
}

void PlacedShape::MakeBox(const geometry::Box& box) {
  kind_ = Kind::kBox;
  size_ = box.size / 2;
  reach_ = size_.norm();
  inside_ = size_.minCoeff();
  geom_.reset(dCreateBox(nullptr, box.size.x(), box.size.y(), box.size.z()));
}

void PlacedShape::MakeCylinder(const geometry::Cylinder& cylinder) {
  kind_ = Kind::kCylinder;
  size_ = {cylinder.radius, 0.0, cylinder.length / 2};
  reach_ = std::hypot(cylinder.radius, cylinder.length / 2);
  inside_ = std::min(cylinder.radius, cylinder.length / 2);
  geom_.reset(dCreateCylinder(nullptr, cylinder.radius, cylinder.length));
}

void PlacedShape::MakeSphere(const geometry::Sphere& sphere) {
  kind_ = Kind::kSphere;
  size_.x() = reach_ = inside_ = sphere.radius;
  geom_.reset(dCreateSphere(nullptr, sphere.radius));
}

void PlacedShape::MakeMesh(const geometry::TriangleMesh& mesh) {
  kind_ = Kind::kMesh;
  geometry::Aabb bounds;
  for (const Vector3d& vertex : mesh.vertices) {
    vertices_.insert(vertices_.end(), vertex.data(), vertex.data() + 3);
    reach_ = std::max(reach_, vertex.norm());
    bounds.Include(vertex);
  }
  for (const auto& triangle : mesh.triangles) {
    indices_.insert(indices_.end(), triangle.begin(), triangle.end());
  }
  polytope_ = PolytopeOf(mesh);
  const auto lock = LockMeshes(true);
  inside_ = (bounds.upper - bounds.lower).minCoeff() / 4;  // a guess: it may be hollow
  mesh_data_.reset(dGeomTriMeshDataCreate());
  dGeomTriMeshDataBuildDouble(mesh_data_.get(), vertices_.data(), 3 * sizeof(double),
                              static_cast<int>(mesh.vertices.size()), indices_.data(),
                              static_cast<int>(indices_.size()), 3 * sizeof(unsigned));
  geom_.reset(dCreateTriMesh(nullptr, mesh_data_.get(), nullptr, nullptr, nullptr));
}

void PlacedShape::Place(const Vector3d& p_WS, const Eigen::Matrix3d& R_WS) {
  p_WS_ = p_WS;
  R_WS_ = R_WS;
  is_geom_in_place_ = false;
}

PlacedCylinder PlacedShape::cylinder() const { return {p_WS_, R_WS_.col(2), size_.x(), size_.z()}; }

PlacedBox PlacedShape::box() const { return {p_WS_, R_WS_, size_}; }

PlacedPolytope PlacedShape::polytope() {
  if (!polytope_) {
    polytope_ = std::make_unique<const Polytope>(PolytopeOf(geometry::Box{2.0 * size_}));
  }
  return {polytope_.get(), p_WS_, R_WS_};
}

dxGeom* PlacedShape::geom() {
  if (kind_ != Kind::kFloor && !is_geom_in_place_) SetGeomPose(geom_.get(), p_WS_, R_WS_);
  is_geom_in_place_ = true;
  return geom_.get();
}

void FindContacts(PlacedShape& a, PlacedShape& b, const Vector3d& lean, ContactList* contacts) {
  contacts->Clear();
  const bool is_cylinder_second =
      b.kind() == PlacedShape::Kind::kCylinder && a.kind() != PlacedShape::Kind::kCylinder;
  const bool is_done =
      is_cylinder_second ? TryOwn(b, a, -lean, contacts) : TryOwn(a, b, lean, contacts);
  if (is_cylinder_second) contacts->FlipNormals();
  if (!is_done) {
    contacts->Clear();
    AskOde(a, b, contacts);
  }
  contacts->Reduce();
}

RayHit CastRay(const Vector3d& start, const Vector3d& direction, double length,
               PlacedShape& shape) {
  HIRES_CHECK(length > 0.0, "a ray has a positive length");
  const auto lock = LockMeshes(IsMesh(shape));
  const std::unique_ptr<dxGeom, void (*)(dGeomID)> ray(dCreateRay(nullptr, length), dGeomDestroy);
  dGeomRaySet(ray.get(), start.x(), start.y(), start.z(), direction.x(), direction.y(),
              direction.z());
  dGeomRaySetClosestHit(ray.get(), 1);
  dContactGeom at;
  if (dCollide(ray.get(), shape.geom(), 1, &at, sizeof(at)) == 0) return {};
  Vector3d normal(at.normal[0], at.normal[1], at.normal[2]);
  if (normal.dot(direction) > 0.0) normal = -normal;
  return {true, at.depth, normal};
}

}  // namespace hires::physics
