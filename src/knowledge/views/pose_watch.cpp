#include "hires/knowledge/pose_watch.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

constexpr double kPi = 3.14159265358979323846;

const Filler* FindFiller(const Fluent& fluent, const std::string& role) {
  for (const Property& property : fluent.properties) {
    if (property.role == role) return &property.filler;
  }
  return nullptr;
}

std::string TextOf(const Fluent& fluent, const std::string& role) {
  const Filler* filler = FindFiller(fluent, role);
  const auto* text = filler == nullptr ? nullptr : std::get_if<std::string>(filler);
  return text == nullptr ? "" : base::ToLower(*text);
}

double NumberOf(const Fluent& fluent, const std::string& role) {
  const Filler* filler = FindFiller(fluent, role);
  if (filler == nullptr) return 0.0;
  if (const auto* real = std::get_if<double>(filler)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(filler)) return static_cast<double>(*integer);
  return 0.0;
}

/// What hands hold and what stands on a tray.
std::set<std::string> CarriedIn(const FluentView& view, const Ontology& ontology) {
  std::set<std::string> carried;
  view.OfConcept("Holding", [&](const Fluent& holding) {
    carried.insert(TextOf(holding, "hasPassiveObject"));
    return true;
  });
  const Ontology::ConceptId tray = ontology.Find("TrayArea");
  view.OfConcept("On", [&](const Fluent& on) {
    const Fluent* area = view.Find(TextOf(on, "hasArea"));
    const Ontology::ConceptId kind =
        area == nullptr ? Ontology::kUnknown : ontology.Find(area->concept_name);
    if (kind != Ontology::kUnknown && tray != Ontology::kUnknown && ontology.IsA(kind, tray)) {
      carried.insert(TextOf(on, "hasPhysicalEntity"));
    }
    return true;
  });
  return carried;
}

/// Things and people, but neither the robot nor areas and boxes, whose poses are those of others.
bool IsWatched(const Fluent& fluent, const Ontology& ontology) {
  const Ontology::ConceptId kind = ontology.Find(fluent.concept_name);
  if (kind == Ontology::kUnknown) return false;
  for (const char* other : {"Robot", "ArtificialBodyPart", "Area", "BoundingBox"}) {
    const Ontology::ConceptId above = ontology.Find(other);
    if (above != Ontology::kUnknown && ontology.IsA(kind, above)) return false;
  }
  return true;
}

}  // namespace

PoseWatch::PoseWatch(const Ontology* ontology, const PoseWatchParams& params)
    : ontology_(ontology), params_(params) {}

std::map<std::string, PoseWatch::Seen> PoseWatch::PosesIn(const FluentView& view) const {
  const std::set<std::string> carried = CarriedIn(view, *ontology_);
  std::map<std::string, Seen> poses;
  view.All([&](const Fluent& fluent) {
    const std::string pose_name = TextOf(fluent, "hasPose");
    const Fluent* pose = pose_name.empty() ? nullptr : view.Find(pose_name);
    if (pose == nullptr || !IsWatched(fluent, *ontology_)) return true;
    const std::string name = base::ToLower(fluent.instance);
    const std::string frame = TextOf(*pose, "hasFrame");
    poses[name] = {NumberOf(*pose, "hasX"),   NumberOf(*pose, "hasY"),     NumberOf(*pose, "hasZ"),
                   NumberOf(*pose, "hasYaw"), frame == "map" ? "" : frame, carried.count(name) > 0};
    return true;
  });
  return poses;
}

bool PoseWatch::HasMoved(const Seen& before, const Seen& now) const {
  if (now.is_carried && now.frame.empty()) return false;  // it moves with the robot
  if (before.frame != now.frame) return true;
  const double distance = std::hypot(now.x - before.x, now.y - before.y, now.z - before.z);
  const double turn = std::abs(std::remainder(now.yaw - before.yaw, 2.0 * kPi));
  return distance > params_.distance || turn > params_.angle;
}

std::vector<std::string> PoseWatch::Update(const FluentView& view) {
  const std::map<std::string, Seen> poses = PosesIn(view);
  std::vector<std::string> changed;
  for (const auto& [name, now] : poses) {
    const auto before = told_.find(name);
    if (before != told_.end() && !HasMoved(before->second, now)) {
      if (now.is_carried) before->second = now;
      continue;
    }
    told_[name] = now;
    changed.push_back(name);
  }
  for (auto before = told_.begin(); before != told_.end();) {
    if (poses.count(before->first) > 0) {
      ++before;
      continue;
    }
    changed.push_back(before->first);
    before = told_.erase(before);
  }
  if (std::exchange(is_first_, false)) return {};
  std::sort(changed.begin(), changed.end());
  return changed;
}

}  // namespace hires::knowledge
