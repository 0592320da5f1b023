#include "translation/wanted_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/link_bounds.h"
#include "translation/body.h"

namespace hires::translation {
namespace {

using base::Atom;
using base::ConfigError;

[[noreturn]] void Refuse(const Atom& atom, const std::string& what) {
  throw ConfigError(fmt::format("{}: {}", base::ToString(atom), what));
}

/// Sets a value once; the same value again does no harm.
void SetOnce(const Atom& atom, const std::string& value, const std::string& of_what,
             std::string* target) {
  if (!target->empty() && *target != value) {
    Refuse(atom, fmt::format("contradicts what another atom says of {}: '{}'", of_what, *target));
  }
  *target = value;
}

/// Reads one atom at a time.
class Reader {
 public:
  explicit Reader(const TranslatorContext& context) : context_(context) {}

  void Read(const Atom& atom) {
    static const std::map<std::string, std::pair<std::size_t, void (Reader::*)(const Atom&)>>
        kReaders = {{"robotat", {1, &Reader::ReadRobotAt}},
                    {"hasarmposture", {2, &Reader::ReadArmPosture}},
                    {"hastorsoposture", {1, &Reader::ReadTorsoPosture}},
                    {"holding", {2, &Reader::ReadHolding}},
                    {"on", {2, &Reader::ReadOn}}};
    const auto reader = kReaders.find(base::ToLower(atom.predicate));
    if (reader == kReaders.end()) return RequirePassedOver(atom);
    const auto& [num_arguments, read] = reader->second;
    if (atom.arguments.size() != num_arguments) {
      Refuse(atom, fmt::format("has {} argument{}, wanted {}", atom.arguments.size(),
                               atom.arguments.size() == 1 ? "" : "s", num_arguments));
    }
    (this->*read)(atom);
  }

  WantedState Finish() {
    if (wanted_.robot_area.empty()) {
      throw ConfigError("RobotAt(area) is missing; say where the robot stands");
    }
    for (const auto& [object, arm] : wanted_.holders) {
      const auto place = wanted_.places.find(object);
      if (place == wanted_.places.end()) continue;
      throw ConfigError(
          fmt::format("On({}, {}): contradicts Holding({}, {}); an object has one "
                      "place",
                      object, place->second, arm, object));
    }
    return std::move(wanted_);
  }

 private:
  static std::string Argument(const Atom& atom, std::size_t index) {
    return base::ToLower(atom.arguments[index]);
  }

  /// What follows from knowledge, and wishes, have no place.
  static void RequirePassedOver(const Atom& atom) {
    static const std::vector<std::string> kKnown = {"RobotAt",
                                                    "HasArmPosture",
                                                    "HasTorsoPosture",
                                                    "Holding",
                                                    "On",
                                                    "Type",
                                                    "Instance",
                                                    "At",
                                                    "HasTemperature",
                                                    "TemperatureKnown",
                                                    "Connected",
                                                    "hasPlacingArea",
                                                    "hasPlacingAreaLeft",
                                                    "hasPlacingAreaRight",
                                                    "hasManipulationArea",
                                                    "hasPreManipulationArea",
                                                    "hasSittingArea",
                                                    "imagine",
                                                    "observe",
                                                    "imagined_failure"};
    const std::string predicate = base::ToLower(atom.predicate);
    const bool is_known = std::any_of(kKnown.begin(), kKnown.end(), [&](const std::string& name) {
      return base::ToLower(name) == predicate;
    });
    if (!is_known) Refuse(atom, base::UnknownName("predicate", atom.predicate, kKnown));
  }

  const Area& RequireArea(const Atom& atom, std::size_t index) const {
    const Area* area = context_.areas.Find(atom.arguments[index]);
    if (area) return *area;
    std::vector<std::string> known;
    for (const Area& one : context_.areas.all) known.push_back(one.name);
    Refuse(atom, base::UnknownName("area", atom.arguments[index], known));
  }

  /// Null for a robot without arms, which takes postures for granted.
  const robot::ArmProfile* RequireArm(const Atom& atom) const {
    const auto& body = context_.robot->profile.upper_body;
    if (!body) return nullptr;
    const auto arm = body->arms.find(Argument(atom, 0));
    if (arm != body->arms.end()) return &arm->second;
    std::vector<std::string> known;
    for (const auto& [name, unused] : body->arms) known.push_back(name);
    Refuse(atom, base::UnknownName("arm", atom.arguments[0], known));
  }

  void ReadRobotAt(const Atom& atom) {
    const Area& area = RequireArea(atom, 0);
    if (area.kind != AreaKind::kStanding && area.kind != AreaKind::kRoom) {
      Refuse(atom, "is no area for the robot's base; name one that it can stand on");
    }
    SetOnce(atom, area.name, "the robot's place", &wanted_.robot_area);
  }

  void ReadArmPosture(const Atom& atom) {
    const robot::ArmProfile* arm = RequireArm(atom);
    const std::string posture = Argument(atom, 1);
    if (arm && !ArmJointsFor(*context_.robot, *arm, posture, false)) {
      std::vector<std::string> known = {kUnnamedArmPosture};
      for (const auto& [name, unused] : arm->postures) known.push_back(name);
      Refuse(atom, base::UnknownName("arm posture", atom.arguments[1], known));
    }
    SetOnce(atom, posture, "this arm", &wanted_.arm_postures[Argument(atom, 0)]);
  }

  void ReadTorsoPosture(const Atom& atom) {
    const auto& body = context_.robot->profile.upper_body;
    if (body && !TorsoHeightFor(*body, Argument(atom, 0))) {
      std::vector<std::string> known = {kUnnamedTorsoPosture};
      for (const auto& [name, unused] : body->torso_postures) known.push_back(name);
      Refuse(atom, base::UnknownName("torso posture", atom.arguments[0], known));
    }
    SetOnce(atom, Argument(atom, 0), "the torso", &wanted_.torso_posture);
  }

  void RequireModel(const Atom& atom, std::size_t index) const {
    try {
      context_.ModelOf(atom.arguments[index]);
    } catch (const ConfigError& error) {
      Refuse(atom, error.what());
    }
  }

  void ReadHolding(const Atom& atom) {
    const robot::ArmProfile* arm = RequireArm(atom);
    SetOnce(atom, Argument(atom, 1), "this hand", &hands_[Argument(atom, 0)]);
    if (Argument(atom, 1) == "nothing") return;
    if (arm == nullptr) Refuse(atom, "the robot has no arms (upper_body in its profile)");
    RequireModel(atom, 1);
    SetOnce(atom, Argument(atom, 0), "who holds this object", &wanted_.holders[Argument(atom, 1)]);
  }

  void ReadOn(const Atom& atom) {
    RequireModel(atom, 0);
    if (Argument(atom, 1) == kTrayArea && !context_.areas.Find(kTrayArea)) {
      Refuse(atom, robot::NoTrayText(*context_.robot));
    }
    const Area& area = RequireArea(atom, 1);
    if (area.kind == AreaKind::kSeat || area.kind == AreaKind::kRoom) {
      Refuse(atom, "is no area to put things on; name a placing area");
    }
    SetOnce(atom, area.name, "this object's place", &wanted_.places[Argument(atom, 0)]);
  }

  const TranslatorContext& context_;
  WantedState wanted_;
  std::map<std::string, std::string> hands_;  // arm -> object or nothing
};

}  // namespace

WantedState ReadWanted(const TranslatorContext& context, const std::vector<Atom>& atoms) {
  Reader reader(context);
  for (const Atom& atom : atoms) reader.Read(atom);
  return reader.Finish();
}

}  // namespace hires::translation
