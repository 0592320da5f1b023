#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "robot/assumptions.h"
#include "robot/drive_guess.h"
#include "robot/profile/bare_robot.h"
#include "robot/urdf/urdf_file.h"

namespace hires::robot {
namespace {

namespace fs = std::filesystem;

/// In quotes, as names may hold what means something in YAML.
std::string InQuotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + '"';
}

/// To 0.1 mm, below which lengths in comments say nothing.
double Rounded(double length) {
  return std::round(length * 1e4) / 1e4 + 0.0;  // no -0
}

/// Lines of YAML, each with what it means behind it.
class LineWriter {
 public:
  void Add(const std::string& line, const std::string& comment) {
    std::string plain = comment;
    std::replace_if(
        plain.begin(), plain.end(), [](unsigned char c) { return c < ' '; }, ' ');
    text_ +=
        line.empty() ? fmt::format("# {}\n", plain) : fmt::format("{:<34} # {}\n", line, plain);
  }
  /// The same as a comment: what nobody has said of the robot does not stand in its profile.
  void AddAssumed(const std::string& line, const std::string& comment) {
    Add("# " + line, comment);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// The root of the URDF; StandOnFloor may have put one below it.
std::string RootOf(const Robot& robot) {
  const auto& links = robot.model.links;
  const bool is_added = robot.base_height > 0.0 && links.front().name == robot.profile.base_link;
  return links[is_added && links.size() > 1 ? 1 : 0].name;
}

std::string FootprintComment(const geometry::Polygon& footprint) {
  std::vector<std::string> corners;
  for (const Eigen::Vector2d& p : footprint)
    corners.push_back(fmt::format("{{x: {:.4g}, y: {:.4g}}}", Rounded(p.x()), Rounded(p.y())));
  return fmt::format(
      "[m] empty: the outline from above of all shapes up to 2 m over the floor, which is [{}]",
      base::Join(corners, ", "));
}

/// What no shape says is a line to be filled in: as long as it is empty, the robot is refused.
void AddFootprint(const geometry::Polygon& footprint, const std::string& urdf, LineWriter* out) {
  if (!footprint.empty()) {
    out->AddAssumed("footprint: []", FootprintComment(footprint));
    return;
  }
  out->Add("footprint: []",
           "[m] FILL IN, as no <collision> of the URDF says it: its corners from above, x forward, "
           "y left, as in [[0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2], [0.3, -0.2]]");
  base::Log(base::LogLevel::kWarn,
            fmt::format("urdf={} no collision shape says how large the robot is; fill in its "
                        "profile's line `footprint`, without which it cannot be loaded",
                        urdf));
}

void AddMotionSet(const std::string& indent, const MotionSet& set, LineWriter* out) {
  const auto line = [&](const char* key, double value, const char* unit) {
    out->AddAssumed(fmt::format("{}{}: {}", indent, key, value), unit);
  };
  line("max_linear_velocity", set.max_linear_velocity, "[m/s] a PR2's");
  line("max_angular_velocity", set.max_angular_velocity, "[rad/s] a PR2's");
  line("max_linear_acceleration", set.max_linear_acceleration, "[m/s^2] a PR2's");
  line("max_angular_acceleration", set.max_angular_acceleration, "[rad/s^2] a PR2's");
}

void AddTray(const RobotProfile& profile, LineWriter* out) {
  out->AddAssumed(
      "tray_link: " + InQuotes(profile.tray_link),
      profile.tray_link.empty()
          ? "link that carries loose objects; no link with a shape has \"tray\" in its name"
          : "link that carries loose objects, by its name");
  if (profile.tray_link.empty()) return;
  const Eigen::Vector3d& p = profile.X_TO.translation;
  out->Add(fmt::format("# object_on_tray: {{xyz: [{:.4g}, {:.4g}, {:.4g}], rpy: [0, 0, 0]}}",
                       Rounded(p.x()), Rounded(p.y()), Rounded(p.z())),
           "where things stand, in that link's frame; left out: the middle of its top, or of the "
           "largest part of it that is free, which is this");
}

void AddLaser(const Robot& robot, const std::string& xml, LineWriter* out) {
  const std::vector<std::string> links = LaserLinks(robot, xml);
  out->AddAssumed("laser_link: " + InQuotes(links.empty() ? "" : links.front()),
                  links.empty()
                      ? "link of a planar laser; none is known, so it drives by the map alone"
                      : "link of a planar laser, which it does not drive by as long as none is "
                        "named; by sensor or name it may be: " +
                            base::Join(links, ", "));
}

void AddController(const Robot& robot, LineWriter* out) {
  const BaseControllerParams& params = robot.profile.base_controller;
  const auto line = [&](const char* key, double value, const char* comment) {
    out->AddAssumed(fmt::format("  {}: {}", key, value), comment);
  };
  out->AddAssumed("base_controller:", "how the base follows commands");
  out->AddAssumed("  drive: " + ToString(params.drive),
                  "omnidirectional, differential or car_like; guessed from " +
                      GuessDrive(robot.model, robot.profile.base_link).why);
  if (params.drive == Drive::kCarLike)
    line("min_turning_radius", params.min_turning_radius, "[m] guessed from its wheels");
  out->AddAssumed("  limits:", "what it can do at most");
  AddMotionSet("    ", params.limits, out);
  line("command_timeout", params.command_timeout, "[s] without commands until it brakes");
  out->AddAssumed(fmt::format("  at_timeout: {}", params.stops_at_timeout ? "stop" : "ramp"),
                  "ramp: as for a command to stand; stop: at once");
  line("max_linear_jerk", params.max_linear_jerk, "[m/s^3] 0: acceleration may jump");
  line("command_lag", params.command_lag, "[s] from a command to its effect");
  line("loop_frequency", params.loop_frequency, "[rad/s] of the velocity loop; 0: follows exactly");
  line("loop_damping", params.loop_damping, "its damping ratio");
  line("sway_compliance", params.sway_compliance, "[rad s^2/m] how far it leans per acceleration");
  line("sway_frequency", params.sway_frequency, "[rad/s] of that leaning");
  line("sway_damping", params.sway_damping, "its damping ratio");
}

void AddJoints(const Robot& robot, LineWriter* out) {
  const std::vector<std::string> names = robot.model.JointNames();
  out->Add("joints: {}",
           names.empty()
               ? "posture while driving; nothing moves but the base"
               : fmt::format("posture while driving; joints that are not named stand at 0, or at "
                             "the limit next to it; there are {}",
                             base::Join(names, ", ")));
}

}  // namespace

std::string WriteProfile(const std::string& path, const std::string& folder) {
  UrdfFile file = SplitArguments(path);
  const std::string xml = ReadUrdfFile(file);
  const Robot robot = LoadRobotToDescribe(file, xml);
  const RobotProfile& profile = robot.profile;
  file.path = fs::proximate(fs::absolute(file.path), fs::absolute(folder.empty() ? "." : folder))
                  .generic_string();
  LineWriter out;
  out.Add("", "Robot " + InQuotes(robot.model.name) +
                  ", written from its URDF. Lines that begin with '#' are what that does not say: "
                  "ASSUMED,");
  out.Add("", "as answers tell until they are corrected and the '#' is taken away.");
  out.Add("", "docs/tutorial.md, \"Your own robot\", says more.");
  out.Add("urdf: " + InQuotes(TextOf(file)), "as seen from the folder of this file");
  out.AddAssumed(
      "base_link: " + InQuotes(RootOf(robot)),
      robot.base_height > 0.0
          ? fmt::format("the base; it is {:.3f} m over the floor, as its shapes reach so deep",
                        robot.base_height)
          : "the base, which is taken to lie on the floor");
  AddTray(profile, &out);
  AddLaser(robot, xml, &out);
  AddFootprint(profile.footprint, path, &out);
  out.Add(fmt::format("footprint_padding: {}", profile.footprint_padding),
          "[m] kept round the footprint");
  out.AddAssumed("motion_sets:", "how fast actions may drive, by the name that they give");
  for (const auto& [name, set] : profile.motion_sets) {
    out.AddAssumed("  " + InQuotes(name) + ":", "`--arg " + name + "`");
    AddMotionSet("    ", set, &out);
  }
  out.AddAssumed("default_motion_set: " + InQuotes(profile.default_motion_set),
                 "for actions that name none");
  AddController(robot, &out);
  AddJoints(robot, &out);
  return out.text();
}

}  // namespace hires::robot
