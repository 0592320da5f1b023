#include "hires/robot/robot_profile.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/log.h"
#include "hires/base/param_reader.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "hires/robot/link_bounds.h"
#include "robot/assumptions.h"
#include "robot/base_height.h"
#include "robot/drive_guess.h"
#include "robot/extra_sensors_reader.h"
#include "robot/profile/bare_robot.h"
#include "robot/tray_place.h"
#include "robot/upper_body_reader.h"
#include "robot/urdf/read_urdf.h"
#include "robot/urdf/urdf_file.h"

namespace hires::robot {
namespace {

using base::Between;
using base::ParamReader;
using geometry::Pose3;

constexpr double kLeastDeceleration = 0.001;  // [m/s^2], [rad/s^2]
constexpr double kWidestRobot = 10.0;  // [m] a larger one is asked about its units

MotionSet ReadMotionSet(ParamReader in) {
  in.RequireKeys({"max_linear_velocity", "max_angular_velocity", "max_linear_acceleration",
                  "max_angular_acceleration"});  // all that are missing at once
  MotionSet set;
  set.max_linear_velocity = in.Get("max_linear_velocity", Between(0.0, 100.0));
  set.max_angular_velocity = in.Get("max_angular_velocity", Between(0.0, 100.0));
  set.max_linear_acceleration = in.Get("max_linear_acceleration", Between(0.0, 1000.0));
  set.max_angular_acceleration = in.Get("max_angular_acceleration", Between(0.0, 1000.0));
  const auto read = [&in](const char* key, double* value) {
    if (in.Has(key)) *value = in.Get(key, Between(kLeastDeceleration, 1000.0));
  };
  read("max_linear_deceleration", &set.max_linear_deceleration);
  read("max_angular_deceleration", &set.max_angular_deceleration);
  return set;
}

std::map<std::string, MotionSet> ReadMotionSets(ParamReader in) {
  std::map<std::string, MotionSet> sets;
  for (const std::string& key : in.Keys()) {
    if (!sets.emplace(base::ToLower(key), ReadMotionSet(in.Sub(key))).second) {
      in.Fail(key, "wanted names that differ in more than case; rename one");
    }
  }
  return sets;
}

void ReadDrive(ParamReader* in, BaseControllerParams* params) {
  params->drive = DriveOf(
      in->Get("drive", base::OneOf({ToString(Drive::kOmnidirectional),
                                    ToString(Drive::kDifferential), ToString(Drive::kCarLike)})));
  if (params->drive == Drive::kCarLike) {
    in->RequireKeys({"min_turning_radius"});
    params->min_turning_radius = in->Get("min_turning_radius", Between(0.01, 1000.0));
  } else if (in->Has("min_turning_radius")) {
    in->Fail(
        "min_turning_radius",
        fmt::format("wanted none where the drive is {}, which turns on the spot; leave it out, "
                    "or write `drive: car_like`",
                    ToString(params->drive)));
  }
}

CasterParams ReadCasters(ParamReader in) {
  CasterParams params;
  params.version = in.Get("version", Between(1, 2));
  params.at = in.Get("at", Between(0.01, 10.0));
  params.track = in.Get("track", Between(0.001, 10.0));
  params.wheel_radius = in.Get("wheel_radius", Between(0.005, 1.0));
  params.wheel_inertia = in.Get("wheel_inertia", Between(0.0, 100.0));
  params.wheel_effort = in.Get("wheel_effort", Between(0.01, 1e4));
  params.wheel_damping = in.Get("wheel_damping", Between(0.0, 100.0));
  params.steering_inertia = in.Get("steering_inertia", Between(0.001, 100.0));
  params.steering_effort = in.Get("steering_effort", Between(0.01, 1e4));
  params.steering_speed = in.Get("steering_speed", Between(0.1, 1e3));
  params.steering_damping = in.Get("steering_damping", Between(0.0, 100.0));
  params.mass = in.Get("mass", Between(0.1, 1e5));
  params.yaw_inertia = in.Get("yaw_inertia", Between(0.001, 1e5));
  params.grip = in.Get("grip", Between(0.01, 100.0));
  return params;
}

/// Casters have a controller of their own, so keys of the simpler velocity loop would go unheard.
void RefuseLoopBesideCasters(const ParamReader& in, const BaseControllerParams& params) {
  for (const char* key : {"loop_frequency", "loop_damping", "max_linear_jerk"}) {
    if (!in.Has(key)) continue;
    in.Fail(key,
            "wanted none beside `casters`, whose published controller knows none; leave it out");
  }
  if (params.drive != Drive::kOmnidirectional) {
    in.Fail("casters", fmt::format("wanted none where the drive is {}: four steered casters drive "
                                   "sideways, too; leave them out, or write `drive: {}`",
                                   ToString(params.drive), ToString(Drive::kOmnidirectional)));
  }
}

/// @param params  what holds where the file says nothing.
BaseControllerParams ReadBaseController(BaseControllerParams params, ParamReader in) {
  if (in.Has("drive")) ReadDrive(&in, &params);
  if (!in.Has("drive") && in.Has("min_turning_radius")) {
    in.Fail("min_turning_radius", "wanted `drive: car_like` beside it; add that");
  }
  if (in.Has("limits")) params.limits = ReadMotionSet(in.Sub("limits"));
  if (in.Has("at_timeout")) {
    params.stops_at_timeout = in.Get("at_timeout", base::OneOf({"ramp", "stop"})) == "stop";
  }
  const auto read = [&in](const char* key, const base::Bound<double>& bound, double* value) {
    if (in.Has(key)) *value = in.Get(key, bound);
  };
  read("command_timeout", Between(0.001, 60.0), &params.command_timeout);
  read("max_linear_jerk", Between(0.0, 1e6), &params.max_linear_jerk);
  read("emergency_deceleration", Between(kLeastDeceleration, 1000.0),
       &params.emergency_deceleration);
  if (params.emergency_deceleration > 0.0 && params.stops_at_timeout) {
    in.Fail("emergency_deceleration",
            "expected none with `at_timeout: stop`, which stops at once; write `at_timeout: ramp`, "
            "or leave it out");
  }
  read("command_lag", Between(0.0, 10.0), &params.command_lag);
  read("loop_frequency", Between(0.0, 1e4), &params.loop_frequency);
  read("loop_damping", Between(0.0, 100.0), &params.loop_damping);
  read("sway_compliance", Between(0.0, 0.1), &params.sway_compliance);
  read("sway_frequency", Between(0.1, 200.0), &params.sway_frequency);
  read("sway_damping", Between(0.0, 10.0), &params.sway_damping);
  if (in.Has("casters")) {
    params.casters = ReadCasters(in.Sub("casters"));
    RefuseLoopBesideCasters(in, params);
  }
  return params;
}

Pose3 ReadPose(ParamReader in) {
  const std::vector<double> xyz = in.GetNumbers("xyz", 3);
  const std::vector<double> rpy =
      in.Has("rpy") ? in.GetNumbers("rpy", 3) : std::vector<double>{0.0, 0.0, 0.0};
  return {{xyz[0], xyz[1], xyz[2]}, geometry::RotationFromRpy(rpy[0], rpy[1], rpy[2])};
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool SpanAnArea(const geometry::Polygon& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    for (std::size_t j = 1; j < i; ++j) {
      if (std::abs(Cross(corners[i] - corners[0], corners[j] - corners[0])) > 1e-9) return true;
    }
  }
  return false;
}

/// As `{x: .., y: ..}`, or in pairs as move_base's parameter of the same name has them.
geometry::Polygon ReadCorners(ParamReader* in) {
  geometry::Polygon corners;
  if (const auto pairs = in->FindPairs("footprint", Between(-100.0, 100.0))) {
    for (const auto& [x, y] : *pairs) corners.emplace_back(x, y);
    return corners;
  }
  for (ParamReader& corner : in->SubList("footprint")) {
    const double x = corner.Get("x", Between(-100.0, 100.0));
    corners.emplace_back(x, corner.Get("y", Between(-100.0, 100.0)));
  }
  return corners;
}

/// Corners in either direction of turning; an empty list stands for "from the shapes".
geometry::Polygon ReadFootprint(ParamReader* in) {
  const geometry::Polygon corners = ReadCorners(in);
  if (corners.empty()) return corners;
  if (!SpanAnArea(corners)) {
    in->Fail("footprint", "wanted at least three corners that do not lie on one line");
  }
  const geometry::Polygon hull = geometry::ConvexHull(corners);
  if (hull.size() != corners.size()) {
    in->Fail("footprint", fmt::format("wanted a convex outline; only {} of its {} corners are "
                                      "corners of its hull, leave out the others",
                                      hull.size(), corners.size()));
  }
  return hull;
}

JointPositions ReadJoints(ParamReader in) {
  JointPositions joints;
  for (const std::string& name : in.Keys()) joints[name] = in.Get(name, Between(-1e3, 1e3));
  return joints;
}

/// The largest of each limit: a controller that lets every motion set pass.
MotionSet LargestOf(const std::map<std::string, MotionSet>& sets) {
  MotionSet largest{0.0, 0.0, 0.0, 0.0};
  for (const auto& [name, set] : sets) {
    largest = {std::max(largest.max_linear_velocity, set.max_linear_velocity),
               std::max(largest.max_angular_velocity, set.max_angular_velocity),
               std::max(largest.max_linear_acceleration, set.max_linear_acceleration),
               std::max(largest.max_angular_acceleration, set.max_angular_acceleration)};
  }
  double linear = 0.0, angular = 0.0;
  bool is_linear_given = false, is_angular_given = false;
  for (const auto& [name, set] : sets) {
    linear = std::max(linear, set.linear_deceleration());
    angular = std::max(angular, set.angular_deceleration());
    is_linear_given = is_linear_given || set.max_linear_deceleration > 0.0;
    is_angular_given = is_angular_given || set.max_angular_deceleration > 0.0;
  }
  if (is_linear_given) largest.max_linear_deceleration = linear;
  if (is_angular_given) largest.max_angular_deceleration = angular;
  return largest;
}

/// Decelerations in parameters of navigation, at any depth: `decel_lim_x` and `decel_lim_theta`
/// (Nav2, dwb_core), x and theta of `max_decel` (Nav2, velocity smoother). The smallest counts where
/// there are several: the base brakes no harder than each allows.
void FindDecelerations(const YAML::Node& node, const std::string& path, MotionSet* found) {
  if (!node.IsMap()) return;
  const auto take = [&path](const std::string& key, const YAML::Node& value, double* least) {
    const double size = std::abs(value.as<double>(0.0));
    if (!(size >= kLeastDeceleration)) {
      throw base::ConfigError(
          fmt::format("{}: {} in line {} is '{}', expected a deceleration other than 0, e.g. -2.5",
                      path, key, value.Mark().line + 1, value.as<std::string>("no number")));
    }
    *least = *least > 0.0 ? std::min(*least, size) : size;
  };
  for (const auto& entry : node) {
    const auto key = entry.first.as<std::string>("");
    const YAML::Node& value = entry.second;
    const bool is_smoother = key == "max_decel" && value.IsSequence() && value.size() == 3;
    if (key == "decel_lim_x" || is_smoother)
      take(key, is_smoother ? value[0] : value, &found->max_linear_deceleration);
    if (key == "decel_lim_theta" || is_smoother)
      take(key, is_smoother ? value[2] : value, &found->max_angular_deceleration);
    FindDecelerations(value, path, found);
  }
}

/// For each motion set that does not define its own.
void ReadNavigation(const std::string& path, std::map<std::string, MotionSet>* sets) {
  MotionSet found;
  try {
    FindDecelerations(YAML::LoadFile(path), path, &found);
  } catch (const YAML::Exception& error) {
    throw base::ConfigError(fmt::format("{}: cannot be read as YAML: {}", path, error.what()));
  }
  for (auto& [name, set] : *sets) {
    if (set.max_linear_deceleration == 0.0)
      set.max_linear_deceleration = found.max_linear_deceleration;
    if (set.max_angular_deceleration == 0.0)
      set.max_angular_deceleration = found.max_angular_deceleration;
  }
}

void ReadMotion(const std::string& path, ParamReader* in, RobotProfile* profile) {
  std::vector<std::string> needed{"urdf"};
  if (in->Has("motion_sets")) {
    profile->motion_sets = ReadMotionSets(in->Sub("motion_sets"));
    if (in->Has("navigation")) {
      const auto folder = std::filesystem::path(path).parent_path();
      ReadNavigation((folder / in->GetString("navigation")).string(), &profile->motion_sets);
    }
    profile->base_controller.limits = LargestOf(profile->motion_sets);
    if (profile->motion_sets.size() == 1) {
      profile->default_motion_set = profile->motion_sets.begin()->first;
    } else {
      needed.emplace_back("default_motion_set");  // several: which one counts is the file's to say
    }
  }
  in->RequireKeys(needed);
  if (in->Has("default_motion_set")) {
    profile->default_motion_set = base::ToLower(in->GetString("default_motion_set"));
  }
  if (in->Has("base_controller")) {
    profile->base_controller =
        ReadBaseController(profile->base_controller, in->Sub("base_controller"));
  }
}

RobotProfile ReadProfile(const std::string& path, ParamReader* in) {
  RobotProfile profile;
  ReadMotion(path, in, &profile);
  profile.urdf = in->GetString("urdf");
  if (in->Has("base_link")) profile.base_link = in->GetString("base_link");
  if (in->Has("tray_link")) profile.tray_link = in->GetString("tray_link");
  if (in->Has("object_on_tray")) profile.X_TO = ReadPose(in->Sub("object_on_tray"));
  if (in->Has("laser_link")) profile.laser_link = in->GetString("laser_link");
  if (in->Has("footprint")) profile.footprint = ReadFootprint(in);
  if (in->Has("robot_radius")) {
    in->Fail("robot_radius",
             "wanted `footprint` in its place, the corners from above: a round robot of 0.2 m is "
             "in [[0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2], [0.2, -0.2]]");
  }
  if (in->Has("footprint_padding")) {
    profile.footprint_padding = in->Get("footprint_padding", Between(0.0, 1.0));
  }
  if (in->Has("joints")) profile.joints = ReadJoints(in->Sub("joints"));
  if (in->Has("upper_body")) profile.upper_body = ReadUpperBody(in->Sub("upper_body"));
  if (in->Has("sensors")) profile.sensors = ReadExtraSensors(in->Sub("sensors"));
  in->RejectUnknownKeys();
  return profile;
}

/// Of a file of another kind it would not help to hear which of a profile's keys it lacks first.
void RequireSomeProfile(const ParamReader& in, const std::string& path) {
  for (const std::string& key : in.Keys()) {
    for (const char* known : {"base_link", "tray_link", "motion_sets", "upper_body", "footprint"}) {
      if (key == known) return;
    }
    if (base::EditDistance(base::ToLower(key), "urdf") <= 2) return;  // mistyped at most
  }
  throw base::ConfigError(
      fmt::format("{}: is no robot's profile, which begins with the name of its URDF (urdf: "
                  "my_robot.urdf); config/robots/cart.yaml is one",
                  path));
}

void CheckProfile(ParamReader in, const RobotProfile& profile, const RobotModel& model) {
  CheckLink(in, "base_link", model, profile.base_link);
  if (!profile.laser_link.empty()) CheckLink(in, "laser_link", model, profile.laser_link);
  if (!profile.tray_link.empty()) {
    CheckLink(in, "tray_link", model, profile.tray_link);
    if (model.links[*model.FindLink(profile.tray_link)].collisions.empty()) {
      in.Fail("tray_link",
              "which has no collision shape, so that nothing can stand on it; add one "
              "to the URDF or name another link");
    }
  }
  if (profile.motion_sets.count(profile.default_motion_set) == 0) {
    std::vector<std::string> names;
    for (const auto& [name, set] : profile.motion_sets) names.push_back(name);
    in.Fail("default_motion_set",
            base::UnknownName("motion set", profile.default_motion_set, names));
  }
  try {
    ForwardKinematics(model, profile.joints);
  } catch (const base::ConfigError& error) {
    in.Fail("joints", error.what());
  }
  if (profile.upper_body) CheckUpperBody(in.Sub("upper_body"), *profile.upper_body, model);
  if (in.Has("sensors")) CheckExtraSensors(in.Sub("sensors"), profile.sensors, model);
}

void AddTo(base::Hasher* hash, const MotionSet& set) {
  hash->Add(set.max_linear_velocity);
  hash->Add(set.max_angular_velocity);
  hash->Add(set.max_linear_acceleration);
  hash->Add(set.max_angular_acceleration);
  // Only then, so that what was measured without decelerations keeps its hash.
  if (set.max_linear_deceleration > 0.0) hash->Add(set.max_linear_deceleration);
  if (set.max_angular_deceleration > 0.0) {
    hash->Add("angular");
    hash->Add(set.max_angular_deceleration);
  }
}

void AddTo(base::Hasher* hash, const CasterParams& params) {
  hash->Add("casters");
  hash->Add(static_cast<std::uint64_t>(params.version));
  for (const double value : {params.at, params.track, params.wheel_radius, params.wheel_inertia,
                             params.wheel_effort, params.wheel_damping, params.steering_inertia,
                             params.steering_effort, params.steering_speed, params.steering_damping,
                             params.mass, params.yaw_inertia, params.grip}) {
    hash->Add(value);
  }
}

void AddTo(base::Hasher* hash, const BaseControllerParams& params) {
  AddTo(hash, params.limits);
  for (const double value :
       {params.max_linear_jerk, params.command_timeout, params.command_lag, params.loop_frequency,
        params.loop_damping, params.sway_compliance, params.sway_frequency, params.sway_damping}) {
    hash->Add(value);
  }
  // Only then, so that what was measured with a base that ramps and drives sideways keeps its hash.
  if (params.stops_at_timeout) hash->Add("stops_at_timeout");
  if (params.emergency_deceleration > 0.0) {
    hash->Add("emergency_deceleration");
    hash->Add(params.emergency_deceleration);
  }
  if (params.drive != Drive::kOmnidirectional) hash->Add(ToString(params.drive));
  if (params.drive == Drive::kCarLike) hash->Add(params.min_turning_radius);
  if (params.casters) AddTo(hash, *params.casters);
}

std::uint64_t HashOf(const RobotProfile& profile) {
  base::Hasher hash;
  hash.Add(profile.base_link);
  hash.Add(profile.tray_link);
  for (int i = 0; i < 3; ++i) hash.Add(profile.X_TO.translation[i]);
  for (int i = 0; i < 4; ++i) hash.Add(profile.X_TO.rotation.coeffs()[i]);
  hash.Add(profile.laser_link);
  hash.Add(static_cast<std::uint64_t>(profile.footprint.size()));
  for (const Eigen::Vector2d& corner : profile.footprint) {
    hash.Add(corner.x());
    hash.Add(corner.y());
  }
  hash.Add(profile.footprint_padding);
  for (const auto& [name, set] : profile.motion_sets) {
    hash.Add(name);
    AddTo(&hash, set);
  }
  hash.Add(profile.default_motion_set);
  AddTo(&hash, profile.base_controller);
  for (const auto& [name, position] : profile.joints) {
    hash.Add(name);
    hash.Add(position);
  }
  if (profile.upper_body) AddTo(&hash, *profile.upper_body);
  return hash.value();
}

/// [m^2] from above of a link's largest shape; 0 where it has none.
double LargestArea(const Link& link, const Pose3& X_RL) {
  double largest = 0.0;
  for (const geometry::Collision& collision : link.collisions) {
    const geometry::Aabb bounds = geometry::BoundsOf(collision.shape, X_RL * collision.X_BS);
    const Eigen::Vector3d size = bounds.upper - bounds.lower;
    largest = std::max(largest, size.x() * size.y());
  }
  return largest;
}

/// The link called a tray whose shape is the largest from above; "" where there is none.
std::string GuessTray(const RobotModel& model) {
  const std::vector<Pose3> X_R = ForwardKinematics(model, {});
  std::string tray;
  double largest = 0.0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (base::ToLower(model.links[i].name).find("tray") == std::string::npos) continue;
    const double area = LargestArea(model.links[i], X_R[i]);
    if (area <= largest) continue;
    largest = area;
    tray = model.links[i].name;
  }
  return tray;
}

/// @pre tray_link has a shape.
void PutOnTray(const RobotModel& model, RobotProfile* profile) {
  profile->X_TO = PlaceOnTray(model, profile->joints, profile->tray_link).X_TO;
}

/// Of a tray that the file names, a file that says nothing of the place on it.
/// @pre CheckProfile
void PlaceOnNamedTray(const ParamReader& in, const RobotModel& model, RobotProfile* profile) {
  if (profile->tray_link.empty() || in.Has("object_on_tray")) return;
  PutOnTray(model, profile);
}

void SetGuessedDrive(const RobotModel& model, RobotProfile* profile) {
  const DriveGuess guess = GuessDrive(model, profile->base_link);
  profile->base_controller.drive = guess.drive;
  profile->base_controller.min_turning_radius = guess.min_turning_radius;
}

/// Answers carry this among their caveats; the line is for whoever follows a node's log.
void SayAssumed(const Robot& robot) {
  for (const std::string& text : robot.assumed)
    base::Log(base::LogLevel::kInfo, fmt::format("robot={} assumed {}", robot.model.name, text));
}

void SayBase(const std::string& note, Robot* robot) {
  if (!note.empty()) robot->assumed.insert(robot->assumed.begin(), note);
}

/// What the file leaves out is taken from the model, as for a bare URDF.
void FillFromModel(ParamReader in, Robot* robot) {
  RobotProfile& profile = robot->profile;
  if (!in.Has("base_link")) profile.base_link = robot->model.links.front().name;
  if (!in.Has("tray_link")) profile.tray_link = GuessTray(robot->model);
  if (!in.Has("base_controller") || !in.Sub("base_controller").Has("drive")) {
    SetGuessedDrive(robot->model, &profile);
  }
}

/// Corners from above of the shapes of all links that count.
template <typename Counts>
std::vector<Eigen::Vector2d> CornersOf(const RobotModel& model, const std::string& base_link,
                                       const JointPositions& joints, const Counts& counts) {
  const std::vector<Pose3> X_R = ForwardKinematics(model, joints);
  const Pose3 X_BR = X_R[*model.FindLink(base_link)].Inverse();
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (!counts(static_cast<int>(i))) continue;
    for (const geometry::Collision& collision : model.links[i].collisions) {
      const auto outline = geometry::OutlineInBand(
          collision.shape, X_BR * (X_R[i] * collision.X_BS), 0.0, kFootprintTop);
      if (outline) points.insert(points.end(), outline->begin(), outline->end());
    }
  }
  return points;
}

/// Empty where no shape lies where footprints are made of shapes.
geometry::Polygon OutlineIfAny(const RobotModel& model, const std::string& base_link,
                               const JointPositions& joints) {
  auto points = CornersOf(model, base_link, joints, [](int /*link*/) { return true; });
  return points.size() >= 3 ? geometry::ConvexHull(std::move(points)) : geometry::Polygon();
}

/// Joints in the driving posture. Where that fails it may be a matter of units.
void SetFootprint(const std::vector<std::string>& doubts, Robot* robot) {
  RobotProfile& profile = robot->profile;
  try {
    profile.footprint = OutlineOf(robot->model, profile.base_link, profile.joints);
  } catch (const base::ConfigError& error) {
    if (doubts.empty()) throw;
    throw base::ConfigError(fmt::format("{}\n  {}", error.what(), base::Join(doubts, "\n  ")));
  }
}

/// Of units: meshes that are hardly in metres, and a footprint that is hardly a robot's.
void SayDoubts(const std::vector<std::string>& doubts, const std::string& urdf,
               const Robot& robot) {
  for (const std::string& doubt : doubts)
    base::Log(base::LogLevel::kWarn, fmt::format("urdf={} {}", urdf, doubt));
  if (!doubts.empty()) return;
  geometry::Aabb hull;
  for (const Eigen::Vector2d& p : robot.profile.footprint) hull.Include({p.x(), p.y(), 0.0});
  const Eigen::Vector3d size = hull.upper - hull.lower;
  if (size.maxCoeff() <= kWidestRobot) return;
  base::Log(base::LogLevel::kWarn,
            fmt::format("urdf={} the robot is {:.4g} x {:.4g} m large from above, as if its unit "
                        "were not the metre: in mm it would be {:.4g} x {:.4g} m, in cm {:.4g} x "
                        "{:.4g} m; lengths in a URDF and in a profile are metres",
                        urdf, size.x(), size.y(), 1e-3 * size.x(), 1e-3 * size.y(), 1e-2 * size.x(),
                        1e-2 * size.y()));
}

/// What a bare URDF says, but for a footprint.
Robot WithoutFootprint(const UrdfFile& file, UrdfReading* reading) {
  Robot robot;
  robot.model = std::move(reading->model);
  RobotProfile& profile = robot.profile;
  profile.urdf = TextOf({std::filesystem::path(file.path).filename().string(), file.arguments});
  profile.base_link = robot.model.links.front().name;
  profile.tray_link = GuessTray(robot.model);
  if (!profile.tray_link.empty()) PutOnTray(robot.model, &profile);
  SetGuessedDrive(robot.model, &profile);
  StandOnFloor(&robot);
  return robot;
}

/// What rests on the footprint, too.
void CompleteBare(const UrdfReading& reading, const std::string& path, const std::string& xml,
                  Robot* robot) {
  SayDoubts(reading.doubts, path, *robot);
  robot->assumed = AssumptionsOf(
      *robot, [](const std::string& /*key*/) { return false; }, xml, path);
  SayBase(reading.base_note, robot);
  SayAssumed(*robot);
  robot->profile.hash = HashOf(robot->profile);
}

/// Whether a profile says something of its own, by key or "key.key".
std::function<bool(const std::string&)> IsGivenIn(const ParamReader& in) {
  return [&in](const std::string& key) {
    const std::size_t dot = key.find('.');
    if (dot == std::string::npos) return in.Has(key);
    const std::string section = key.substr(0, dot);
    return in.Has(section) && ParamReader(in).Sub(section).Has(key.substr(dot + 1));
  };
}

/// Whether the torso, the neck or an arm carries it.
bool IsOfUpperBody(const Robot& robot, int link) {
  if (!robot.profile.upper_body) return false;
  const UpperBodyProfile& upper = *robot.profile.upper_body;
  std::vector<std::string> joints{upper.torso_joint, upper.head_pan_joint};
  for (const auto& [name, arm] : upper.arms) joints.push_back(arm.joints.front());
  return std::any_of(joints.begin(), joints.end(), [&](const std::string& joint) {
    const std::optional<int> above = FindLinkOf(robot.model, joint);
    return above && IsBelow(robot.model, link, *above);
  });
}

/// Of a profile, which is named where it is not there.
UrdfFile UrdfIn(const ParamReader& in, const std::string& profile_path,
                const RobotProfile& profile) {
  UrdfFile urdf;
  try {
    urdf = UrdfOf(profile_path, profile);
  } catch (const base::ConfigError& error) {
    in.Fail("urdf", error.what());
  }
  if (std::filesystem::exists(urdf.path)) return urdf;
  in.Fail("urdf", fmt::format("wanted a file that is there, but {} is not; write its path as seen "
                              "from the profile's folder",
                              urdf.path));
}

/// " (they lie 50 m to 505 m above it, as if their unit were not the metre)": where the shapes are
/// of a robot of which none is low enough; "" where it has none.
std::string HeightsText(const RobotModel& model, const std::string& base_link,
                        const JointPositions& joints) {
  if (!HasShapes(model)) return "";
  const std::vector<Pose3> X_R = ForwardKinematics(model, joints);
  const Pose3 X_BR = X_R[*model.FindLink(base_link)].Inverse();
  geometry::Aabb all;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const geometry::Collision& shape : model.links[i].collisions)
      all.Include(geometry::BoundsOf(shape.shape, X_BR * (X_R[i] * shape.X_BS)));
  }
  const bool is_doubted = all.upper.z() - all.lower.z() > kWidestRobot;
  return fmt::format(" (they lie {:.3g} m to {:.3g} m above it{})", all.lower.z(), all.upper.z(),
                     is_doubted ? ", as if their unit were not the metre" : "");
}

}  // namespace

std::optional<double> LaserHeight(const Robot& robot) {
  const RobotProfile& profile = robot.profile;
  if (profile.laser_link.empty()) return std::nullopt;
  const auto X_RL = ForwardKinematics(robot.model, profile.joints);
  const Pose3& X_RB = X_RL[*robot.model.FindLink(profile.base_link)];
  return (X_RB.Inverse() * X_RL[*robot.model.FindLink(profile.laser_link)]).translation.z();
}

geometry::Polygon OutlineOf(const RobotModel& model, const std::string& base_link,
                            const JointPositions& joints) {
  geometry::Polygon outline = OutlineIfAny(model, base_link, joints);
  if (!outline.empty()) return outline;
  throw base::ConfigError(
      fmt::format("robot '{}': no collision shape lies 0 to {} m above link '{}'{}, so there is no "
                  "footprint; add <collision> shapes, or give 'footprint' in a profile, which "
                  "`hires new robot` begins",
                  model.name, kFootprintTop, base_link, HeightsText(model, base_link, joints)));
}

geometry::Polygon BaseOutlineOf(const Robot& robot) {
  auto points = CornersOf(robot.model, robot.profile.base_link, robot.profile.joints,
                          [&robot](int link) { return !IsOfUpperBody(robot, link); });
  return points.size() >= 3 ? geometry::ConvexHull(std::move(points)) : robot.profile.footprint;
}

std::uint64_t Robot::hash() const {
  base::Hasher hash;
  hash.Add(model.hash);
  hash.Add(profile.hash);
  return hash.value();
}

Robot LoadRobot(const std::string& profile_path) {
  ParamReader in = ParamReader::FromFile(profile_path);
  RequireSomeProfile(in, profile_path);
  Robot robot;
  robot.profile = ReadProfile(profile_path, &in);
  const UrdfFile urdf = UrdfIn(in, profile_path, robot.profile);
  const std::string xml = ReadUrdfFile(urdf);
  UrdfReading reading = ReadUrdf(xml, urdf.path);
  robot.model = std::move(reading.model);
  FillFromModel(in, &robot);
  CheckProfile(in, robot.profile, robot.model);
  PlaceOnNamedTray(in, robot.model, &robot.profile);
  StandOnFloor(&robot);
  if (robot.profile.footprint.empty()) SetFootprint(reading.doubts, &robot);
  SayDoubts(reading.doubts, urdf.path, robot);
  robot.assumed = AssumptionsOf(robot, IsGivenIn(in), xml, urdf.path);
  if (!in.Has("base_link")) SayBase(reading.base_note, &robot);
  SayAssumed(robot);
  robot.profile.hash = HashOf(robot.profile);
  return robot;
}

Robot LoadRobotFromUrdf(const std::string& urdf_path) {
  const UrdfFile file = SplitArguments(urdf_path);
  const std::string xml = ReadUrdfFile(file);
  UrdfReading reading = ReadUrdf(xml, file.path);
  Robot robot = WithoutFootprint(file, &reading);
  SetFootprint(reading.doubts, &robot);
  CompleteBare(reading, file.path, xml, &robot);
  return robot;
}

Robot LoadRobotToDescribe(const UrdfFile& file, const std::string& xml) {
  UrdfReading reading = ReadUrdf(xml, file.path);
  Robot robot = WithoutFootprint(file, &reading);
  robot.profile.footprint =
      OutlineIfAny(robot.model, robot.profile.base_link, robot.profile.joints);
  if (!robot.profile.footprint.empty()) {
    CompleteBare(reading, file.path, xml, &robot);
  } else {
    SayDoubts(reading.doubts, file.path, robot);
  }
  return robot;
}

}  // namespace hires::robot
