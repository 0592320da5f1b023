#include "hires/translation/areas.h"

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "translation/stated_pose.h"

namespace hires::translation {
namespace {

bool BeginsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

AreaKind KindByName(const std::string& name) {
  if (BeginsWith(name, "placingarea")) return AreaKind::kPlacing;
  if (BeginsWith(name, "sittingarea")) return AreaKind::kSeat;
  if (BeginsWith(name, "floorarea")) return AreaKind::kRoom;
  return AreaKind::kStanding;
}

/// The middle of the top of the tray's highest shape, in the tray link's frame.
Area TrayAreaOf(const robot::Robot& robot) {
  Area tray;
  tray.name = kTrayArea;
  tray.kind = AreaKind::kTray;
  tray.link = robot.profile.tray_link;
  tray.X_FA = robot.profile.X_TO;
  const auto link = robot.model.FindLink(tray.link);
  double largest = 0.0;
  for (const geometry::Collision& collision : robot.model.links[*link].collisions) {
    const geometry::Aabb bounds = geometry::BoundsOf(collision.shape, collision.X_BS);
    const Eigen::Vector3d size = bounds.upper - bounds.lower;
    if (size.x() * size.y() <= largest) continue;  // rims and walls are smaller than the plate
    largest = size.x() * size.y();
    const Eigen::Vector3d middle = (bounds.lower + bounds.upper) / 2;
    tray.X_FA = {};
    tray.X_FA.translation = {middle.x(), middle.y(), bounds.upper.z()};
    tray.size = size.head<2>();
  }
  return tray;
}

bool IsBelow(const knowledge::Ontology& ontology, const std::string& below,
             const std::string& above) {
  const auto a = ontology.Find(below), b = ontology.Find(above);
  return a != knowledge::Ontology::kUnknown && b != knowledge::Ontology::kUnknown &&
         ontology.IsA(a, b);
}

AreaKind KindByConcept(const knowledge::Ontology& ontology, const std::string& concept_name) {
  if (IsBelow(ontology, concept_name, "TrayArea")) return AreaKind::kTray;
  if (IsBelow(ontology, concept_name, "PlacingArea")) return AreaKind::kPlacing;
  if (IsBelow(ontology, concept_name, "SittingArea")) return AreaKind::kSeat;
  if (IsBelow(ontology, concept_name, "FloorArea")) return AreaKind::kRoom;
  return AreaKind::kStanding;
}

}  // namespace

const Area* Areas::Find(const std::string& name) const {
  const std::string lower = base::ToLower(name);
  for (const Area& area : all) {
    if (area.name == lower) return &area;
  }
  return nullptr;
}

const Area& Areas::Require(const std::string& name) const {
  if (const Area* area = Find(name)) return *area;
  std::vector<std::string> known;
  for (const Area& area : all) known.push_back(area.name);
  throw base::ConfigError(base::UnknownName("area", name, known));
}

Areas AreasOf(const world::World& world, const robot::Robot& robot) {
  Areas areas;
  for (const auto& [name, X_MF] : world.frames) {
    Area area;
    area.name = name;
    area.kind = KindByName(name);
    area.X_FA = X_MF;
    if (area.kind == AreaKind::kPlacing) {
      const Eigen::AlignedBox2d extent_F = world.ExtentOf(name);
      area.X_FA.translation =
          X_MF * Eigen::Vector3d(extent_F.center().x(), extent_F.center().y(), 0);
      area.size = extent_F.sizes();
    }
    areas.all.push_back(area);
  }
  if (!robot.profile.tray_link.empty() && !areas.Find(kTrayArea)) {
    areas.all.push_back(TrayAreaOf(robot));
  }
  const bool has_room = std::any_of(areas.all.begin(), areas.all.end(),
                                    [](const Area& area) { return area.kind == AreaKind::kRoom; });
  if (!has_room) {
    Area floor;
    floor.name = kFloorArea;
    floor.kind = AreaKind::kRoom;
    areas.all.push_back(std::move(floor));
  }
  std::sort(areas.all.begin(), areas.all.end(),
            [](const Area& a, const Area& b) { return a.name < b.name; });
  return areas;
}

Areas WithKnowledge(Areas areas, const knowledge::FluentView& view,
                    const knowledge::Ontology& ontology) {
  for (Area& area : areas.all) {
    const knowledge::Fluent* fluent = view.Find(area.name);
    if (fluent == nullptr || !IsBelow(ontology, fluent->concept_name, "Area")) continue;
    if (area.kind == AreaKind::kTray) continue;  // the robot's own shape is nearer the truth
    area.kind = KindByConcept(ontology, fluent->concept_name);
    const knowledge::Fluent* box = view.Find(LinkOf(*fluent, "hasBoundingBox"));
    if (box == nullptr) continue;
    const auto x = NumberOf(*box, "hasXSize"), y = NumberOf(*box, "hasYSize");
    if (x && y) area.size = {*x, *y};
  }
  return areas;
}

}  // namespace hires::translation
