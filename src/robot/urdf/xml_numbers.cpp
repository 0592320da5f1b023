#include "robot/urdf/xml_numbers.h"

#include <cmath>
#include <locale>
#include <sstream>

namespace hires::robot {

using tinyxml2::XMLElement;

std::optional<std::vector<double>> NumbersIn(const char* text, std::size_t count) {
  if (text == nullptr) return std::nullopt;
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::vector<double> numbers(count, 0.0);
  for (double& number : numbers) in >> number;
  if (in.fail() || !(in >> std::ws).eof()) return std::nullopt;
  return numbers;
}

std::optional<double> NumberIn(const XMLElement* element, const char* attribute) {
  const auto numbers =
      element == nullptr ? std::nullopt : NumbersIn(element->Attribute(attribute), 1);
  if (!numbers || !std::isfinite(numbers->front())) return std::nullopt;
  return numbers->front();
}

std::optional<geometry::Pose3> OriginOf(const XMLElement& element) {
  const XMLElement* origin = element.FirstChildElement("origin");
  if (origin == nullptr) return geometry::Pose3();
  const auto read = [&](const char* attribute) {
    return origin->Attribute(attribute) == nullptr ? std::vector<double>{0.0, 0.0, 0.0}
                                                   : NumbersIn(origin->Attribute(attribute), 3);
  };
  const auto xyz = read("xyz"), rpy = read("rpy");
  if (!xyz || !rpy) return std::nullopt;
  return geometry::Pose3{{(*xyz)[0], (*xyz)[1], (*xyz)[2]},
                         geometry::RotationFromRpy((*rpy)[0], (*rpy)[1], (*rpy)[2])};
}

}  // namespace hires::robot
