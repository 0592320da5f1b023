#pragma once

#include <rapidcheck.h>

#include <string>
#include <vector>

#include "knowledge/support/restaurant_world.h"

namespace hires::test_support {

constexpr int kNumNames = 7;

/// Uniform in 0 .. size - 1, also in the first cases, which RapidCheck would keep small.
inline int Pick(int size) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, size)); }

template <typename T>
const T& PickOf(const std::vector<T>& choices) {
  return choices[static_cast<std::size_t>(Pick(static_cast<int>(choices.size())))];
}

/// Of an instance that may be anything: so few that links often lead somewhere.
inline std::string PickName() { return "n" + std::to_string(Pick(kNumNames)); }

inline knowledge::Property Link(const std::string& role, const std::string& type) {
  return {role, type, PickName()};
}

/// An area, box, pose, object or state; links point anywhere, also at themselves or at nothing.
inline knowledge::Fluent PickFluent(const std::string& name) {
  using Fluent = knowledge::Fluent;
  switch (Pick(5)) {
    case 0: {
      Fluent area = MakeFluent(PickOf<std::string>({"FloorArea", "PlacingArea"}), name);
      if (Pick(4) > 0) area.properties.push_back(Link("hasBoundingBox", "BoundingBox"));
      return area;
    }
    case 1:
      return MakeFluent("BoundingBox", name, {Link("hasPose", "Pose")});
    case 2:
      return MakeFluent("Pose", name, {{"hasZ", "xsd:float", static_cast<double>(Pick(2))}});
    case 3: {
      Fluent object = MakeFluent(PickOf<std::string>({"Mug", "Book"}), name);
      if (Pick(2) > 0) object.properties.push_back(Link("hasBoundingBox", "BoundingBox"));
      return object;
    }
    default:
      return MakeFluent(
          "On", name, {Link("hasPhysicalEntity", "PassiveObject"), Link("hasArea", "PlacingArea")});
  }
}

}  // namespace hires::test_support
