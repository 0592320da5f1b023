#include "reports/limits/given_limits.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::reports {
namespace {

constexpr double kLeastGiven = 0.01;  // [m/s], [m/s^2], [rad/s], [rad/s^2]
constexpr int kDeepest = 16;          // maps in one another
constexpr std::size_t kMostNamed = 12;

/// What a key limits, along one axis, or of x, y and theta in a list. v: in the plane.
const std::map<std::string, std::vector<std::string>> kQuantities{
    {"max_vel_trans", {"v"}},
    {"max_trans_vel", {"v"}},
    {"max_speed_xy", {"v"}},
    {"max_vel_x", {"vx"}},
    {"min_vel_x", {"vx"}},
    {"max_vel_x_backwards", {"vx"}},
    {"max_vel_y", {"vy"}},
    {"min_vel_y", {"vy"}},
    {"max_vel_theta", {"wz"}},
    {"max_rot_vel", {"wz"}},
    {"max_rotational_vel", {"wz"}},
    {"acc_lim_x", {"ax"}},
    {"acc_lim_y", {"ay"}},
    {"acc_lim_theta", {"aw"}},
    {"acc_lim_th", {"aw"}},
    {"decel_lim_x", {"dx"}},
    {"decel_lim_y", {"dy"}},
    {"decel_lim_theta", {"dw"}},
    {"max_velocity", {"vx", "vy", "wz"}},
    {"min_velocity", {"vx", "vy", "wz"}},
    {"max_accel", {"ax", "ay", "aw"}},
    {"max_decel", {"dx", "dy", "dw"}}};

enum Kind { kRos1, kSmoother, kController };  // the first one overrides the others

/// Limits of one map of the file.
struct Section {
  Kind kind{kRos1};
  std::string name;
  std::map<std::string, double> limits;  // by quantity, without signs
  std::vector<std::string> keys;
};

/// "DWAPlannerROS: max_vel_x, acc_lim_x"
std::string TextOf(const std::string& section, std::vector<std::string> keys) {
  const std::size_t num_keys = keys.size();
  keys.resize(std::min(num_keys, kMostNamed));
  if (num_keys > kMostNamed) keys.push_back(fmt::format("{} more", num_keys - kMostNamed));
  return (section.empty() ? "" : section + ": ") + base::Join(keys, ", ");
}

/// What a file holds.
struct Sections {
  std::string path;
  std::vector<Section> known;
  std::vector<std::string> unused, errors;

  void Read(const YAML::Node& node, const std::string& name, int depth) {
    if (!node.IsMap() || depth > kDeepest) return;
    const bool is_ros2 = name.find("ros__parameters") != std::string::npos;
    Section scalars{is_ros2 ? kController : kRos1, name, {}, {}}, lists{kSmoother, name, {}, {}};
    std::vector<std::string> unknown;
    for (const auto& entry : node) {
      const auto key = entry.first.as<std::string>();
      const auto quantities = kQuantities.find(key);
      if (entry.second.IsMap()) {
        Read(entry.second, name.empty() ? key : name + "." + key, depth + 1);
      } else if (quantities == kQuantities.end()) {
        unknown.push_back(key);
      } else {
        ReadLimit(key, entry.second, quantities->second,
                  quantities->second.size() > 1 ? &lists : &scalars);
      }
    }
    if (!unknown.empty()) unused.push_back(TextOf(name, unknown));
    for (Section* section : {&scalars, &lists}) {
      if (!section->keys.empty()) known.push_back(std::move(*section));
    }
  }

  void ReadLimit(const std::string& key, const YAML::Node& node,
                 const std::vector<std::string>& quantities, Section* section) {
    section->keys.push_back(key);
    std::vector<double> values;
    try {
      values = node.IsSequence() ? node.as<std::vector<double>>() : std::vector{node.as<double>()};
    } catch (const YAML::Exception&) {
      values.clear();
    }
    if (values.size() != quantities.size() ||
        !std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
      errors.push_back(fmt::format(
          "{}:{}: {} is {}; expected {}", path, node.Mark().line + 1, TextOf(section->name, {key}),
          YAML::Dump(node),
          quantities.size() > 1 ? "a list of 3 numbers (x, y, theta)" : "a finite number"));
      return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      double& limit = section->limits[quantities[i]];
      limit = std::max(limit, std::abs(values[i]));
    }
  }
};

std::map<std::string, double> InThePlane(const std::map<std::string, double>& limits,
                                         bool is_omnidirectional) {
  std::map<std::string, double> values;
  const auto add = [&](const char* x, const char* y, const char* to) {
    if (limits.count(x) == 0) return;
    const bool adds_y = is_omnidirectional && limits.count(y) > 0;
    values[to] = adds_y ? std::hypot(limits.at(x), limits.at(y)) : limits.at(x);
  };
  add("vx", "vy", "speed");
  if (limits.count("v") > 0) {
    const double v = limits.at("v");
    values["speed"] = values.count("speed") > 0 ? std::min(v, values["speed"]) : v;
  }
  add("ax", "ay", "acceleration");
  add("ax", "ay", "deceleration");
  add("dx", "dy", "deceleration");
  add("wz", "", "turning");
  add("aw", "", "angular_acceleration");
  return values;
}

}  // namespace

GivenLimits ReadGivenLimits(const std::string& path, bool is_omnidirectional) {
  Sections file{path, {}, {}, {}};
  try {
    file.Read(YAML::Load(base::ReadTextFile(path)), "", 0);
  } catch (const YAML::Exception& error) {
    file.errors.push_back(
        fmt::format("{}:{}: not valid YAML: {}", path, error.mark.line + 1, error.msg));
  }
  if (file.known.empty() && file.errors.empty()) {
    file.errors.push_back(fmt::format(
        "{}: no limits found; expected max_vel_x, acc_lim_x, ... of DWAPlannerROS or "
        "TebLocalPlannerROS, or max_velocity, max_accel, ... of Nav2's velocity_smoother; found {}",
        path, file.unused.empty() ? "no keys" : TextOf("", file.unused)));
  }
  if (!file.errors.empty()) throw base::ConfigError(base::Join(file.errors, "\n"));
  std::stable_sort(file.known.begin(), file.known.end(),
                   [](const Section& a, const Section& b) { return a.kind < b.kind; });
  GivenLimits given;
  std::map<std::string, double> limits;
  std::set<Kind> used_kinds;
  for (const Section& section : file.known) {
    // Nav2's smoother and controller complete each other; all else is overridden.
    const bool is_used = used_kinds.count(kRos1) == 0 && used_kinds.insert(section.kind).second;
    if (is_used) limits.insert(section.limits.begin(), section.limits.end());
    (is_used ? given.used : given.unused).push_back(TextOf(section.name, section.keys));
  }
  given.unused.insert(given.unused.end(), file.unused.begin(), file.unused.end());
  given.values = InThePlane(limits, is_omnidirectional);
  for (const auto& [name, value] : given.values) {
    if (value >= kLeastGiven) continue;
    file.errors.push_back(fmt::format("{}: the limit of {} is {:g}; expected at least {:g}", path,
                                      name, value, kLeastGiven));
  }
  if (!file.errors.empty()) throw base::ConfigError(base::Join(file.errors, "\n"));
  return given;
}

}  // namespace hires::reports
