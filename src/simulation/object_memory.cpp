#include "hires/simulation/object_memory.h"

#include <algorithm>

#include "hires/base/text.h"

namespace hires::simulation {

using geometry::Pose3;

namespace {

/// An object that is not there any more is missed only where much more of it ought to be seen than
/// the recogniser needs: at the edge of what it needs, not seeing tells nothing.
constexpr double kMissedShare = 2.0;  // of the share that the recogniser needs

}  // namespace

void ObjectMemory::Remember(const std::vector<robot::SeenObject>& objects) {
  for (robot::SeenObject object : objects) {
    object.name = base::ToLower(object.name);
    const std::string name = object.name;
    entries_[name] = {std::move(object), Pose3()};
  }
}

void ObjectMemory::Look(const std::vector<perception::Detection>& detections,
                        const perception::LineOfSight& sight,
                        const perception::CameraView& true_view, const CameraPoses& camera,
                        const perception::DetectorParams& params, double time) {
  for (auto it = entries_.begin(); it != entries_.end();) {
    const robot::SeenObject& seen = it->second.seen;
    const bool is_seen = std::any_of(
        detections.begin(), detections.end(),
        [&](const perception::Detection& found) { return base::ToLower(found.name) == it->first; });
    const Pose3 X_MO = camera.X_MC * camera.X_MCbelieved.Inverse() * seen.X_MO;
    const bool is_missed = !is_seen && seen.attached_to.empty() &&
                           sight.VisibleShareAt(true_view, seen.model, X_MO, seen.name) >=
                               std::min(1.0, kMissedShare * params.min_visible_share);
    it = is_missed ? entries_.erase(it) : std::next(it);
  }
  for (const perception::Detection& found : detections) {
    Entry& entry = entries_[base::ToLower(found.name)];
    if (!entry.seen.attached_to.empty()) continue;  // the hand knows better
    entry.seen = {base::ToLower(found.name), found.model, camera.X_MCbelieved * found.X_CO, time,
                  ""};
  }
}

void ObjectMemory::Take(const std::string& link, const Pose3& X_MLbelieved,
                        const robot::SeenObject& object, const Pose3& X_LO) {
  const std::string name = base::ToLower(object.name);
  const auto known = entries_.find(name);
  if (known == entries_.end()) {
    entries_[name] = {object, X_LO};
    entries_[name].seen.name = name;
  } else {
    known->second.X_LO = X_MLbelieved.Inverse() * known->second.seen.X_MO;
  }
  entries_[name].seen.attached_to = link;
}

void ObjectMemory::Release(const std::string& name, const Pose3& X_MLbelieved) {
  const auto known = entries_.find(base::ToLower(name));
  if (known == entries_.end()) return;
  known->second.seen.X_MO = X_MLbelieved * known->second.X_LO;
  known->second.seen.attached_to.clear();
}

std::vector<robot::SeenObject> ObjectMemory::Known(
    const std::map<std::string, Pose3>& X_MLbelieved) const {
  std::vector<robot::SeenObject> known;
  for (const auto& [name, entry] : entries_) {
    known.push_back(entry.seen);
    const auto link = X_MLbelieved.find(entry.seen.attached_to);
    if (link != X_MLbelieved.end()) known.back().X_MO = link->second * entry.X_LO;
  }
  return known;
}

}  // namespace hires::simulation
