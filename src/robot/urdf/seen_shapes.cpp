#include "robot/urdf/seen_shapes.h"

#include <tinyxml2.h>

#include <algorithm>

#include "base/files/plain_xml.h"
#include "robot/urdf/xml_numbers.h"

namespace hires::robot {
namespace {

using tinyxml2::XMLElement;

/// The element in a <visual> or <collision> that is its shape, or null.
const XMLElement* ShapeElementOf(const XMLElement& owner) {
  const XMLElement* geometry = owner.FirstChildElement("geometry");
  return geometry == nullptr ? nullptr : geometry->FirstChildElement();
}

bool HasCollisionShape(const XMLElement& link) {
  for (const auto* collision = link.FirstChildElement("collision"); collision != nullptr;
       collision = collision->NextSiblingElement("collision")) {
    if (ShapeElementOf(*collision) != nullptr) return true;
  }
  return false;
}

/// Above 0, or nothing.
std::optional<double> LengthIn(const XMLElement& shape, const char* attribute) {
  const auto length = NumberIn(&shape, attribute);
  return length && *length > 0.0 ? length : std::nullopt;
}

std::optional<SeenShape> SeenShapeOf(const XMLElement& visual) {
  const XMLElement* element = ShapeElementOf(visual);
  const auto X_LS = OriginOf(visual);
  if (element == nullptr || !X_LS || !X_LS->IsFinite()) return std::nullopt;
  const std::string kind = element->Name();
  if (kind == "mesh") return SeenShape{*X_LS, std::nullopt};
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

std::map<std::string, std::vector<SeenShape>> ShapesSeenOnly(const std::string& urdf_xml) {
  std::map<std::string, std::vector<SeenShape>> seen;
  const std::string xml = base::PlainXml(urdf_xml, "URDF");  // was read before
  tinyxml2::XMLDocument document;
  document.Parse(xml.data(), xml.size());
  const XMLElement* robot = document.FirstChildElement("robot");
  if (document.Error() || robot == nullptr) return seen;
  for (const auto* link = robot->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    const char* name = link->Attribute("name");
    if (name == nullptr || HasCollisionShape(*link)) continue;
    for (const auto* visual = link->FirstChildElement("visual"); visual != nullptr;
         visual = visual->NextSiblingElement("visual")) {
      if (const auto shape = SeenShapeOf(*visual)) seen[name].push_back(*shape);
    }
  }
  return seen;
}

}  // namespace hires::robot
