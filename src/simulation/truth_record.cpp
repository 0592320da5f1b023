#include "hires/simulation/truth_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"

namespace hires::simulation {

void TruthRecord::Look(const RobotSimulator& simulator) {
  for (auto& [name, fate] : objects_) fate.stands = false;  // unless it is there
  const std::vector<world::ObjectState> objects = simulator.GetWorldState().objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    LookAt(simulator, static_cast<int>(i), objects[i]);
  }
  const geometry::Pose2& X_MB = simulator.base().X_MB;
  if (last_) distance_ += std::hypot(X_MB.x - last_->x, X_MB.y - last_->y);
  last_ = X_MB;
  if (contact_.empty() && simulator.contact()) {
    contact_ = ToString(*simulator.contact());
  }
}

void TruthRecord::LookAt(const RobotSimulator& simulator, int index,
                         const world::ObjectState& object) {
  const std::string name = base::ToLower(object.name);
  FallWatch& watch = watches_.try_emplace(name, criterion_).first->second;
  const world::Fall fall = watch.Look(simulator, index);
  const world::FallDetector& detector = watch.detector();
  ObjectFate& fate = objects_[name];
  fate.X_MO = object.X_MO;
  fate.attached_to = object.attached_to;
  fate.tilt = detector.now().tilt;
  fate.max_tilt = std::max(fate.max_tilt, fate.tilt);
  fate.falls = detector.falls();
  if (world::IsWorse(fall, fate.first_fall)) fate.first_fall = fall;
  fate.stands = detector.stands();
}

void TruthRecord::ForgetPlaceOf(const std::string& object) {
  const auto watch = watches_.find(base::ToLower(object));
  if (watch != watches_.end()) watch->second.Reset();
}

int TruthRecord::falls() const {
  int falls = 0;
  for (const auto& [name, fate] : objects_) falls += fate.falls;
  return falls;
}

}  // namespace hires::simulation
