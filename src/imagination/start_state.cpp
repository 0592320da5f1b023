#include "hires/imagination/start_state.h"

#include <fmt/format.h>

#include <optional>
#include <set>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/link_bounds.h"
#include "hires/simulation/free_start.h"
#include "hires/translation/areas.h"

namespace hires::imagination {
namespace {

geometry::Pose3 AreaPose(const ImaginationSetup& setup, const std::string& area) {
  if (const auto X_MArea = setup.scene->world.FindFrame(area)) return *X_MArea;
  throw base::ConfigError(base::UnknownName("area", area, setup.scene->world.FrameNames()));
}

}  // namespace

void RefuseFixed(const ImaginationSetup& setup, const std::string& object) {
  const world::World& world = setup.scene->world;
  for (const world::StaticBody& body : world.statics) {
    if (base::ToLower(body.name) != base::ToLower(object)) continue;
    const std::string source = world::SourceOf(body.name, world);
    throw base::ConfigError(fmt::format(
        "object '{}' stands still where the world{} has it, and cannot be put elsewhere: it is no "
        "loose thing, or it reaches into another one there; move it in the world's file",
        object, source.empty() ? "" : " (" + source + ")"));
  }
}

namespace {

world::ObjectState MakeObject(const ImaginationSetup& setup, const std::string& name,
                              const geometry::Pose3& X_MO) {
  RefuseFixed(setup, name);
  world::ObjectState object;
  object.name = base::ToLower(name);
  // Two cartons of a world are of one model, which has the name of the first.
  const world::ObjectState* own = setup.scene->world.initial.Find(name);
  object.model = own != nullptr ? own->model : setup.ModelOf(name);
  object.X_MO = X_MO;
  return object;
}

void RefuseLoad(const ImaginationSetup& setup, const std::vector<std::string>& on_tray) {
  if (on_tray.size() > 3) {
    throw base::ConfigError(fmt::format(
        "{} objects are wanted on the tray, it has 3 places; name at most 3", on_tray.size()));
  }
  const robot::Robot& robot = setup.scene->robot;
  if (on_tray.empty() || !robot.profile.tray_link.empty()) return;
  throw base::ConfigError(
      fmt::format("'{}' cannot be carried: {}", on_tray.front(), robot::NoTrayText(robot)));
}

/// At its own place, or where there is room beside the others.
/// @throws base::ConfigError as simulation::RefuseOffTray.
void PutOnTray(const ImaginationSetup& setup, const robot::RobotState& robot,
               const std::vector<world::ObjectState>& others, world::ObjectState* object) {
  const simulation::Scene& scene = *setup.scene;
  std::optional<simulation::TrayPlace> place;
  if (!others.empty()) place = simulation::FreeOnTray(scene, robot, *object, others);
  const bool is_moved = place && place->X_MO.translation != object->X_MO.translation;
  if (is_moved) object->X_MO = place->X_MO;
  simulation::RefuseOffTray(scene, robot, *object);
  if (place && !place->is_carried) {
    base::Log(
        base::LogLevel::kWarn,
        fmt::format("object={} note=\"beside the others the tray has no room that carries it: "
                    "it begins far over an edge, and may fall by itself; name fewer or "
                    "smaller things\"",
                    object->name));
  }
  if (!is_moved) return;
  const geometry::Pose3 X_MTray = geometry::Lift(robot.X_MB) * scene.X_BO;
  const Eigen::Vector3d p_T = (X_MTray.Inverse() * object->X_MO).translation;
  base::Log(base::LogLevel::kWarn,
            fmt::format("object={} note=\"{:g} m beside the middle of the tray it has no room: it "
                        "begins at x {:.2f} m, y {:.2f} m of it\"",
                        object->name, setup.translator.slot_distance, p_T.x(), p_T.y()));
}

void RefuseOtherStorey(const ImaginationSetup& setup, const std::string& area) {
  const auto elsewhere = setup.skills->elsewhere.find(base::ToLower(area));
  if (elsewhere != setup.skills->elsewhere.end())
    throw base::ConfigError("the start: " + elsewhere->second);
}

/// Who asks knows better than the world's file where an object is.
void AddInitialObjects(const ImaginationSetup& setup, world::WorldState* state) {
  std::vector<world::ObjectState> objects;
  for (const world::ObjectState& object : setup.scene->world.initial.objects) {
    if (state->Find(object.name) == nullptr) objects.push_back(object);
  }
  state->objects.insert(state->objects.begin(), objects.begin(), objects.end());
}

/// What the atoms put on the tray: the first stays in its place, the others have room beside it.
void ArrangeTray(const ImaginationSetup& setup, const std::vector<base::Atom>& atoms,
                 StartState* start) {
  std::set<std::string> on_tray;
  for (const base::Atom& atom : atoms) {
    const bool is_on_tray = base::ToLower(atom.predicate) == "on" && atom.arguments.size() == 2 &&
                            base::ToLower(atom.arguments[1]) == translation::kTrayArea;
    if (is_on_tray) on_tray.insert(base::ToLower(atom.arguments[0]));
  }
  std::vector<world::ObjectState> placed;
  for (world::ObjectState& object : start->world.objects) {
    if (on_tray.count(base::ToLower(object.name)) == 0) continue;
    PutOnTray(setup, start->robot, placed, &object);
    placed.push_back(object);
  }
}

void Put(const ImaginationSetup& setup, const PutObject& put, world::WorldState* state) {
  if (state->Find(put.object) != nullptr) {
    throw base::ConfigError(
        fmt::format("object '{}' has two places; name it once", base::ToLower(put.object)));
  }
  const geometry::Pose3 X_MArea = put.area.empty() ? geometry::Pose3() : AreaPose(setup, put.area);
  state->objects.push_back(MakeObject(setup, put.object, X_MArea * put.X_AO));
}

}  // namespace

StartState StartOnTray(const ImaginationSetup& setup, const geometry::Pose2& X_MB,
                       const std::vector<std::string>& objects) {
  RefuseLoad(setup, objects);
  StartState start;
  start.robot.X_MB = X_MB;
  start.robot.joints = setup.scene->robot.profile.joints;
  const double beside = setup.translator.slot_distance;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const double y = i == 0 ? 0.0 : (i == 1 ? -beside : beside);
    world::ObjectState object = MakeObject(
        setup, objects[i],
        geometry::Lift(start.robot.X_MB) * setup.scene->X_BO * geometry::Lift({0.0, y, 0.0}));
    PutOnTray(setup, start.robot, start.world.objects, &object);
    start.world.objects.push_back(std::move(object));
  }
  return start;
}

StartState MakeStartState(const ImaginationSetup& setup, const std::string& area,
                          const std::vector<std::string>& objects) {
  const geometry::Pose3 X_MArea = AreaPose(setup, area);
  RefuseOtherStorey(setup, area);
  StartState start = StartOnTray(setup, geometry::Flatten(X_MArea), objects);
  AddInitialObjects(setup, &start.world);
  return start;
}

StartState MakeStartState(const ImaginationSetup& setup, const std::vector<base::Atom>& atoms,
                          const std::vector<PutObject>& put) {
  for (const base::Atom& atom : atoms) {
    const bool is_place = base::ToLower(atom.predicate) == "robotat" && atom.arguments.size() == 1;
    if (is_place) RefuseOtherStorey(setup, atom.arguments.front());
  }
  const translation::GeometricState state = translation::StateOf(setup.translator, nullptr, atoms);
  StartState start{state.world, state.robot};
  ArrangeTray(setup, atoms, &start);
  for (const PutObject& object : put) Put(setup, object, &start.world);
  AddInitialObjects(setup, &start.world);
  return start;
}

}  // namespace hires::imagination
