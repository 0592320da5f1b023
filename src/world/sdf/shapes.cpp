#include "world/sdf/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <locale>
#include <memory>
#include <sdf/Element.hh>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "world/sdf/polygon_cut.h"
#include "world/sdf/prune_sdf.h"
#include "world/sdf_model.h"

namespace hires::world {
namespace {

using geometry::TriangleMesh;
using MeshPtr = std::shared_ptr<const TriangleMesh>;

constexpr int kAround = 24;   // corners, as outlines have round a cylinder
constexpr int kUpright = 12;  // layers of an ellipsoid
constexpr std::size_t kMostPoints = 2000;

std::vector<sdf::ElementPtr> ShapeElements(const sdf::Collision& collision) {
  std::vector<sdf::ElementPtr> elements;
  const sdf::ElementPtr geometry = collision.Element()->GetElement("geometry");
  for (auto child = geometry->GetFirstElement(); child != nullptr;
       child = child->GetNextElement()) {
    if (child->GetName().rfind(kShapePrefix, 0) == 0) elements.push_back(child);
  }
  return elements;
}

std::string KindOf(const sdf::ElementPtr& shape) {
  return shape->GetName().substr(std::string(kShapePrefix).size());
}

/// @throws base::ConfigError if the text is not `count` finite numbers.
std::vector<double> Numbers(const sdf::ElementPtr& shape, const std::string& name,
                            std::size_t count, const std::string& text, const std::string& where) {
  std::vector<double> numbers;
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  for (double value = 0.0; in >> value;) numbers.push_back(value);
  bool is_right = in.eof() && numbers.size() == count;
  for (const double value : numbers) is_right = is_right && std::isfinite(value);
  if (is_right) return numbers;
  throw base::ConfigError(fmt::format("{}: <{}> of its <{}> is '{}', wanted {} finite number{} [m]",
                                      where, name, KindOf(shape), text, count,
                                      count == 1 ? "" : "s"));
}

std::vector<double> NumbersAt(const sdf::ElementPtr& shape, const std::string& name,
                              std::size_t count, const std::string& where) {
  const std::string text =
      shape->HasElement(name) ? shape->GetElement(name)->Get<std::string>() : "";
  return Numbers(shape, name, count, text, where);
}

std::vector<double> SizesAt(const sdf::ElementPtr& shape, const std::string& name,
                            std::size_t count, const std::string& where) {
  std::vector<double> sizes = NumbersAt(shape, name, count, where);
  for (const double size : sizes) {
    if (size > 0.0 && size <= kMaxSize) continue;
    throw base::ConfigError(
        fmt::format("{}: <{}> of its <{}> is {} m, wanted above 0 and at most {} m", where, name,
                    KindOf(shape), size, kMaxSize));
  }
  return sizes;
}

geometry::Pose3 At(double z) { return {{0.0, 0.0, z}, Eigen::Quaterniond::Identity()}; }

Eigen::Vector3d OnCircle(double radius_x, double radius_y, double z, int i) {
  const double angle = 2.0 * geometry::kPi * i / kAround;
  return {radius_x * std::cos(angle), radius_y * std::sin(angle), z};
}

std::vector<ShapePart> Capsule(const sdf::ElementPtr& shape, const std::string& where) {
  const double radius = SizesAt(shape, "radius", 1, where)[0];
  const double length = SizesAt(shape, "length", 1, where)[0];
  return {{"", geometry::Cylinder{radius, length}, {}},
          {"_top", geometry::Sphere{radius}, At(length / 2.0)},
          {"_bottom", geometry::Sphere{radius}, At(-length / 2.0)}};
}

/// Apex up, its middle half-way up.
std::vector<ShapePart> Cone(const sdf::ElementPtr& shape, const std::string& where) {
  const double radius = SizesAt(shape, "radius", 1, where)[0] / std::cos(geometry::kPi / kAround);
  const double half = SizesAt(shape, "length", 1, where)[0] / 2.0;
  TriangleMesh mesh;
  for (int i = 0; i < kAround; ++i) mesh.vertices.push_back(OnCircle(radius, radius, -half, i));
  mesh.vertices.emplace_back(0.0, 0.0, half);
  for (int i = 0; i < kAround; ++i) mesh.triangles.push_back({i, (i + 1) % kAround, kAround});
  for (int i = 1; i + 1 < kAround; ++i) mesh.triangles.push_back({0, i + 1, i});
  return {{"", std::make_shared<const TriangleMesh>(std::move(mesh)), {}}};
}

/// Layers of corners between two poles; wide enough to hold the round form at its waist.
std::vector<ShapePart> Ellipsoid(const sdf::ElementPtr& shape, const std::string& where) {
  const std::vector<double> radii = SizesAt(shape, "radii", 3, where);
  if (radii[0] == radii[1] && radii[1] == radii[2]) return {{"", geometry::Sphere{radii[0]}, {}}};
  const double wider = 1.0 / std::cos(geometry::kPi / kAround);
  TriangleMesh mesh;
  for (int layer = 1; layer < kUpright; ++layer) {
    const double angle = geometry::kPi * layer / kUpright;
    for (int i = 0; i < kAround; ++i) {
      mesh.vertices.push_back(OnCircle(wider * radii[0] * std::sin(angle),
                                       wider * radii[1] * std::sin(angle),
                                       -radii[2] * std::cos(angle), i));
    }
  }
  const int bottom = static_cast<int>(mesh.vertices.size()), top = bottom + 1;
  mesh.vertices.emplace_back(0.0, 0.0, -radii[2]);
  mesh.vertices.emplace_back(0.0, 0.0, radii[2]);
  for (int i = 0; i < kAround; ++i) {
    const int next = (i + 1) % kAround;
    mesh.triangles.push_back({next, i, bottom});
    for (int layer = 0; layer + 2 < kUpright; ++layer) {
      const int low = layer * kAround, high = low + kAround;
      mesh.triangles.push_back({low + i, low + next, high + next});
      mesh.triangles.push_back({low + i, high + next, high + i});
    }
    const int last = (kUpright - 2) * kAround;
    mesh.triangles.push_back({last + i, last + next, top});
  }
  return {{"", std::make_shared<const TriangleMesh>(std::move(mesh)), {}}};
}

/// From z = 0 up.
MeshPtr Prism(const std::array<Eigen::Vector2d, 3>& base, double height) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (const double z : {0.0, height}) {
    for (const Eigen::Vector2d& p : base) mesh->vertices.emplace_back(p.x(), p.y(), z);
  }
  mesh->triangles = {{2, 1, 0}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                     {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

std::vector<ShapePart> Polyline(const std::vector<sdf::ElementPtr>& shapes,
                                const std::string& where) {
  std::vector<std::vector<Eigen::Vector2d>> lines;
  std::size_t num_points = 0;
  for (const sdf::ElementPtr& shape : shapes) {
    lines.emplace_back();
    for (auto child = shape->GetFirstElement(); child != nullptr; child = child->GetNextElement()) {
      if (child->GetName() != "point") continue;
      const std::vector<double> p = Numbers(shape, "point", 2, child->Get<std::string>(), where);
      lines.back().emplace_back(p[0], p[1]);
    }
    num_points += lines.back().size();
  }
  const double height = SizesAt(shapes.front(), "height", 1, where)[0];
  const auto triangles = num_points > kMostPoints ? std::vector<std::array<Eigen::Vector2d, 3>>{}
                                                  : CutIntoTriangles(std::move(lines));
  if (triangles.empty()) {
    throw base::ConfigError(fmt::format(
        "{}: its <polyline> has {} points, wanted 3 to {} round an area, with lines that cross "
        "nowhere",
        where, num_points, kMostPoints));
  }
  std::vector<ShapePart> parts;
  for (const auto& triangle : triangles) {
    const std::string suffix = parts.empty() ? "" : fmt::format("_{}", parts.size() + 1);
    parts.push_back({suffix, Prism(triangle, height), {}});
  }
  return parts;
}

}  // namespace

std::string OtherShapeOf(const sdf::Collision& collision) {
  const std::vector<sdf::ElementPtr> shapes = ShapeElements(collision);
  return shapes.empty() ? "" : KindOf(shapes.front());
}

std::vector<ShapePart> ShapePartsOf(const sdf::Collision& collision, const std::string& where) {
  const std::vector<sdf::ElementPtr> shapes = ShapeElements(collision);
  const std::string kind = KindOf(shapes.front());
  if (kind == "capsule") return Capsule(shapes.front(), where);
  if (kind == "cone") return Cone(shapes.front(), where);
  if (kind == "ellipsoid") return Ellipsoid(shapes.front(), where);
  if (kind == "polyline") return Polyline(shapes, where);
  if (kind == "heightmap" || kind == "image") {
    throw base::ConfigError(fmt::format(
        "{}: its shape is a <{}>, and drives are imagined on one level: where it is flat use a "
        "plane or a box, else export it as a mesh (.stl, .dae, .obj, .glb); or take it out",
        where, kind));
  }
  throw base::ConfigError(fmt::format(
      "{}: its shape <{}> is not supported; use box, cylinder, sphere, capsule, ellipsoid, cone, "
      "polyline, mesh, or a plane for the floor",
      where, kind));
}

}  // namespace hires::world
