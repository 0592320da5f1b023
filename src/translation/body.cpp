#include "translation/body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"

namespace hires::translation {
namespace {

using JointList = std::vector<double>;

double DistanceBetween(const robot::RobotModel& model, const std::string& joint, double a,
                       double b) {
  const robot::Joint* found = robot::FindJoint(model, joint);
  const bool turns_round = found && found->type == robot::JointType::kContinuous;
  return std::abs(turns_round ? geometry::WrapToPi(a - b) : a - b);
}

double DistanceTo(const robot::Robot& robot, const robot::ArmProfile& arm,
                  const robot::JointPositions& joints, const JointList& variant) {
  double distance = 0.0;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const auto position = joints.find(arm.joints[i]);
    const double is = position == joints.end() ? 0.0 : position->second;
    distance += DistanceBetween(robot.model, arm.joints[i], is, variant[i]);
  }
  return distance;
}

/// All that the name stands for.
std::vector<JointList> VariantsOf(const robot::ArmProfile& arm, const std::string& posture) {
  std::vector<JointList> variants;
  const auto named = arm.postures.find(posture);
  if (named != arm.postures.end()) variants = named->second;
  const auto holding = arm.holding_postures.find(posture);
  if (holding != arm.holding_postures.end()) variants.push_back(holding->second);
  return variants;
}

/// The posture that an object is carried in, else any; turned in the shoulder until it has no name.
std::optional<JointList> UnnamedJoints(const robot::Robot& robot, const robot::ArmProfile& arm,
                                       bool holds) {
  std::string base = "armcarryposture";
  if (VariantsOf(arm, base).empty() && !arm.postures.empty()) base = arm.postures.begin()->first;
  const auto start = ArmJointsFor(robot, arm, base, holds);
  if (!start) return std::nullopt;
  const robot::Joint* shoulder = robot::FindJoint(robot.model, arm.joints.front());
  for (const double turn : {0.6, -0.6, 1.0, -1.0}) {
    JointList turned = *start;
    turned.front() += turn;
    const bool has_limits =
        shoulder && shoulder->limits && shoulder->type != robot::JointType::kContinuous;
    if (has_limits &&
        (turned.front() < shoulder->limits->lower || turned.front() > shoulder->limits->upper)) {
      continue;
    }
    robot::JointPositions joints;
    for (std::size_t i = 0; i < turned.size(); ++i) joints[arm.joints[i]] = turned[i];
    if (NameArmPosture(robot, arm, joints, {}) == kUnnamedArmPosture) return turned;
  }
  return start;
}

}  // namespace

Body::Body(const robot::Robot& robot, const robot::RobotState& state)
    : model_(&robot.model), X_RL_(robot::ForwardKinematics(robot.model, state.joints)) {
  X_MR_ = geometry::Lift(state.X_MB);
  if (const auto base = robot.model.FindLink(robot.profile.base_link)) {
    X_MR_ = X_MR_ * X_RL_[*base].Inverse();
  }
}

geometry::Pose3 Body::X_ML(const std::string& link) const {
  const auto index = model_->FindLink(link);
  if (!index) throw base::ConfigError(base::UnknownName("link", link, model_->LinkNames()));
  return X_MR_ * X_RL_[*index];
}

std::string NameArmPosture(const robot::Robot& robot, const robot::ArmProfile& arm,
                           const robot::JointPositions& joints, const PostureParams& params) {
  std::string nearest = kUnnamedArmPosture;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [name, unused] : arm.postures) {
    double tolerance = name == "armtuckedposture" ? params.tucked : params.others;
    if (name == params.before) tolerance *= params.hysteresis;
    for (const JointList& variant : VariantsOf(arm, name)) {
      const double distance = DistanceTo(robot, arm, joints, variant);
      if (distance > tolerance || distance >= least) continue;
      nearest = name;
      least = distance;
    }
  }
  return nearest;
}

std::optional<JointList> ArmJointsFor(const robot::Robot& robot, const robot::ArmProfile& arm,
                                      const std::string& posture, bool holds) {
  if (posture == kUnnamedArmPosture) return UnnamedJoints(robot, arm, holds);
  const auto holding = arm.holding_postures.find(posture);
  if (holds && holding != arm.holding_postures.end()) return holding->second;
  const auto named = arm.postures.find(posture);
  if (named == arm.postures.end() || named->second.empty()) return std::nullopt;
  return named->second.front();
}

std::optional<double> TorsoHeightFor(const robot::UpperBodyProfile& body,
                                     const std::string& posture) {
  const auto named = body.torso_postures.find(posture);
  if (named != body.torso_postures.end()) return named->second;
  if (posture != kUnnamedTorsoPosture) return std::nullopt;
  std::vector<double> heights;
  for (const auto& [name, height] : body.torso_postures) heights.push_back(height);
  std::sort(heights.begin(), heights.end());
  if (heights.size() < 2) return std::nullopt;
  return (heights[0] + heights[1]) / 2;
}

}  // namespace hires::translation
