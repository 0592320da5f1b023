#pragma once

#include <tinyxml2.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::robot {

/// `count` numbers and nothing else, with a point whatever the locale. @param text  may be null.
std::optional<std::vector<double>> NumbersIn(const char* text, std::size_t count);

/// A finite number that an attribute holds. @param element  may be null.
std::optional<double> NumberIn(const tinyxml2::XMLElement* element, const char* attribute);

/// Of an element's <origin>; the identity where it has none, nothing where that holds no numbers.
std::optional<geometry::Pose3> OriginOf(const tinyxml2::XMLElement& element);

}  // namespace hires::robot
