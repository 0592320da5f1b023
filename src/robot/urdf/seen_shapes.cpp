#include "robot/urdf/seen_shapes.h"

#include <tinyxml2.h>

#include <algorithm>
#include <memory>
#include <system_error>

#include "base/files/plain_xml.h"
#include "hires/base/error.h"
#include "hires/geometry/mesh_reader.h"
#include "robot/mesh_path.h"
#include "robot/urdf/xml_numbers.h"

namespace hires::robot {
namespace {

using tinyxml2::XMLElement;

/// The element in a <visual> or <collision> that is its shape, or null.
const XMLElement* ShapeElementOf(const XMLElement& owner) {
  const XMLElement* geometry = owner.FirstChildElement("geometry");
  return geometry == nullptr ? nullptr : geometry->FirstChildElement();
}

/// Above 0, or nothing.
std::optional<double> LengthIn(const XMLElement& shape, const char* attribute) {
  const auto length = NumberIn(&shape, attribute);
  return length && *length > 0.0 ? length : std::nullopt;
}

SeenShape SeenMeshOf(const XMLElement& mesh, const geometry::Pose3& X_LS) {
  SeenShape seen{X_LS, std::nullopt};
  if (const char* uri = mesh.Attribute("filename")) seen.mesh = uri;
  if (const auto scale = NumbersIn(mesh.Attribute("scale"), 3))
    seen.scale = {(*scale)[0], (*scale)[1], (*scale)[2]};
  return seen;
}

std::optional<SeenShape> SeenShapeOf(const XMLElement& visual) {
  const XMLElement* element = ShapeElementOf(visual);
  const auto X_LS = OriginOf(visual);
  if (element == nullptr || !X_LS || !X_LS->IsFinite()) return std::nullopt;
  const std::string kind = element->Name();
  if (kind == "mesh") return SeenMeshOf(*element, *X_LS);
  if (kind == "box") {
    const auto size = NumbersIn(element->Attribute("size"), 3);
    if (!size || !(*std::min_element(size->begin(), size->end()) > 0.0)) return std::nullopt;
    return SeenShape{*X_LS, geometry::Box{{(*size)[0], (*size)[1], (*size)[2]}}};
  }
  const auto radius = LengthIn(*element, "radius"), length = LengthIn(*element, "length");
  if (kind == "sphere" && radius) return SeenShape{*X_LS, geometry::Sphere{*radius}};
  if ((kind == "cylinder" || kind == "capsule") && radius && length)
    return SeenShape{*X_LS, geometry::Cylinder{*radius, *length}};
  return std::nullopt;
}

}  // namespace

std::map<std::string, std::vector<SeenShape>> ShapesSeen(const std::string& urdf_xml) {
  std::map<std::string, std::vector<SeenShape>> seen;
  const std::string xml = base::PlainXml(urdf_xml, "URDF");  // was read before
  tinyxml2::XMLDocument document;
  document.Parse(xml.data(), xml.size());
  const XMLElement* robot = document.FirstChildElement("robot");
  if (document.Error() || robot == nullptr) return seen;
  for (const auto* link = robot->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    const char* name = link->Attribute("name");
    if (name == nullptr) continue;
    for (const auto* visual = link->FirstChildElement("visual"); visual != nullptr;
         visual = visual->NextSiblingElement("visual")) {
      if (const auto shape = SeenShapeOf(*visual)) seen[name].push_back(*shape);
    }
  }
  return seen;
}

std::optional<geometry::Shape> LookMeshes::Read(const SeenShape& seen) {
  const auto [known, is_new] =
      known_.try_emplace({seen.mesh, {seen.scale.x(), seen.scale.y(), seen.scale.z()}});
  if (!is_new || num_failed_ >= kMostFailed) return known->second;
  try {
    known->second = ReadFile(seen);
  } catch (const base::ConfigError& /*error*/) {
    ++num_failed_;
  }
  return known->second;
}

std::optional<geometry::Shape> LookMeshes::ReadFile(const SeenShape& seen) {
  const std::string path = ResolveMesh(seen.mesh, folder_, packages_);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kMostBytes - num_bytes_) return std::nullopt;
  num_bytes_ += size;
  return std::make_shared<geometry::TriangleMesh>(geometry::ReadMesh(path, seen.scale));
}

}  // namespace hires::robot
