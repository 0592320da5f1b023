#include "hires/skills/base_place.h"

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::skills {

const std::vector<BasePlace>& BasePlaces() {
  static const std::vector<BasePlace> places{
      {"default", 0.0, 0.0}, {"left", 0.0, 0.2}, {"right", 0.0, -0.2}, {"behind", -0.2, 0.0}};
  return places;
}

geometry::Pose2 AtBasePlace(const geometry::Pose2& X_MStand, const std::string& place) {
  std::vector<std::string> names;
  for (const BasePlace& known : BasePlaces()) {
    if (known.name == base::ToLower(place)) {
      return X_MStand * geometry::Pose2{known.ahead, known.left, 0.0};
    }
    names.push_back(known.name);
  }
  throw base::ConfigError(base::UnknownName("base place", place, names));
}

}  // namespace hires::skills
