#include "hires/simulation/object_memory.h"

#include <algorithm>

#include "hires/base/text.h"

namespace hires::simulation {

using geometry::Pose2;
using geometry::Pose3;

namespace {

/// An object that is not there any more is missed only where much more of it ought to be seen than
/// the recogniser needs: at the edge of what it needs, not seeing tells nothing.
constexpr double kMissedShare = 2.0;  // of the share that the recogniser needs

}  // namespace

void ObjectMemory::Place(const Pose3& X_MO, const Pose2& X_MBbelieved, Entry* entry) const {
  const Pose3 X_BO = geometry::Lift(X_MBbelieved).Inverse() * X_MO;
  entry->seen.X_MO = X_MO;
  entry->seen.attached_to.clear();
  entry->X_BO.reset();
  if (rides_along_(entry->seen.model, X_BO)) entry->X_BO = X_BO;
}

Pose3 ObjectMemory::PoseOf(const Entry& entry, const Pose2& X_MBbelieved) {
  return entry.X_BO ? geometry::Lift(X_MBbelieved) * *entry.X_BO : entry.seen.X_MO;
}

void ObjectMemory::Remember(const std::vector<robot::SeenObject>& objects,
                            const Pose2& X_MBbelieved) {
  for (const robot::SeenObject& object : objects) {
    Entry& entry = entries_[base::ToLower(object.name)];
    if (!entry.seen.attached_to.empty()) continue;
    entry.seen = object;
    entry.seen.name = base::ToLower(object.name);
    Place(object.X_MO, X_MBbelieved, &entry);
  }
}

void ObjectMemory::Look(const std::vector<perception::Detection>& detections,
                        const perception::LineOfSight& sight,
                        const perception::CameraView& true_view, const CameraPoses& camera,
                        const perception::DetectorParams& params, double time,
                        const Pose2& X_MBbelieved) {
  const Pose3 X_TrueBelieved = camera.X_MC * camera.X_MCbelieved.Inverse();
  const double missed_share = std::min(1.0, kMissedShare * params.min_visible_share);
  for (auto it = entries_.begin(); it != entries_.end();) {
    const robot::SeenObject& seen = it->second.seen;
    const bool is_seen = std::any_of(
        detections.begin(), detections.end(),
        [&](const perception::Detection& found) { return base::ToLower(found.name) == it->first; });
    const Pose3 X_MO = X_TrueBelieved * PoseOf(it->second, X_MBbelieved);
    const bool is_missed =
        !is_seen && seen.attached_to.empty() &&
        sight.VisibleShareAt(true_view, seen.model, X_MO, seen.name) >= missed_share;
    it = is_missed ? entries_.erase(it) : std::next(it);
  }
  for (const perception::Detection& found : detections) {
    Entry& entry = entries_[base::ToLower(found.name)];
    if (!entry.seen.attached_to.empty()) continue;  // the hand knows better
    entry.seen.name = base::ToLower(found.name);
    entry.seen.model = found.model;
    entry.seen.time = time;
    Place(camera.X_MCbelieved * found.X_CO, X_MBbelieved, &entry);
  }
}

void ObjectMemory::Take(const std::string& link, const Pose3& X_MLbelieved,
                        const robot::SeenObject& object, const Pose3& X_LO,
                        const Pose2& X_MBbelieved) {
  const std::string name = base::ToLower(object.name);
  const bool is_known = entries_.count(name) == 1;
  Entry& entry = entries_[name];
  entry.X_LO = is_known ? X_MLbelieved.Inverse() * PoseOf(entry, X_MBbelieved) : X_LO;
  if (!is_known) entry.seen = object;
  entry.seen.name = name;
  entry.seen.attached_to = link;
  entry.X_BO.reset();
}

void ObjectMemory::Release(const std::string& name, const Pose3& X_MLbelieved,
                           const Pose2& X_MBbelieved) {
  const auto known = entries_.find(base::ToLower(name));
  if (known == entries_.end()) return;
  Place(X_MLbelieved * known->second.X_LO, X_MBbelieved, &known->second);
}

std::vector<robot::SeenObject> ObjectMemory::Known(const std::map<std::string, Pose3>& X_MLbelieved,
                                                   const Pose2& X_MBbelieved) const {
  std::vector<robot::SeenObject> known;
  for (const auto& [name, entry] : entries_) {
    known.push_back(entry.seen);
    known.back().X_MO = PoseOf(entry, X_MBbelieved);
    const auto link = X_MLbelieved.find(entry.seen.attached_to);
    if (link != X_MLbelieved.end()) known.back().X_MO = link->second * entry.X_LO;
  }
  return known;
}

}  // namespace hires::simulation
