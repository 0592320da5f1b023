#include "loop/area_fluents.h"

#include "translation/stated_pose.h"

namespace hires::loop {

using knowledge::Fluent;

std::vector<Fluent> AreaFluents(const std::vector<world::NamedArea>& areas,
                                const knowledge::FluentView& known) {
  std::vector<Fluent> fluents;
  for (const world::NamedArea& area : areas) {
    if (known.Find(area.name) != nullptr) continue;
    translation::StatedPose pose{translation::NameFor("pose", area.name), "", {}};
    pose.X_FO.translation = {area.X_MA.x, area.X_MA.y, area.z.value_or(0.0)};
    pose.X_FO.rotation = geometry::RotationFromRpy(0.0, 0.0, area.X_MA.yaw);
    Fluent stands{"Area", area.name, {{"hasPose", "Pose", pose.instance}}};
    fluents.push_back(translation::PoseFluent(pose));
    fluents.push_back(stands);
  }
  return fluents;
}

}  // namespace hires::loop
