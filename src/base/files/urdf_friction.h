#pragma once

#include <map>
#include <string>
#include <vector>

namespace tinyxml2 {
class XMLElement;
}

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

/// Reads `<gazebo reference="link">` (mu1 and mu2, or collision/surface/friction/ode with mu and
/// mu2) and `<lateral_friction>` of a link's `<contact>`, each as a text or as its attribute
/// "value".
/// @param robot  the <robot> element.
UrdfFriction ReadUrdfFriction(const tinyxml2::XMLElement& robot);

}  // namespace hires::base
