#include "robot/assumptions.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/files/plain_xml.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/robot/link_bounds.h"
#include "robot/base_height.h"
#include "robot/drive_guess.h"
#include "robot/tray_place.h"
#include "robot/urdf/seen_beyond.h"

namespace hires::robot {
namespace {

using Bounds = std::vector<geometry::Aabb>;  // LinkBounds
using IsGiven = std::function<bool(const std::string&)>;

constexpr std::size_t kMostNames = 6;

/// Whether a footprint is made of it.
bool IsInFootprint(const Robot& robot, const Bounds& bounds, std::size_t link) {
  return !robot.model.links[link].collisions.empty() && bounds[link].lower.z() <= kFootprintTop;
}

/// "; 'antenna' alone makes it 7.30 m longer": of a part, as the body is wide, that makes a
/// footprint half as long again or more. @param size  of the footprint
std::string LongestText(const Robot& robot, const Bounds& bounds, const Eigen::Vector3d& size) {
  constexpr double kMuchLonger = 1.5, kAsWide = 0.5;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (!IsInFootprint(robot, bounds, i)) continue;
    if (bounds[i].upper.y() - bounds[i].lower.y() >= kAsWide * size.y()) continue;
    geometry::Aabb others;
    for (std::size_t j = 0; j < bounds.size(); ++j)
      if (j != i && IsInFootprint(robot, bounds, j)) others.Include(bounds[j]);
    const double length = others.upper.x() - others.lower.x();  // < 0 where there are none
    if (length > 0.0 && size.x() >= kMuchLonger * length)
      return fmt::format("; '{}' alone makes it {:.2f} m longer", robot.model.links[i].name,
                         size.x() - length);
  }
  return "";
}

std::string FootprintText(const Robot& robot, const Bounds& bounds) {
  geometry::Aabb hull;
  for (const Eigen::Vector2d& p : robot.profile.footprint) hull.Include({p.x(), p.y(), 0.0});
  const Eigen::Vector3d size = hull.upper - hull.lower;
  return fmt::format(
      "footprint: the outline of all shapes, {:.2f} m long and {:.2f} m wide, and '{}' reaches "
      "farthest to a side{}; if that is wrong, write `footprint: [{{x: .., y: ..}}, ...]` in a "
      "profile",
      size.x(), size.y(), WidestLink(robot, bounds), LongestText(robot, bounds, size));
}

/// What lies above all that a footprint is made of, and is held against nothing there.
std::vector<std::string> LeftOut(const Robot& robot, const Bounds& bounds) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (robot.model.links[i].collisions.empty()) continue;
    if (bounds[i].lower.z() > kFootprintTop) names.push_back(robot.model.links[i].name);
  }
  return names;
}

/// Whether what a link carries sticks out of all else, seen from above.
bool SticksOut(const Robot& robot, const Bounds& bounds, int above) {
  std::vector<Eigen::Vector2d> carried, others;
  for (int i = 0; i < static_cast<int>(bounds.size()); ++i) {
    if (robot.model.links[i].collisions.empty()) continue;
    auto& corners = IsBelow(robot.model, i, above) ? carried : others;
    for (const double x : {bounds[i].lower.x(), bounds[i].upper.x()}) {
      for (const double y : {bounds[i].lower.y(), bounds[i].upper.y()}) corners.emplace_back(x, y);
    }
  }
  if (others.empty()) return !carried.empty();
  const geometry::Polygon hull = geometry::ConvexHull(std::move(others));
  return std::any_of(carried.begin(), carried.end(), [&](const Eigen::Vector2d& corner) {
    return !geometry::Contains(hull, corner);
  });
}

/// Movable joints but wheels, that no file puts anywhere and that the footprint depends on.
std::vector<std::string> JointsAtZero(const Robot& robot, const Bounds& bounds) {
  std::vector<std::string> names;
  const RobotModel& model = robot.model;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto& joint = model.links[i].joint;
    const bool moves =
        joint && joint->mimics.empty() &&
        (joint->type == JointType::kRevolute || joint->type == JointType::kPrismatic);
    if (!moves || robot.profile.joints.count(joint->name) > 0) continue;
    if (SticksOut(robot, bounds, static_cast<int>(i))) names.push_back(joint->name);
  }
  return names;
}

bool IsLaserType(const std::string& type) {
  return type == "ray" || type == "gpu_ray" || type == "lidar" || type == "gpu_lidar";
}

/// How much says of a laser that it looks where the robot drives.
int SignsOfAhead(const Robot& robot, const std::vector<geometry::Pose3>& X_R,
                 const std::string& name) {
  constexpr double kAhead = 0.9;  // least cosine between its x axis and the base's
  const int base = robot.model.FindLink(robot.profile.base_link).value_or(0);
  const Eigen::Matrix3d R_BL =
      (X_R[base].Inverse() * X_R[*robot.model.FindLink(name)]).rotation.toRotationMatrix();
  const bool has_name = base::ToLower(name).find("front") != std::string::npos;
  return (R_BL(0, 0) > kAhead ? 1 : 0) + (has_name ? 1 : 0);
}

std::string LaserText(const Robot& robot, const std::string& urdf_xml) {
  const std::vector<std::string> links = LaserLinks(robot, urdf_xml);
  if (links.empty())
    return "laser_link: none is named, so it drives by the map alone, and sees nothing on its way";
  return fmt::format(
      "laser_link: none is named, so it drives by the map alone; by sensor or name a laser is at "
      "{}: write `laser_link: {}` in a profile",
      base::FirstNames(links, kMostNames), links.front());
}

std::string NumbersText(const MotionSet& set) {
  return fmt::format("{:g} m/s, {:g} rad/s, {:g} m/s^2, {:g} rad/s^2", set.max_linear_velocity,
                     set.max_angular_velocity, set.max_linear_acceleration,
                     set.max_angular_acceleration);
}

std::string DriveText(const DriveGuess& guess) {
  std::string text = fmt::format("base_controller.drive: guessed to be {}, because it has {}",
                                 ToString(guess.drive), guess.why);
  return text + "; if that is wrong, write `base_controller: {drive: ..}` in a profile";
}

/// "; 'upper_tray' may be meant: `tray_link: upper_tray`": of links that are called trays, too, and
/// not much smaller.
std::string OtherTraysText(const Robot& robot, const Bounds& bounds) {
  constexpr double kSmaller = 0.5;
  const auto area = [&](std::size_t link) {
    const Eigen::Vector3d size = bounds[link].upper - bounds[link].lower;
    return robot.model.links[link].collisions.empty() ? 0.0 : size.x() * size.y();
  };
  const double least = kSmaller * area(*robot.model.FindLink(robot.profile.tray_link));
  std::vector<std::string> others;
  for (std::size_t i = 0; i < robot.model.links.size(); ++i) {
    const std::string& name = robot.model.links[i].name;
    const bool is_tray = base::ToLower(name).find("tray") != std::string::npos;
    if (is_tray && name != robot.profile.tray_link && area(i) >= least) others.push_back(name);
  }
  if (others.empty()) return "";
  return fmt::format("; {} may be meant as well: `tray_link: {}`",
                     base::FirstNames(others, kMostNames), others.front());
}

std::string TrayText(const Robot& robot, const Bounds& bounds, const IsGiven& is_given) {
  const RobotProfile& profile = robot.profile;
  const Eigen::Vector3d& p = profile.X_TO.translation;
  const TrayPlace place = PlaceOnTray(robot.model, profile.joints, profile.tray_link);
  const std::string where =
      place.taken_by.empty() ? "the middle of its top"
      : place.is_free
          ? fmt::format(
                "the middle of the largest free part of its top, as '{}' "
                "takes the middle",
                place.taken_by)
          : fmt::format("the middle of its top, of which '{}' leaves no part free", place.taken_by);
  return fmt::format(
             "{}: things stand on '{}' at ({:.3f}, {:.3f}, {:.3f}) m of its frame, {}; "
             "`object_on_tray: {{xyz: [..], rpy: [0, 0, 0]}}` in a profile says another "
             "place",
             is_given("tray_link") ? "object_on_tray" : "tray_link", profile.tray_link, p.x(),
             p.y(), p.z(), where) +
         (is_given("tray_link") ? "" : OtherTraysText(robot, bounds));
}

void AddMotion(const Robot& robot, const IsGiven& is_given, std::vector<std::string>* texts) {
  const DriveGuess guess = GuessDrive(robot.model, robot.profile.base_link);
  const bool drives_sideways = robot.profile.base_controller.drive == Drive::kOmnidirectional;
  if (!is_given("base_controller.drive")) {
    texts->push_back(DriveText(guess));
  } else if (!guess.misfit.empty() && !drives_sideways) {
    texts->push_back("base_link: " + guess.misfit);
  }
  std::vector<std::string> missing;
  for (const char* key : {"motion_sets", "base_controller"}) {
    if (!is_given(key)) missing.emplace_back(key);
  }
  if (missing.empty()) return;
  const bool limits = !is_given("motion_sets") && !is_given("base_controller.limits");
  texts->push_back(fmt::format(
      "{}: what the profile does not say is as a PR2 has it (default motion set '{}'{}); write {} "
      "in a profile",
      base::Join(missing, ", "), robot.profile.default_motion_set,
      limits ? ", limits of the base " + NumbersText(robot.profile.base_controller.limits) : "",
      missing.size() == 1 ? "it" : "them"));
}

}  // namespace

std::vector<std::string> LaserLinks(const Robot& robot, const std::string& urdf_xml) {
  std::set<std::string> by_sensor;
  const std::string xml = base::PlainXml(urdf_xml, "URDF");  // was read before
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.c_str(), xml.size()) == tinyxml2::XML_SUCCESS &&
      document.RootElement() != nullptr) {
    const tinyxml2::XMLElement* root = document.RootElement();
    for (const auto* gazebo = root->FirstChildElement("gazebo"); gazebo != nullptr;
         gazebo = gazebo->NextSiblingElement("gazebo")) {
      const char* link = gazebo->Attribute("reference");
      for (const auto* sensor = gazebo->FirstChildElement("sensor");
           link != nullptr && sensor != nullptr; sensor = sensor->NextSiblingElement("sensor")) {
        const char* type = sensor->Attribute("type");
        if (type != nullptr && IsLaserType(type)) by_sensor.insert(link);
      }
    }
  }
  std::vector<std::string> links;
  for (const Link& link : robot.model.links) {
    const std::string lower = base::ToLower(link.name);
    const auto has = [&](const char* word) { return lower.find(word) != std::string::npos; };
    if (by_sensor.count(link.name) > 0 || has("laser") || has("lidar") || has("base_scan"))
      links.push_back(link.name);
  }
  const auto X_R = ForwardKinematics(robot.model, robot.profile.joints);
  const auto claim = [&](const std::string& name) {
    return std::pair(by_sensor.count(name), SignsOfAhead(robot, X_R, name));
  };
  std::stable_sort(links.begin(), links.end(),
                   [&](const std::string& a, const std::string& b) { return claim(a) > claim(b); });
  return links;
}

std::vector<std::string> AssumptionsOf(const Robot& robot, const IsGiven& is_given,
                                       const std::string& urdf_xml, const std::string& urdf_path) {
  std::vector<std::string> texts;
  const Bounds bounds = LinkBounds(robot);
  if (!is_given("footprint")) texts.push_back(FootprintText(robot, bounds));
  if (!HasShapes(robot.model)) {
    texts.push_back(
        fmt::format("shapes: no link has a <collision>, so nothing of it touches anything; its "
                    "ways keep its footprint clear of what stands up to {:g} m over the floor; add "
                    "<collision> shapes to the URDF",
                    kFootprintTop));
  }
  const std::string seen = SeenText(robot, bounds, urdf_xml, urdf_path);
  if (!seen.empty()) texts.push_back(seen);
  const std::vector<std::string> left_out = LeftOut(robot, bounds);
  if (!left_out.empty()) {
    texts.push_back(
        fmt::format("left out of the footprint, as they lie more than {:g} m over the "
                    "floor: {}",
                    kFootprintTop, base::FirstNames(left_out, kMostNames)));
  }
  const std::vector<std::string> at_zero = JointsAtZero(robot, bounds);
  if (!at_zero.empty()) {
    texts.push_back(fmt::format(
        "joints: at 0, or at the limit next to it, stand {}; write `joints: {{{}: ..}}` "
        "in a profile",
        base::FirstNames(at_zero, kMostNames), at_zero.front()));
  }
  if (robot.base_height > 0.0) {
    texts.push_back(fmt::format(
        "base_link: its shapes reach {:.3f} m below it, so it is so high over the floor; "
        "a link base_footprint in the URDF would say it",
        robot.base_height));
  } else if (LowestShape(bounds) > kFloorSlack && !is_given("base_link")) {
    texts.push_back(fmt::format(
        "base_link: '{}' is taken to lie on the floor, its lowest shape {:.3f} m over it",
        robot.profile.base_link, LowestShape(bounds)));
  }
  if (robot.profile.laser_link.empty()) {
    texts.push_back(LaserText(robot, urdf_xml));
  }
  if (!robot.profile.tray_link.empty() && !is_given("object_on_tray"))
    texts.push_back(TrayText(robot, bounds, is_given));
  AddMotion(robot, is_given, &texts);
  return texts;
}

}  // namespace hires::robot
