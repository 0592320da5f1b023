#include "hires/translation/classification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "translation/body.h"
#include "translation/place.h"

namespace hires::translation {
namespace {

using base::Atom;

/// What the atoms before say, by predicate and the first of two arguments.
std::string ValueBefore(const std::vector<Atom>* before, const std::string& predicate,
                        const std::string& key) {
  if (before == nullptr) return "";
  for (const Atom& atom : *before) {
    if (base::ToLower(atom.predicate) != predicate || atom.arguments.empty()) continue;
    if (atom.arguments.size() == 1 && key.empty()) return base::ToLower(atom.arguments[0]);
    if (atom.arguments.size() == 2 && base::ToLower(atom.arguments[0]) == key) {
      return base::ToLower(atom.arguments[1]);
    }
  }
  return "";
}

/// 0..1 within the tolerances of an area, above 1 outside.
double OffsetFrom(const Area& area, const geometry::Pose2& X_MB, const ClassifyParams& params) {
  const geometry::Pose2 X_MA = geometry::Flatten(area.X_FA);
  const double distance = (X_MB.position() - X_MA.position()).norm();
  const double turn = std::abs(geometry::WrapToPi(X_MB.yaw - X_MA.yaw));
  return std::max(distance / params.area_distance, turn / params.area_yaw);
}

/// The room that the robot is in, else the first there is.
const Area* RoomAround(const Areas& areas, const geometry::Pose2& X_MB) {
  const Area* room = nullptr;
  for (const Area& area : areas.all) {
    if (area.kind != AreaKind::kRoom) continue;
    const Eigen::Vector2d p_A = geometry::Flatten(area.X_FA).Inverse() * X_MB.position();
    if ((p_A.cwiseAbs().array() <= area.size.array() / 2).all()) return &area;
    if (room == nullptr) room = &area;
  }
  return room;
}

const Area* StandingAt(const Areas& areas, const geometry::Pose2& X_MB,
                       const ClassifyParams& params, const std::string& before) {
  const Area* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Area& area : areas.all) {
    if (area.kind != AreaKind::kStanding) continue;
    // What held before counts as nearer, so that it is left late and not left for a neighbour.
    const double offset =
        OffsetFrom(area, X_MB, params) / (area.name == before ? params.hysteresis : 1.0);
    if (offset > 1.0 || offset >= least) continue;
    nearest = &area;
    least = offset;
  }
  return nearest ? nearest : RoomAround(areas, X_MB);
}

std::string TorsoPosture(const robot::UpperBodyProfile& body, const robot::JointPositions& joints,
                         const ClassifyParams& params, const std::string& before) {
  const auto position = joints.find(body.torso_joint);
  const double height = position == joints.end() ? 0.0 : position->second;
  std::string nearest = kUnnamedTorsoPosture;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [name, named_height] : body.torso_postures) {
    const double distance = std::abs(height - named_height);
    const double factor = name == before ? params.hysteresis : 1.0;
    if (distance > factor * params.torso_tolerance || distance >= least) continue;
    nearest = name;
    least = distance;
  }
  return nearest;
}

/// What the hand of an arm holds; `nothing` if it is empty.
std::string HeldBy(const robot::ArmProfile& arm, const world::WorldState& world) {
  for (const world::ObjectState& object : world.objects) {
    if (object.attached_to == arm.palm_link) return base::ToLower(object.name);
  }
  return "nothing";
}

void AddBodyAtoms(const TranslatorContext& context, const GeometricState& state,
                  const std::vector<Atom>* before, std::vector<Atom>* atoms) {
  const auto& body = context.robot->profile.upper_body;
  if (!body) return;
  for (const auto& [name, arm] : body->arms) {
    const PostureParams tolerances{
        context.classify.tucked_tolerance, context.classify.posture_tolerance,
        ValueBefore(before, "hasarmposture", name), context.classify.hysteresis};
    const std::string posture = NameArmPosture(*context.robot, arm, state.robot.joints, tolerances);
    atoms->push_back({"HasArmPosture", {name, posture}});
    atoms->push_back({"Holding", {name, HeldBy(arm, state.world)}});
  }
  const std::string torso = TorsoPosture(*body, state.robot.joints, context.classify,
                                         ValueBefore(before, "hastorsoposture", ""));
  atoms->push_back({"HasTorsoPosture", {torso}});
}

}  // namespace

bool IsObservable(const Atom& atom) {
  static const std::vector<std::string> kPredicates = {"robotat", "hasarmposture",
                                                       "hastorsoposture", "holding", "on"};
  return std::find(kPredicates.begin(), kPredicates.end(), base::ToLower(atom.predicate)) !=
         kPredicates.end();
}

std::vector<Atom> AtomsOf(const TranslatorContext& context, const GeometricState& state,
                          const std::vector<Atom>* before) {
  std::vector<Atom> atoms;
  const Area* standing = StandingAt(context.areas, state.robot.X_MB, context.classify,
                                    ValueBefore(before, "robotat", ""));
  if (standing) atoms.push_back({"RobotAt", {standing->name}});
  AddBodyAtoms(context, state, before, &atoms);
  const Body body(*context.robot, state.robot);
  for (const world::ObjectState& object : state.world.objects) {
    const std::string name = base::ToLower(object.name);
    const Area* area = AreaUnder(context, body, object, ValueBefore(before, "on", name));
    if (area) atoms.push_back({"On", {name, area->name}});
  }
  std::sort(atoms.begin(), atoms.end(), [](const Atom& a, const Atom& b) {
    return std::tie(a.predicate, a.arguments) < std::tie(b.predicate, b.arguments);
  });
  return atoms;
}

}  // namespace hires::translation
