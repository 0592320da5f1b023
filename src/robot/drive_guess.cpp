#include "robot/drive_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "hires/base/check.h"
#include "hires/base/text.h"

namespace hires::robot {
namespace {

constexpr double kHorizontal = 0.1;  // largest upward part of a wheel's axis
constexpr double kParallel = 0.99;   // least cosine between two axes
constexpr double kOnAxle = 0.01;   // [m] by which a link may lie off the axle and still be over it
constexpr double kOnAxles = 0.05;  // [m] the same where wheels that slip make the axle
constexpr double kSameFloor = 0.15;  // [m] by which the centres of a base's wheels differ in height
constexpr double kAlongX = 0.2;      // largest forward part of an axle of wheels that roll along x

// [rad] What a car's wheels are turned by at most where nothing says it; less than the second is no
// steering, and more than the third would have the car turn on the spot.
constexpr double kUsualSteering = 0.5;
constexpr double kLeastSteering = 0.02;
constexpr double kMostSteering = 1.4;

// [rad] A little less than half a turn, which gives all directions to a wheel that rolls both ways.
constexpr double kHalfTurn = 3.0;

struct FixedWheel {
  std::string joint;
  Eigen::Vector3d axis, centre;  // in the base frame
};

struct SteeredWheel {
  std::string joint;
  double largest_angle{0.0};  // [rad] that it can be turned to both sides
  bool has_limits{false};
  bool can_turn_aside{true};           // far enough for its wheel to roll sideways
  Eigen::Vector3d centre;              // of the joint that steers, in the base frame
  Eigen::Vector3d axis, wheel_centre;  // of the wheel that it carries, in the base frame
};

struct CasterWheel {
  std::string joint;
  double height{0.0};  // [m] of its centre, in the base frame
};

struct Wheels {
  std::vector<FixedWheel> fixed;  // keep their direction
  std::vector<CasterWheel> casters;
  std::vector<SteeredWheel> steered;  // those of the casters
};

/// The joint below the root that turns a wheel's axle about the vertical: index of its link.
std::optional<int> SwivelAbove(const RobotModel& model, const std::vector<geometry::Pose3>& X_R,
                               int link) {
  for (int above = link; model.links[above].joint; above = model.links[above].joint->parent) {
    const Joint& joint = *model.links[above].joint;
    const bool can_turn =
        joint.type == JointType::kContinuous || joint.type == JointType::kRevolute;
    if (can_turn && std::abs((X_R[above].rotation * joint.axis).z()) > 1.0 - kHorizontal)
      return above;
  }
  return std::nullopt;
}

/// What a simulator's plugin says of the drive, and its file.
using DrivePlugin = std::pair<Drive, std::string>;

std::optional<DrivePlugin> PluginOf(const RobotModel& model) {
  constexpr std::pair<const char*, Drive> kSigns[] = {
      {"planar_move", Drive::kOmnidirectional},
      {"mecanum", Drive::kOmnidirectional},
      {"velocity_control_system", Drive::kOmnidirectional},
      {"diff_drive", Drive::kDifferential},
      {"skid_steer", Drive::kDifferential},
      {"ackermann", Drive::kCarLike}};
  for (const std::string& file : model.plugins) {
    std::string words = base::ToLower(file);
    std::replace(words.begin(), words.end(), '-', '_');
    for (const auto& [sign, drive] : kSigns)
      if (words.find(sign) != std::string::npos) return DrivePlugin(drive, file);
  }
  return std::nullopt;
}

/// A swivel that something turns; nothing for a caster that trails, as a car has none.
std::optional<SteeredWheel> SteeredBy(const Joint& swivel, const geometry::Pose3& X_RS,
                                      bool is_car) {
  const bool has_limits = swivel.type == JointType::kRevolute && swivel.limits;
  const bool has_name = base::ToLower(swivel.name).find("steer") != std::string::npos;
  if (!has_limits && !has_name && !is_car) return std::nullopt;
  const double angle =
      has_limits ? std::min(-swivel.limits->lower, swivel.limits->upper) : kUsualSteering;
  if (angle < kLeastSteering) return std::nullopt;
  SteeredWheel wheel;
  wheel.joint = swivel.name;
  wheel.largest_angle = std::min(angle, kMostSteering);
  wheel.has_limits = has_limits;
  wheel.can_turn_aside =
      has_limits ? swivel.limits->upper - swivel.limits->lower >= kHalfTurn : !is_car;
  wheel.centre = X_RS.translation;
  return wheel;
}

/// Of all links in the frame of the base; a name that no link has, which is refused later, counts
/// as the root.
std::vector<geometry::Pose3> PosesInBase(const RobotModel& model, const std::string& base_link) {
  std::vector<geometry::Pose3> X_B = ForwardKinematics(model, {});
  const int base = model.FindLink(base_link).value_or(0);
  if (base == 0) return X_B;
  const geometry::Pose3 X_BR = X_B[base].Inverse();
  for (geometry::Pose3& X : X_B) X = X_BR * X;
  return X_B;
}

/// Wheels whose joint has no limits take those of one beside it, as a car's turn together.
void TakeLimitsOfNeighbours(std::vector<SteeredWheel>* wheels) {
  for (SteeredWheel& wheel : *wheels) {
    const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ().cross(wheel.axis.normalized());
    for (const SteeredWheel& other : *wheels) {
      if (wheel.has_limits || !other.has_limits) continue;
      if (std::abs(wheel.axis.dot(other.axis)) <= kParallel) continue;
      if (std::abs((other.centre - wheel.centre).dot(forward)) > kOnAxles) continue;
      wheel.joint = other.joint;
      wheel.largest_angle = other.largest_angle;
      wheel.has_limits = true;
      wheel.can_turn_aside = other.can_turn_aside;
    }
  }
}

Wheels WheelsOf(const RobotModel& model, const std::string& base_link) {
  const std::vector<geometry::Pose3> X_B = PosesInBase(model, base_link);
  const auto plugin = PluginOf(model);
  const bool is_car = plugin && plugin->first == Drive::kCarLike;
  Wheels wheels;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto& joint = model.links[i].joint;
    if (!joint || joint->type != JointType::kContinuous) continue;
    const Eigen::Vector3d axis = X_B[i].rotation * joint->axis;
    if (std::abs(axis.z()) > kHorizontal) continue;
    if (const auto swivel = SwivelAbove(model, X_B, static_cast<int>(i))) {
      wheels.casters.push_back({joint->name, X_B[i].translation.z()});
      auto steered = SteeredBy(*model.links[*swivel].joint, X_B[*swivel], is_car);
      if (!steered) continue;
      steered->axis = axis;
      steered->wheel_centre = X_B[i].translation;
      wheels.steered.push_back(*steered);
    } else {
      wheels.fixed.push_back({joint->name, axis, X_B[i].translation});
    }
  }
  TakeLimitsOfNeighbours(&wheels.steered);
  return wheels;
}

/// Two wheels with the same axle direction, or nothing.
std::optional<std::pair<std::size_t, std::size_t>> ParallelPair(const Wheels& wheels) {
  for (std::size_t i = 0; i < wheels.fixed.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(wheels.fixed[i].axis.dot(wheels.fixed[j].axis)) > kParallel) {
        return std::make_pair(j, i);
      }
    }
  }
  return std::nullopt;
}

/// Names of the wheels that keep their direction.
std::string FixedNames(const Wheels& wheels) {
  std::vector<std::string> names;
  for (const FixedWheel& wheel : wheels.fixed) names.push_back(wheel.joint);
  return base::Join(names, ", ");
}

double TurningRadius(const SteeredWheel& wheel, const Eigen::Vector3d& along,
                     const Eigen::Vector3d& p_BA) {
  const Eigen::Vector3d p_AW = wheel.centre - p_BA;
  const double across = std::abs(p_AW.dot(along));
  const double ahead = std::abs(p_AW.dot(Eigen::Vector3d::UnitZ().cross(along)));
  return ahead / std::tan(wheel.largest_angle) + across;
}

/// Those of all wheels that turn as this one does and are on the floor, as the lowest is.
std::vector<Eigen::Vector3d> CentresOnFloor(const Wheels& wheels, const FixedWheel& one) {
  std::vector<Eigen::Vector3d> centres;
  for (const FixedWheel& wheel : wheels.fixed)
    if (std::abs(wheel.axis.dot(one.axis)) > kParallel) centres.push_back(wheel.centre);
  double lowest = one.centre.z();
  for (const Eigen::Vector3d& centre : centres) lowest = std::min(lowest, centre.z());
  const auto is_above = [&](const Eigen::Vector3d& centre) {
    return centre.z() - lowest > kSameFloor;
  };
  centres.erase(std::remove_if(centres.begin(), centres.end(), is_above), centres.end());
  return centres;
}

/// The middle between the wheels of all axles: what a base of four or six wheels turns about. A
/// wheel alone in its row is a support, if there are others.
Eigen::Vector3d MiddleOf(const Wheels& wheels, const FixedWheel& one) {
  const std::vector<Eigen::Vector3d> centres = CentresOnFloor(wheels, one);
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ().cross(one.axis.normalized());
  std::vector<Eigen::Vector3d> of_axles;
  for (const Eigen::Vector3d& centre : centres) {
    const auto is_in_its_row = [&](const Eigen::Vector3d& other) {
      return std::abs((other - centre).dot(ahead)) <= kOnAxles;
    };
    if (std::count_if(centres.begin(), centres.end(), is_in_its_row) > 1)  // itself and another
      of_axles.push_back(centre);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto& counted = of_axles.empty() ? centres : of_axles;
  for (const Eigen::Vector3d& centre : counted) sum += centre;
  return sum / static_cast<double>(counted.size());
}

/// What of its wheels does not fit to how a base drives: it goes along the x axis of base_link, and
/// turns about that link's origin. Empty where all does.
std::string MisfitOf(const Eigen::Vector3d& axle, const Eigen::Vector3d& p_BA, double tolerance,
                     const std::string& base_link) {
  std::vector<std::string> misfits;
  const double forward = std::min(1.0, std::abs(axle.normalized().x()));
  if (forward > kAlongX) {
    misfits.push_back(fmt::format(
        "its wheels roll {:.0f} degrees off the x axis of '{}', along which it is driven here "
        "(REP-103): a profile names a link whose x axis points forward, base_link",
        std::asin(forward) * 180.0 / M_PI, base_link));
  }
  if (p_BA.head<2>().norm() > tolerance) {
    misfits.push_back(fmt::format(
        "the axle lies at x {:.2f} m, y {:.2f} m of '{}', which is taken to be over it: a profile "
        "names one that is, base_link",
        p_BA.x(), p_BA.y(), base_link));
  }
  return base::Join(misfits, "; and ");
}

std::string WithMisfit(const std::string& why, const std::string& misfit) {
  return misfit.empty() ? why : why + "; but " + misfit;
}

/// What of a car keeps its direction.
struct Axle {
  std::string what;               // "parallel wheels (left, right)"
  Eigen::Vector3d along, middle;  // in the base frame
};

Axle AxleOf(const FixedWheel& one, const FixedWheel& other) {
  return {fmt::format("parallel wheels ({}, {})", one.joint, other.joint), one.axis.normalized(),
          0.5 * (one.centre + other.centre)};
}

/// Of a bicycle: a wheel that rolls on the floor as a steered one does.
std::optional<Axle> AxleOfOneWheel(const Wheels& wheels) {
  for (const FixedWheel& fixed : wheels.fixed) {
    for (const SteeredWheel& steered : wheels.steered) {
      const double above = fixed.centre.z() - steered.wheel_centre.z();
      if (std::abs(above) > kSameFloor || std::abs(fixed.axis.dot(steered.axis)) <= kParallel)
        continue;
      return Axle{fmt::format("a wheel that keeps its direction ({})", fixed.joint),
                  fixed.axis.normalized(), fixed.centre};
    }
  }
  return std::nullopt;
}

/// A car, if some of the steered wheels lie off its axle. What does not roll along with it is none:
/// joints of an arm that swings are steered wheels by their axes, too.
std::optional<DriveGuess> GuessCar(const Wheels& wheels, const Axle& axle,
                                   const std::string& base_link) {
  const Eigen::Vector3d& along = axle.along;
  const Eigen::Vector3d& p_BA = axle.middle;
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ().cross(along);
  const SteeredWheel* widest = nullptr;
  for (const SteeredWheel& wheel : wheels.steered) {
    const double ahead = (wheel.centre - p_BA).dot(forward);
    if (std::abs(ahead) <= kOnAxle || std::abs(wheel.axis.dot(along)) <= kParallel) continue;
    if (!widest || TurningRadius(wheel, along, p_BA) > TurningRadius(*widest, along, p_BA)) {
      widest = &wheel;
    }
  }
  if (!widest) return std::nullopt;
  const double radius = TurningRadius(*widest, along, p_BA);
  const std::string why = fmt::format(
      "{} and steered ones; min_turning_radius={:.2f} m from the {:.2f} rad {} {}", axle.what,
      radius, widest->largest_angle, widest->has_limits ? "of" : "ASSUMED of", widest->joint);
  const std::string misfit = MisfitOf(along, p_BA, kOnAxle, base_link);
  return DriveGuess{Drive::kCarLike, radius, WithMisfit(why, misfit), misfit};
}

/// Those of the steered wheels that cannot be turned sideways and roll on the floor, in one
/// direction as they stand.
std::vector<SteeredWheel> NarrowOnFloor(const Wheels& wheels) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const CasterWheel& wheel : wheels.casters) lowest = std::min(lowest, wheel.height);
  std::vector<SteeredWheel> narrow;
  for (const SteeredWheel& wheel : wheels.steered) {
    if (wheel.can_turn_aside || wheel.wheel_centre.z() - lowest > kSameFloor) continue;
    if (narrow.empty() || std::abs(wheel.axis.dot(narrow.front().axis)) > kParallel)
      narrow.push_back(wheel);
  }
  return narrow;
}

/// A car all of whose wheels are steered, some ahead of others. It turns about its middle, if front
/// and rear turn against each other; that is not known, so its circle is that of a car of which the
/// wheels of one end keep straight.
std::optional<DriveGuess> GuessCarOfSteered(const std::vector<SteeredWheel>& wheels,
                                            const std::string& base_link) {
  const Eigen::Vector3d along = wheels.front().axis.normalized();
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ().cross(along);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double rear = std::numeric_limits<double>::infinity(), front = -rear;
  std::vector<std::string> joints;
  for (const SteeredWheel& wheel : wheels) {
    sum += wheel.centre;
    rear = std::min(rear, wheel.centre.dot(forward));
    front = std::max(front, wheel.centre.dot(forward));
    joints.push_back(wheel.joint);
  }
  if (front - rear <= kOnAxle) return std::nullopt;
  const Eigen::Vector3d p_BM = sum / static_cast<double>(wheels.size());
  double radius = 0.0, angle = kMostSteering;
  for (const SteeredWheel& wheel : wheels) {
    const double across = std::abs((wheel.centre - p_BM).dot(along));
    radius = std::max(radius, (front - rear) / std::tan(wheel.largest_angle) + across);
    angle = std::min(angle, wheel.largest_angle);
  }
  const std::string why = fmt::format(
      "no wheel that keeps its direction, but steered ones that cannot be turned sideways ({}); "
      "min_turning_radius={:.2f} m from {:.2f} rad at one end alone: that front and rear turn "
      "against each other is not modelled",
      base::Join(joints, ", "), radius, angle);
  const std::string misfit = MisfitOf(along, p_BM, kOnAxles, base_link);
  return DriveGuess{Drive::kCarLike, radius, WithMisfit(why, misfit), misfit};
}

/// Where the wheels do not tell. A car's least circle no plugin says.
DriveGuess GuessByPlugin(const RobotModel& model) {
  const std::string no_wheels = "no wheels (continuous joints) that could drive it sideways";
  const auto plugin = PluginOf(model);
  if (!plugin) return {Drive::kDifferential, 0.0, no_wheels};
  const std::string what = fmt::format("a plugin '{}'", plugin->second);
  switch (plugin->first) {
    case Drive::kOmnidirectional:
      return {Drive::kOmnidirectional, 0.0, what + ", which drives it sideways, too"};
    case Drive::kDifferential:
      return {Drive::kDifferential, 0.0, what};
    case Drive::kCarLike:
      break;
  }
  return {Drive::kDifferential, 0.0,
          no_wheels + "; but " + what +
              " of a car: a profile says so, drive: car_like with min_turning_radius"};
}

/// Where no wheel keeps its direction.
DriveGuess GuessByCasters(const RobotModel& model, const Wheels& wheels,
                          const std::string& base_link) {
  const std::vector<SteeredWheel> narrow = NarrowOnFloor(wheels);
  if (!narrow.empty()) return GuessCarOfSteered(narrow, base_link).value_or(GuessByPlugin(model));
  std::vector<std::string> names;
  for (const CasterWheel& wheel : wheels.casters) names.push_back(wheel.joint);
  return {Drive::kOmnidirectional, 0.0, "steered casters alone: " + base::Join(names, ", ")};
}

const std::map<Drive, std::string>& Names() {
  static const std::map<Drive, std::string> names{{Drive::kOmnidirectional, "omnidirectional"},
                                                  {Drive::kDifferential, "differential"},
                                                  {Drive::kCarLike, "car_like"}};
  return names;
}

}  // namespace

std::string ToString(Drive drive) { return Names().at(drive); }

Drive DriveOf(const std::string& name) {
  const auto found = std::find_if(Names().begin(), Names().end(),
                                  [&](const auto& entry) { return entry.second == name; });
  HIRES_CHECK(found != Names().end(), "a drive has one of three names");
  return found->first;
}

DriveGuess GuessDrive(const RobotModel& model, const std::string& base_link) {
  const Wheels wheels = WheelsOf(model, base_link);
  if (const auto pair = ParallelPair(wheels)) {
    const FixedWheel &one = wheels.fixed[pair->first], &other = wheels.fixed[pair->second];
    if (auto car = GuessCar(wheels, AxleOf(one, other), base_link)) return *car;
    const std::string misfit = MisfitOf(one.axis, MiddleOf(wheels, one), kOnAxles, base_link);
    std::string why = fmt::format("parallel wheels: {}, {}", one.joint, other.joint);
    const auto plugin = PluginOf(model);
    if (plugin && plugin->first == Drive::kOmnidirectional)
      why += fmt::format(" (a plugin '{}' drives it sideways, too)", plugin->second);
    return {Drive::kDifferential, 0.0, WithMisfit(why, misfit), misfit};
  }
  if (wheels.fixed.size() >= 3) {
    return {Drive::kOmnidirectional, 0.0,
            "three wheels in three directions: " + FixedNames(wheels)};
  }
  if (const auto axle = AxleOfOneWheel(wheels)) {
    if (auto car = GuessCar(wheels, *axle, base_link)) return *car;
  }
  if (wheels.fixed.empty() && wheels.casters.size() >= 3)
    return GuessByCasters(model, wheels, base_link);
  return GuessByPlugin(model);
}

}  // namespace hires::robot
