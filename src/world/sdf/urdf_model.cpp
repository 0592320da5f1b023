#include "world/sdf/urdf_model.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <memory>
#include <sdf/Element.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>
#include <vector>

#include "hires/base/error.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

constexpr double kInvented = 1e-5;  // [kg] what libsdformat takes for a mass, and nothing weighs

std::string Converted(const std::string& xml, const std::string& path) {
  sdf::Errors errors;
  const auto document = std::make_shared<sdf::SDF>();
  sdf::init(document);
  if (sdf::readString(xml, document, errors) && errors.empty() && document->Root() != nullptr)
    return document->Root()->ToString("");
  throw base::ConfigError(fmt::format("{}: this URDF cannot be included: {}", path,
                                      errors.empty() ? "it is not valid" : errors[0].Message()));
}

/// Of both formats.
std::vector<XMLElement*> LinksIn(XMLElement* element) {
  std::vector<XMLElement*> links;
  for (XMLElement* child = element->FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    if (name == "link") links.push_back(child);
    if (name != "model") continue;
    const std::vector<XMLElement*> inner = LinksIn(child);
    links.insert(links.end(), inner.begin(), inner.end());
  }
  return links;
}

int NumCollisionsIn(XMLElement* root) {
  int count = 0;
  for (XMLElement* link : LinksIn(root)) {
    for (const auto* shape = link->FirstChildElement("collision"); shape != nullptr;
         shape = shape->NextSiblingElement("collision")) {
      ++count;
    }
  }
  return count;
}

std::string XmlText(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

/// @return how many.
int InventMasses(XMLElement* robot) {
  int count = 0;
  for (XMLElement* link : LinksIn(robot)) {
    XMLElement* inertial = link->FirstChildElement("inertial");
    const XMLElement* mass = inertial == nullptr ? nullptr : inertial->FirstChildElement("mass");
    const char* name = link->Attribute("name");
    const bool is_world = name != nullptr && std::string(name) == "world";  // stands for it
    if (is_world || (mass != nullptr && mass->DoubleAttribute("value") > 0.0)) continue;
    if (inertial != nullptr) link->DeleteChild(inertial);
    inertial = link->InsertNewChildElement("inertial");
    inertial->InsertNewChildElement("mass")->SetAttribute("value", kInvented);
    XMLElement* inertia = inertial->InsertNewChildElement("inertia");
    for (const char* moment : {"ixx", "iyy", "izz"}) inertia->SetAttribute(moment, 1e-9);
    for (const char* product : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(product, 0.0);
    ++count;
  }
  return count;
}

/// Of links that have no other mass.
void TakeInventedMasses(int count, XMLElement* root) {
  for (XMLElement* link : LinksIn(root)) {
    XMLElement* inertial = link->FirstChildElement("inertial");
    const XMLElement* mass = inertial == nullptr ? nullptr : inertial->FirstChildElement("mass");
    if (mass != nullptr && mass->DoubleText() < 1.01 * count * kInvented)
      link->DeleteChild(inertial);
  }
}

}  // namespace

std::string SdfTextOfUrdf(const std::string& xml, const std::string& path) {
  const std::string plain = Converted(xml, path);
  tinyxml2::XMLDocument robot, model;
  robot.Parse(xml.data(), xml.size());
  model.Parse(plain.data(), plain.size());
  if (robot.Error() || model.Error()) return plain;  // of which others tell
  if (NumCollisionsIn(model.RootElement()) >= NumCollisionsIn(robot.RootElement())) return plain;
  const int count = InventMasses(robot.RootElement());
  if (count == 0) return plain;
  const std::string heavier = Converted(XmlText(robot), path);
  model.Parse(heavier.data(), heavier.size());
  TakeInventedMasses(count, model.RootElement());
  return XmlText(model);
}

}  // namespace hires::world
