#include "hires/actions/catalogue.h"

namespace hires::actions {
namespace {

using base::Atom;
using Code = base::FailureCode;
using Kind = ParameterKind;
using Names = std::set<std::string>;

Parameter Area() { return {"area", Kind::kArea}; }
Parameter Arm() { return {"arm", Kind::kArm}; }
Parameter Object() { return {"object", Kind::kObject}; }

ActionSpec Drive(const std::string& name, std::vector<Parameter> parameters, Driving driving,
                 std::vector<Code> failures) {
  ActionSpec spec;
  spec.name = name;
  spec.parameters = std::move(parameters);
  spec.groups = {kBaseGroup};
  spec.driving = driving;
  spec.effects = {{"RobotAt", {"?area"}}};
  spec.failures = std::move(failures);
  return spec;
}

ActionSpec Posture(const std::string& name, std::vector<Parameter> parameters, Names groups,
                   std::vector<Atom> effects) {
  ActionSpec spec;
  spec.name = name;
  spec.parameters = std::move(parameters);
  spec.detail = Detail::kUpperBody;
  spec.groups = std::move(groups);
  spec.effects = std::move(effects);
  if (spec.groups.count(kTorsoGroup) == 0) spec.failures = {Code::kNoPath, Code::kStartBlocked};
  return spec;
}

ActionSpec Look(const std::string& name, const Parameter& what, std::vector<Code> failures) {
  ActionSpec spec;
  spec.name = name;
  spec.parameters = {what};
  spec.detail = Detail::kUpperBody;
  spec.groups = {kHeadGroup};
  spec.failures = std::move(failures);
  return spec;
}

/// Who grasps or places looks at it, and base and torso must stand still.
ActionSpec Handle(const std::string& name, std::vector<Parameter> parameters, Purpose purpose,
                  std::vector<Atom> effects, std::vector<Code> failures) {
  ActionSpec spec;
  spec.name = name;
  spec.parameters = std::move(parameters);
  spec.detail = Detail::kUpperBody;
  spec.groups = {kBaseGroup, kTorsoGroup, kHeadGroup, "?arm"};
  spec.purpose = {purpose, "object", "arm", purpose == Purpose::kPutOnArea ? "area" : ""};
  spec.effects = std::move(effects);
  spec.failures = std::move(failures);
  return spec;
}

ActionSpec PickUp(const std::string& name, std::vector<Parameter> parameters) {
  return Handle(name, std::move(parameters), Purpose::kTake, {{"Holding", {"?arm", "?object"}}},
                {Code::kOutOfView, Code::kObjectNotSeen, Code::kUnreachable, Code::kNoPath,
                 Code::kStartBlocked, Code::kHandFull, Code::kObjectHeld, Code::kObjectToppled,
                 Code::kGraspFailed, Code::kObjectSlipped, Code::kUnknownModel});
}

ActionSpec Place(const std::string& name, std::vector<Parameter> parameters, Purpose purpose,
                 const std::string& area) {
  return Handle(name, std::move(parameters), purpose,
                {{"Holding", {"?arm", "nothing"}}, {"On", {"?object", area}}},
                {Code::kObjectSlipped, Code::kAreaOccupied, Code::kUnreachable, Code::kNoPath,
                 Code::kStartBlocked, Code::kOutOfView, Code::kObjectToppled, Code::kObjectNotSeen,
                 Code::kUnknownModel});
}

ActionSpec LookAt() {
  ActionSpec spec = Look("look_at", {"area_or_object", Kind::kAreaOrObject},
                         {Code::kOutOfView, Code::kObjectNotSeen});
  spec.is_operator = false;
  return spec;
}

/// Who looks from another place drives there straight, comes back, and moves the torso to and fro.
ActionSpec ObserveAt() {
  ActionSpec spec =
      Look("observe_objects_at", Area(), {Code::kObjectNotSeen, Code::kOutOfView, Code::kStuck});
  spec.parameters.push_back({"standing_area", Kind::kArea});
  spec.parameters.push_back({"torso", Kind::kTorsoPosture});
  spec.parameters.push_back({"place", Kind::kBasePlace});
  spec.groups = {kBaseGroup, kTorsoGroup, kHeadGroup};
  spec.driving = Driving::kStraight;
  return spec;
}

/// Who looks, and promises that the thermal camera will have told something then.
ActionSpec MeasureTemperature() {
  ActionSpec spec = Look("measure_temperature", Object(), {Code::kOutOfView});
  spec.parameters.push_back(Area());
  spec.effects = {{"TemperatureKnown", {"?object"}}};
  return spec;
}

void AddDriving(Catalogue* catalogue) {
  const std::vector<Code> failures{Code::kStartBlocked, Code::kGoalBlocked, Code::kNoPath,
                                   Code::kNoValidTrajectory, Code::kOscillating};
  catalogue->Add(Drive("move_base", {Area()}, Driving::kRoundObstacles, failures));
  catalogue->Add(Drive("move_base_param", {Area(), {"motion_set", Kind::kMotionSet}},
                       Driving::kRoundObstacles, failures));
  catalogue->Add(Drive("move_base_blind", {Area()}, Driving::kStraight, {Code::kStuck}));
}

void AddPostures(Catalogue* catalogue) {
  catalogue->Add(Posture("move_torso", {{"posture", Kind::kTorsoPosture}}, {kTorsoGroup},
                         {{"HasTorsoPosture", {"?posture"}}}));
  catalogue->Add(Posture("tuck_arms",
                         {{"left_goal", Kind::kArmPosture}, {"right_goal", Kind::kArmPosture}},
                         {"leftarm1", "rightarm1"},
                         {{"HasArmPosture", {"leftarm1", "?left_goal"}},
                          {"HasArmPosture", {"rightarm1", "?right_goal"}}}));
  catalogue->Add(Posture("move_arm_to_side", {Arm()}, {"?arm"},
                         {{"HasArmPosture", {"?arm", "armtosideposture"}}}));
  catalogue->Add(Posture("move_arms_to_carryposture", {}, {"leftarm1", "rightarm1"},
                         {{"HasArmPosture", {"leftarm1", "armcarryposture"}},
                          {"HasArmPosture", {"rightarm1", "armcarryposture"}}}));
}

Catalogue MakeOwnActions() {
  Catalogue catalogue;
  AddDriving(&catalogue);
  AddPostures(&catalogue);
  catalogue.Add(LookAt());
  catalogue.Add(Look("observe_objects_on_area", Area(), {Code::kOutOfView}));
  catalogue.Add(ObserveAt());
  catalogue.Add(MeasureTemperature());
  catalogue.Add(PickUp("pick_up_object", {Object(), Arm()}));
  catalogue.Add(PickUp("pick_up_from_tray", {Arm(), Object()}));
  catalogue.Add(Place("place_object", {Object(), Arm(), Area()}, Purpose::kPutOnArea, "?area"));
  catalogue.Add(Place("place_object_at", {Object(), Arm(), Area(), {"spot", Kind::kSpot}},
                      Purpose::kPutOnArea, "?area"));
  catalogue.Add(Place("place_on_tray", {Arm(), Object()}, Purpose::kPutOnTray, "trayarea1"));
  return catalogue;
}

}  // namespace

const Catalogue& OwnActions() {
  static const Catalogue catalogue = MakeOwnActions();
  return catalogue;
}

}  // namespace hires::actions
