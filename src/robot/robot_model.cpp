#include "hires/robot/robot_model.h"

#include <fmt/format.h>
#include <urdf_model/model.h>

#include <algorithm>
#include <cmath>

#include "base/files/plain_xml.h"
#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "robot/limit_stop.h"
#include "robot/model_hash.h"
#include "robot/quiet_urdf_parser.h"
#include "robot/urdf/base_root.h"
#include "robot/urdf/clean_urdf.h"
#include "robot/urdf/read_urdf.h"
#include "robot/urdf/urdf_file.h"
#include "robot/urdf_conversion.h"
#include "robot/urdf_outline.h"

namespace hires::robot {
namespace {

using geometry::Pose3;

[[noreturn]] void Fail(const RobotModel& model, const std::string& what) {
  throw base::ConfigError(fmt::format("robot '{}': {}", model.name, what));
}

bool IsLimited(const Joint& joint) { return joint.limits && joint.type != JointType::kContinuous; }

double RestPosition(const Joint& joint) {
  return IsLimited(joint) ? std::clamp(0.0, joint.limits->lower, joint.limits->upper) : 0.0;
}

void CheckWithinLimits(const RobotModel& model, const Joint& joint, double position) {
  if (!std::isfinite(position)) {
    Fail(model, fmt::format("joint '{}' is at {}, wanted a finite position", joint.name, position));
  }
  if (!IsLimited(joint)) return;
  const double lower = joint.limits->lower, upper = joint.limits->upper;
  if (position >= lower - kLimitSlack && position <= upper + kLimitSlack) return;
  Fail(model, fmt::format("joint '{}' is at {}, wanted between {} and {}", joint.name, position,
                          lower, upper));
}

void CheckNames(const RobotModel& model, const JointPositions& positions) {
  for (const auto& [name, position] : positions) {
    const Joint* joint = FindJoint(model, name);
    if (joint == nullptr) Fail(model, base::UnknownName("joint", name, model.JointNames()));
    if (joint->type == JointType::kFixed) {
      Fail(model, fmt::format("joint '{}' is fixed; leave it out", name));
    }
    if (!joint->mimics.empty()) {
      Fail(model, fmt::format("joint '{}' follows '{}'; set that one", name, joint->mimics));
    }
  }
}

bool Leads(const Link& link) {
  return link.joint && link.joint->type != JointType::kFixed && link.joint->mimics.empty();
}

/// Positions of all joints that lead, by the link that they carry, given or at rest.
/// @throws base::ConfigError for a name that no joint has that leads.
std::vector<double> LeadingPositions(const RobotModel& model, const JointPositions& given) {
  std::vector<double> leading(model.links.size(), 0.0);
  std::size_t num_given = 0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (!Leads(model.links[i])) continue;
    const Joint& joint = *model.links[i].joint;
    const auto found = given.find(joint.name);
    leading[i] = found == given.end() ? RestPosition(joint) : found->second;
    if (found != given.end()) ++num_given;
  }
  if (num_given != given.size()) CheckNames(model, given);  // says which one
  return leading;
}

/// Index of the link whose joint that of `follower` follows. Most come shortly before it.
std::size_t LeaderOf(const RobotModel& model, std::size_t follower) {
  const std::string& name = model.links[follower].joint->mimics;
  const auto is_leader = [&](std::size_t i) {
    return Leads(model.links[i]) && model.links[i].joint->name == name;
  };
  for (std::size_t i = follower; i-- > 0;) {
    if (is_leader(i)) return i;
  }
  for (std::size_t i = follower + 1; i < model.links.size(); ++i) {
    if (is_leader(i)) return i;
  }
  HIRES_CHECK(false, "a joint follows one that leads");
  return 0;
}

double PositionOf(const RobotModel& model, std::size_t link, const std::vector<double>& leading) {
  const Joint& joint = *model.links[link].joint;
  if (joint.type == JointType::kFixed) return 0.0;
  if (joint.mimics.empty()) return leading[link];
  const double wanted =
      joint.mimic_multiplier * leading[LeaderOf(model, link)] + joint.mimic_offset;
  return IsLimited(joint) ? StoppedAt(joint.limits->lower, joint.limits->upper, wanted) : wanted;
}

/// The child's frame C in the joint's frame J.
Pose3 Displacement(const Joint& joint, double position) {
  switch (joint.type) {
    case JointType::kRevolute:
    case JointType::kContinuous:
      return {Eigen::Vector3d::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(position, joint.axis))};
    case JointType::kPrismatic:
      return {position * joint.axis, Eigen::Quaterniond::Identity()};
    default:
      return {};
  }
}

std::string FrozenName(const Link& link, std::size_t index) {
  const std::string& own = link.collisions[index].name;
  if (!own.empty()) return link.name + "/" + own;
  return link.collisions.size() == 1 ? link.name : fmt::format("{}/{}", link.name, index + 1);
}

}  // namespace

std::optional<int> RobotModel::FindLink(const std::string& wanted) const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == wanted) return static_cast<int>(i);
  }
  return std::nullopt;
}

std::vector<std::string> RobotModel::LinkNames() const {
  std::vector<std::string> names;
  for (const Link& link : links) names.push_back(link.name);
  return names;
}

std::vector<std::string> RobotModel::JointNames() const {
  std::vector<std::string> names;
  for (const Link& link : links) {
    if (link.joint && link.joint->type != JointType::kFixed && link.joint->mimics.empty()) {
      names.push_back(link.joint->name);
    }
  }
  return names;
}

bool HasShapes(const RobotModel& model) {
  return std::any_of(model.links.begin(), model.links.end(),
                     [](const Link& link) { return !link.collisions.empty(); });
}

const Joint* FindJoint(const RobotModel& model, const std::string& name) {
  for (const Link& link : model.links) {
    if (link.joint && link.joint->name == name) return &*link.joint;
  }
  return nullptr;
}

std::optional<int> FindLinkOf(const RobotModel& model, const std::string& joint) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (model.links[i].joint && model.links[i].joint->name == joint) return static_cast<int>(i);
  }
  return std::nullopt;
}

bool IsBelow(const RobotModel& model, int link, int above) {
  while (link > above) link = model.links[link].joint->parent;  // parents come before children
  return link == above;
}

UrdfReading ReadUrdf(const std::string& raw_xml, const std::string& where) {
  const std::string xml = base::PlainXml(raw_xml, where);
  // The outline first: it names lines, and it refuses nesting so deep that urdfdom would crash.
  UrdfProblems problems(where);
  const UrdfOutline outline = ReadUrdfOutline(xml, &problems);
  const CleanUrdf clean = CleanedUrdf(xml, outline, where, &problems);
  UrdfReading reading = ConvertUrdf(*ParseUrdfQuietly(clean.xml, where, &problems), outline,
                                    clean.shape_lines, where, &problems);
  problems.ThrowIfAny();
  reading.base_note = RootAtBase(&reading.model);
  reading.model.hash = HashOf(reading.model);
  return reading;
}

RobotModel LoadRobotModel(const std::string& urdf_path) {
  const UrdfFile file = SplitArguments(urdf_path);
  return ParseRobotModel(ReadUrdfFile(file), file.path);
}

RobotModel ParseRobotModel(const std::string& urdf_xml, const std::string& where) {
  UrdfReading reading = ReadUrdf(urdf_xml, where);
  for (const std::string& doubt : reading.doubts)
    base::Log(base::LogLevel::kWarn, fmt::format("urdf={} {}", where, doubt));
  return std::move(reading.model);
}

std::vector<Pose3> ForwardKinematics(const RobotModel& model, const JointPositions& positions) {
  const std::vector<double> leading = LeadingPositions(model, positions);
  std::vector<Pose3> X_R;  // of each link in the root's frame
  X_R.reserve(model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const std::optional<Joint>& joint = model.links[i].joint;
    if (!joint) {
      X_R.emplace_back();
      continue;
    }
    const double position = PositionOf(model, i, leading);
    CheckWithinLimits(model, *joint, position);
    X_R.push_back(X_R[joint->parent] * joint->X_PJ * Displacement(*joint, position));
  }
  return X_R;
}

std::vector<geometry::Collision> FrozenCollisions(const RobotModel& model,
                                                  const JointPositions& positions) {
  const std::vector<Pose3> X_R = ForwardKinematics(model, positions);
  std::vector<geometry::Collision> frozen;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Link& link = model.links[i];
    for (std::size_t k = 0; k < link.collisions.size(); ++k) {
      frozen.push_back(link.collisions[k]);
      frozen.back().name = FrozenName(link, k);
      frozen.back().X_BS = X_R[i] * link.collisions[k].X_BS;
    }
  }
  return frozen;
}

}  // namespace hires::robot
