#include "cli/verbs/imagine/imagine_start.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

#include "cli/radians.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "imagination/area_file.h"

namespace hires::cli {
namespace {

/// The parts of "a:b" or "a:b:c".
std::vector<std::string> PartsOf(const std::string& option, const std::string& text,
                                 std::size_t most, const std::string& wanted) {
  const std::vector<std::string> parts = base::Split(text, ':');
  const bool is_empty = std::count(parts.begin(), parts.end(), "") > 0;
  if (parts.size() >= 2 && parts.size() <= most && !is_empty) return parts;
  throw base::ConfigError(fmt::format("{} '{}': wanted {}", option, text, wanted));
}

/// Numbers separated by commas, or nothing if there is anything else.
std::vector<double> NumbersIn(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : base::Split(text, ',')) {
    std::size_t used = 0;
    try {
      numbers.push_back(std::stod(part, &used));
    } catch (const std::exception&) {
      return {};
    }
    if (used != part.size() || !std::isfinite(numbers.back())) return {};
  }
  return numbers;
}

/// A name that comes again would be one thing, where two were meant.
void RefuseTwice(const std::vector<std::string>& on_tray) {
  std::set<std::string> seen;
  for (const std::string& object : on_tray) {
    if (seen.insert(base::ToLower(object)).second) continue;
    throw base::ConfigError(fmt::format(
        "--object '{0}': came twice, wanted a name for each thing; one more of its "
        "kind has another number, as mug1 and mug2; of a file, copy it under another name",
        object));
  }
}

constexpr char kPutWanted[] =
    "OBJECT:AREA, OBJECT:AREA:X,Y[,YAW] in the area's frame, or OBJECT:X,Y,Z[,YAW] in the map "
    "[m, rad]";

void ReadPut(const std::string& text, ImagineStart* start) {
  const auto parts = PartsOf("--put", text, 3, kPutWanted);
  const bool is_in_map = parts.size() == 2 && !NumbersIn(parts[1]).empty();
  if (parts.size() == 2 && !is_in_map) {
    if (parts[1].find(',') != std::string::npos) {
      throw base::ConfigError(fmt::format("--put '{}': wanted {}", text, kPutWanted));
    }
    start->atoms.push_back({"On", {parts[0], parts[1]}});
    return;
  }
  const std::vector<double> numbers = NumbersIn(parts.back());
  const std::size_t least = is_in_map ? 3 : 2;
  if (numbers.size() != least && numbers.size() != least + 1) {
    throw base::ConfigError(fmt::format("--put '{}': wanted {}", text, kPutWanted));
  }
  if (is_in_map && numbers[2] < 0.0) {
    throw base::ConfigError(
        fmt::format("--put '{}': z is {:g} m, which is below the floor; give the height of what it "
                    "stands on, 0 "
                    "on the floor",
                    text, numbers[2]));
  }
  imagination::PutObject put;
  put.object = parts[0];
  if (!is_in_map) put.area = parts[1];
  const double yaw = numbers.size() > least ? numbers.back() : 0.0;
  RefuseDegrees("--put", text, yaw);
  put.X_AO = geometry::Lift({numbers[0], numbers[1], yaw}, is_in_map ? numbers[2] : 0.0);
  start->put.push_back(put);
}

void ReadPosture(const std::string& text, ImagineStart* start) {
  const auto parts =
      PartsOf("--posture", text, 2, "ARM:POSTURE or torso1:POSTURE, as rightArm1:ArmToSidePosture");
  const bool is_torso = base::ToLower(parts[0]).rfind("torso", 0) == 0;
  start->atoms.push_back(is_torso ? base::Atom{"HasTorsoPosture", {parts[1]}}
                                  : base::Atom{"HasArmPosture", parts});
}

std::set<std::string> ArmsWithPosture(const ImagineStart& start) {
  std::set<std::string> arms;
  for (const base::Atom& atom : start.atoms) {
    if (atom.predicate == "HasArmPosture") arms.insert(base::ToLower(atom.arguments[0]));
  }
  return arms;
}

void ReadInHand(const std::string& text, const actions::ActionSpec& action, ImagineStart* start) {
  const auto parts = PartsOf("--object-in-hand", text, 2, "OBJECT:ARM, as mug1:rightArm1");
  start->atoms.push_back({"Holding", {parts[1], parts[0]}});
  if (ArmsWithPosture(*start).count(base::ToLower(parts[1])) > 0) return;
  const bool drives = action.detail == actions::Detail::kBase;
  start->atoms.push_back(
      {"HasArmPosture", {parts[1], drives ? "ArmCarryPosture" : "ArmToSidePosture"}});
}

bool IsAreaFile(const std::string& text) {
  const std::filesystem::path path(text);
  const std::string ending = base::ToLower(path.extension().string());
  std::error_code error;
  return ending == ".yaml" || ending == ".yml" || std::filesystem::is_regular_file(path, error);
}

imagination::NamedArea ReadArea(const std::string& text) {
  constexpr char kWanted[] =
      "NAME:x,y,yaw [m, m, rad], as kitchen:3.2,1.0,1.57, or a YAML file of goals";
  const auto parts = PartsOf("--area", text, 2, kWanted);
  const std::vector<double> numbers = NumbersIn(parts[1]);
  if (numbers.size() != 3) {
    throw base::ConfigError(fmt::format("--area '{}': wanted {}", text, kWanted));
  }
  RefuseDegrees("--area", text, numbers[2]);
  return {parts[0], {numbers[0], numbers[1], numbers[2]}};
}

}  // namespace

std::vector<base::Atom> ImagineStart::AllAtoms() const {
  std::vector<base::Atom> all{{"RobotAt", {from}}};
  for (const std::string& object : on_tray) all.push_back({"On", {object, "trayArea1"}});
  all.insert(all.end(), atoms.begin(), atoms.end());
  return all;
}

std::set<std::string> ImagineStart::Objects() const {
  std::set<std::string> objects(on_tray.begin(), on_tray.end());
  for (const imagination::PutObject& one : put) objects.insert(one.object);
  for (const base::Atom& atom : atoms) {
    if (atom.predicate == "On") objects.insert(atom.arguments[0]);
    if (atom.predicate == "Holding") objects.insert(atom.arguments[1]);
  }
  return objects;
}

void RequireObjects(const actions::Catalogue& catalogue,
                    const std::vector<base::ActionCall>& actions, const world::WorldState& world) {
  for (const base::ActionCall& action : actions) {
    const actions::ActionSpec& spec = catalogue.Get(action.name);
    const auto name = actions::ArgumentOf(spec, action, actions::ParameterKind::kObject);
    if (!name) continue;
    const world::ObjectState* object = world.Find(*name);
    if (object == nullptr) {
      throw base::ConfigError(
          fmt::format("{}: {} is nowhere; say where it is, with --put {}:AREA, --object {} (on the "
                      "tray) or --object-in-hand {}:ARM",
                      base::ToString(action), *name, *name, *name, *name));
    }
    const bool is_put = spec.purpose.purpose == actions::Purpose::kPutOnArea ||
                        spec.purpose.purpose == actions::Purpose::kPutOnTray;
    if (is_put && object->attached_to.empty()) {
      throw base::ConfigError(fmt::format("{}: {} is in no hand; wanted --object-in-hand {}:ARM",
                                          base::ToString(action), *name, *name));
    }
  }
}

void RequirePostures(const ImagineStart& start, const robot::Robot& robot) {
  if (robot.profile.upper_body) return;
  for (const base::Atom& atom : start.atoms) {
    if (atom.predicate == "Holding") return;  // brought the posture along, and is refused itself
  }
  for (const base::Atom& atom : start.atoms) {
    if (atom.predicate != "HasArmPosture" && atom.predicate != "HasTorsoPosture") continue;
    throw base::ConfigError(
        fmt::format("--posture {}: robot '{}' has a base alone, no arms and no torso (upper_body "
                    "in its profile); leave --posture out",
                    base::Join(atom.arguments, ":"), robot.model.name));
  }
}

void AddStartOptions(CLI::App* app, StartOptions* o) {
  app->add_option("--from", o->from, "area where the robot stands")->required();
  app->add_option("--object", o->on_tray,
                  "what stands on its tray: instance, model, or file (.sdf, .urdf, .yaml); up to "
                  "three times")
      ->allow_extra_args(false);
  app->add_option("--object-in-hand", o->in_hand,
                  "OBJECT:ARM, what an arm holds, named as for --object: mug1:rightArm1")
      ->allow_extra_args(false);
  app->add_option("--posture", o->postures,
                  "ARM:POSTURE or torso1:POSTURE; the driving posture where none is given")
      ->allow_extra_args(false);
  app->add_option("--put", o->put,
                  std::string("what stands about, named as for --object: ") + kPutWanted)
      ->allow_extra_args(false);
}

std::vector<imagination::NamedArea> ReadAreas(const std::vector<std::string>& texts) {
  std::vector<imagination::NamedArea> areas;
  for (const std::string& text : texts) {
    if (!IsAreaFile(text)) {
      areas.push_back(ReadArea(text));
      continue;
    }
    const auto more = imagination::ReadAreaFile(text);
    areas.insert(areas.end(), more.begin(), more.end());
  }
  return areas;
}

std::vector<std::string> AreaFilesOf(const std::vector<std::string>& texts) {
  std::vector<std::string> files;
  std::copy_if(texts.begin(), texts.end(), std::back_inserter(files), IsAreaFile);
  return files;
}

void AddAreaOption(CLI::App* app, std::vector<std::string>* areas) {
  app->add_option("--area,--areas", *areas,
                  "one more area, NAME:x,y,yaw [m, m, rad], or a YAML file of goals or waypoints; "
                  "may be repeated")
      ->allow_extra_args(false);
}

ImagineStart ReadStart(const StartOptions& options, const std::string& action,
                       const actions::Catalogue& catalogue) {
  ImagineStart start;
  start.from = options.from;
  RefuseTwice(options.on_tray);
  start.on_tray = options.on_tray;
  for (const std::string& posture : options.postures) ReadPosture(posture, &start);
  for (const std::string& held : options.in_hand) {
    ReadInHand(held, catalogue.Get(action), &start);
  }
  for (const std::string& put : options.put) ReadPut(put, &start);
  return start;
}

}  // namespace hires::cli
