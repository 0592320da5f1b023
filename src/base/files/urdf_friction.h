#pragma once

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hires::base {

/// Coefficient [-] for what files call infinite: nothing that is played slips by it.
inline constexpr double kNoSlip = 1000.0;

/// What a URDF says of the friction of its links.
struct UrdfFriction {
  /// An element that holds a coefficient.
  struct Place {
    int line;
    std::string element;  ///< "mu1"
    std::string link;
  };

  std::map<std::string, double> of_links;  ///< the smallest that is said of each, from 0 up
  std::vector<Place> endless;              ///< infinite or negative ones, which are kNoSlip
  std::vector<Place> wrong;                ///< those that hold no number
};

/// Collects UrdfFriction; see ReadUrdfFriction.
class UrdfFrictionReader {
 public:
  UrdfFriction Read(const tinyxml2::XMLElement& robot) {
    for (const auto* link = robot.FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      if (const char* name = link->Attribute("name"))
        Take(At(*link, {"contact"}), "lateral_friction", name);
    }
    for (const auto* gazebo = robot.FirstChildElement("gazebo"); gazebo != nullptr;
         gazebo = gazebo->NextSiblingElement("gazebo")) {
      const char* name = gazebo->Attribute("reference");
      if (name == nullptr) continue;
      const auto* ode = At(*gazebo, {"collision", "surface", "friction", "ode"});
      for (const char* element : {"mu1", "mu2"}) Take(gazebo, element, name);
      for (const char* element : {"mu", "mu2"}) Take(ode, element, name);
    }
    return std::move(result_);
  }

 private:
  /// Null if it is not there.
  static const tinyxml2::XMLElement* At(const tinyxml2::XMLElement& from,
                                        const std::vector<const char*>& path) {
    const tinyxml2::XMLElement* at = &from;
    for (const char* name : path) at = at == nullptr ? nullptr : at->FirstChildElement(name);
    return at;
  }

  /// In its text, or in its attribute "value".
  void Take(const tinyxml2::XMLElement* parent, const char* name, const std::string& link) {
    const auto* element = parent == nullptr ? nullptr : parent->FirstChildElement(name);
    if (element == nullptr) return;
    double mu = 0.0;
    const bool is_read = element->Attribute("value") != nullptr
                             ? element->QueryDoubleAttribute("value", &mu) == tinyxml2::XML_SUCCESS
                             : element->QueryDoubleText(&mu) == tinyxml2::XML_SUCCESS;
    const UrdfFriction::Place place{element->GetLineNum(), name, link};
    if (!is_read || std::isnan(mu)) {
      result_.wrong.push_back(place);
      return;
    }
    if (std::isinf(mu) || mu < 0.0) {
      result_.endless.push_back(place);
      mu = kNoSlip;
    }
    const auto [known, is_new] = result_.of_links.emplace(link, mu);
    if (!is_new) known->second = std::min(known->second, mu);
  }

  UrdfFriction result_;
};

/// Reads `<gazebo reference="link">` (mu1 and mu2, or collision/surface/friction/ode with mu and
/// mu2) and `<lateral_friction>` of a link's `<contact>`, each as a text or as its attribute
/// "value".
/// @param robot  the <robot> element.
inline UrdfFriction ReadUrdfFriction(const tinyxml2::XMLElement& robot) {
  return UrdfFrictionReader().Read(robot);
}

}  // namespace hires::base
