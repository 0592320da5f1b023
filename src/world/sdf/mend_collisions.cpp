#include "world/sdf/mend_collisions.h"

#include <fmt/format.h>

#include <cstdlib>
#include <set>
#include <vector>

#include "hires/base/text.h"
#include "world/sdf/mend_friction.h"
#include "world/sdf/prune_sdf.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

std::string PlaceIn(const XMLElement& element, const std::string& path) {
  const char* name = element.Attribute("name");
  return fmt::format("{}:{}{}", path, element.GetLineNum(),
                     name == nullptr ? "" : fmt::format(" '{}'", name));
}

std::vector<XMLElement*> ChildrenOf(XMLElement* parent, const char* name = nullptr) {
  std::vector<XMLElement*> children;
  for (XMLElement* child = parent->FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name)) {
    children.push_back(child);
  }
  return children;
}

/// Why nothing collides with it; "" of others.
std::string WhyGhost(XMLElement* collision) {
  XMLElement* surface = collision->FirstChildElement("surface");
  XMLElement* contact = surface == nullptr ? nullptr : surface->FirstChildElement("contact");
  if (contact == nullptr) return "";
  const std::string without = TrimmedText(contact->FirstChildElement("collide_without_contact"));
  if (without == "1" || base::ToLower(without) == "true") return "<collide_without_contact>";
  const std::string mask = TrimmedText(contact->FirstChildElement("collide_bitmask"));
  if (mask.empty()) return "";
  char* end = nullptr;
  const unsigned long bits = std::strtoul(mask.c_str(), &end, 0);
  constexpr unsigned long kAllBits = 0xffff;  // a bitmask has 16
  return *end == '\0' && (bits & kAllBits) == 0 ? "a <collide_bitmask> of 0" : "";
}

/// What <geometry> elements of a collision hold; the rings of a polyline are one shape.
std::vector<std::vector<XMLElement*>> ShapesIn(XMLElement* collision) {
  std::vector<std::vector<XMLElement*>> shapes;
  for (XMLElement* geometry : ChildrenOf(collision, "geometry")) {
    bool has_ring = false;
    for (XMLElement* child : ChildrenOf(geometry)) {
      const std::string name = child->Name();
      if (name.find(':') != std::string::npos) continue;
      const bool is_ring = name == "polyline";
      if (is_ring && has_ring) {
        shapes.back().push_back(child);
      } else {
        shapes.push_back({child});
      }
      has_ring = is_ring;
    }
  }
  return shapes;
}

/// SDF takes the first, and lets the others go without a word; somebody wrote them to be there.
void SplitShapes(XMLElement* collision, const std::string& path, LoadNotes* notes) {
  const std::vector<std::vector<XMLElement*>> shapes = ShapesIn(collision);
  if (shapes.size() < 2) return;
  notes->Add("collision", "of several shapes, where SDF knows one: all of them are taken",
             PlaceIn(*collision, path));
  tinyxml2::XMLDocument* document = collision->GetDocument();
  XMLElement* last = collision;
  for (std::size_t i = 1; i < shapes.size(); ++i) {
    XMLElement* more = collision->ShallowClone(document)->ToElement();
    for (XMLElement* child : ChildrenOf(collision)) {
      if (child->Name() != std::string("geometry"))
        more->InsertEndChild(child->DeepClone(document));
    }
    XMLElement* geometry = document->NewElement("geometry");
    more->InsertEndChild(geometry);
    for (XMLElement* shape : shapes[i]) geometry->InsertEndChild(shape);  // moves it there
    last->Parent()->InsertAfterChild(last, more);
    last = more;
  }
  for (XMLElement* geometry : ChildrenOf(collision, "geometry")) {
    if (geometry->FirstChildElement() == nullptr) collision->DeleteChild(geometry);
  }
}

/// A point or a line. Planes have no size, and a mesh of scale 0 is a mistake, as is a plate
/// without thickness: something lies on it, or would be stopped by it.
bool IsOfSizeZero(const XMLElement& shape) {
  static const std::set<std::string> sized{"box",  "cylinder",  "sphere",  "capsule",
                                           "cone", "ellipsoid", "polyline"};
  if (sized.count(shape.Name()) == 0) return false;
  int num_zeros = 0;
  for (const char* name : {"size", "radius", "length", "radii", "height"}) {
    const std::string text = TrimmedText(shape.FirstChildElement(name));
    for (const char* at = text.c_str(); *at != '\0';) {
      char* end = nullptr;
      const double number = std::strtod(at, &end);
      if (end == at) break;  // no number, of which others tell
      const bool is_radius = name == std::string("radius");
      if (number == 0.0 && (is_radius || ++num_zeros == 2)) return true;
      at = end + (*end == ',' ? 1 : 0);
    }
  }
  return false;
}

/// @return whether that leaves none.
bool DropShapesOfSizeZero(XMLElement* collision, const std::string& path, LoadNotes* notes) {
  bool is_any = false, is_none_left = true;
  for (XMLElement* geometry : ChildrenOf(collision, "geometry")) {
    for (XMLElement* shape : ChildrenOf(geometry)) {
      if (!IsOfSizeZero(*shape)) {
        is_none_left = false;
        continue;
      }
      is_any = true;
      geometry->DeleteChild(shape);
    }
  }
  if (is_any)
    notes->Add("collision", "with a shape of size 0 left out, as nothing touches it",
               PlaceIn(*collision, path));
  return is_any && is_none_left;
}

void NumberNames(XMLElement* link) {
  std::set<std::string> names;
  for (XMLElement* collision : ChildrenOf(link, "collision")) {
    const char* written = collision->Attribute("name");
    if (written == nullptr) continue;
    const std::string wanted = written;
    std::string name = wanted;
    for (int i = 2; !names.insert(name).second; ++i) name = fmt::format("{}_{}", wanted, i);
    if (name != wanted) collision->SetAttribute("name", name.c_str());
  }
}

}  // namespace

void MendCollisions(XMLElement* link, const std::string& path, LoadNotes* notes) {
  for (XMLElement* collision : ChildrenOf(link, "collision")) {
    const std::string why = WhyGhost(collision);
    if (DropShapesOfSizeZero(collision, path, notes)) {
      link->DeleteChild(collision);
      continue;
    }
    if (why.empty()) {
      MendFriction(collision, path, notes);
      SplitShapes(collision, path, notes);
      continue;
    }
    notes->Add("collision", "with " + why + " left out, as nothing collides with it",
               PlaceIn(*collision, path));
    link->DeleteChild(collision);
  }
  NumberNames(link);
}

}  // namespace hires::world
