#include <algorithm>
#include <cmath>

#include "sensing/memory/memory_parts.h"

namespace hires::sensing {
namespace {

using geometry::Pose3;

double DistanceTo(const geometry::Aabb& bounds, const Eigen::Vector3d& p) {
  return (bounds.lower - p).cwiseMax(p - bounds.upper).cwiseMax(0.0).norm();
}

/// What fingers that close along a direction may feel of a box: its height if they close from above
/// and below, else one of its sides (round objects are as wide as their box however it turns).
std::vector<double> WidthsAcross(const geometry::Aabb& bounds, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d size = bounds.upper - bounds.lower;
  if (std::abs(direction.z()) > 0.7) return {size.z()};
  return {size.x(), size.y()};
}

}  // namespace

bool ObjectMemory::Feel(const BodyReading& body) {
  const Links links(*robot_, body);
  bool has_changed = false;
  for (auto& [arm, hand] : hands_) has_changed |= FeelHand(links, arm, &hand, body);
  return has_changed;
}

bool ObjectMemory::FeelHand(const Links& links, const std::string& name, Hand* hand,
                            const BodyReading& body) {
  const robot::ArmProfile& arm = robot_->profile.upper_body->arms.at(name);
  const auto position = body.joints.find(arm.gripper_joint);
  if (position == body.joints.end()) return false;
  const double gap = position->second;
  const double max_gap = robot_->profile.upper_body->gripper.max_gap;
  if (hand->gap < 0.0 && !hand->holds.empty()) hand->grasp_gap = gap;  // believed to hold
  hand->since = std::min(hand->since, body.time);  // the clock may have begun again
  if (hand->gap < 0.0 || std::abs(gap - hand->gap) > params_.still_gap) {
    hand->gap = gap;
    hand->since = body.time;
  }
  if (!hand->holds.empty()) {
    const std::string held = hand->holds;
    const bool is_lost = gap < params_.closed_gap || gap < hand->grasp_gap - params_.gap_below;
    const double most =
        std::min(hand->grasp_gap + params_.opening, max_gap - 0.5 * params_.open_gap);
    if (!is_lost && gap <= most) return false;
    hand->holds.clear();
    is_lost ? Lose(links, held) : LetGo(links, held, body.time);
    return true;
  }
  if (body.time - hand->since < params_.still_time) return false;
  if (gap < params_.closed_gap || gap > max_gap - params_.open_gap) return false;
  const std::string between = Between(links, arm, gap);
  if (between.empty()) return false;
  Take(links, arm, between, hand);
  return true;
}

/// The object that a gap of this width can hold, nearest to the middle between the finger tips.
std::string ObjectMemory::Between(const Links& links, const robot::ArmProfile& arm,
                                  double gap) const {
  const Pose3 X_MT = links.X_ML(arm.tool_link);
  std::string nearest;
  double least = params_.grasp_distance;
  for (const auto& [name, object] : objects_) {
    if (object.is_held) continue;
    const geometry::Aabb bounds = BoundsOf(surroundings_->Model(object.model).collisions);
    const Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
    const Pose3 X_OT = X_MO.Inverse() * X_MT;
    const auto widths = WidthsAcross(bounds, X_OT.rotation * Eigen::Vector3d::UnitY());
    const bool fits = std::any_of(widths.begin(), widths.end(), [&](double width) {
      return gap >= width - params_.gap_below && gap <= width + params_.gap_above;
    });
    if (!fits) continue;
    const double distance = DistanceTo(bounds, X_OT.translation);
    if (distance > least) continue;
    nearest = name;
    least = distance;
  }
  return nearest;
}

void ObjectMemory::Take(const Links& links, const robot::ArmProfile& arm, const std::string& name,
                        Hand* hand) {
  RememberedObject& object = objects_.at(name);
  Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
  const Pose3 X_MT = links.X_ML(arm.tool_link);
  const geometry::Aabb bounds = BoundsOf(surroundings_->Model(object.model).collisions);
  // Fingers close at the same pace and take what they hold between them to the middle.
  const Eigen::Vector3d across_M = X_MT.rotation * Eigen::Vector3d::UnitY();
  const Eigen::Vector3d middle_M = X_MO * (0.5 * (bounds.lower + bounds.upper)).eval();
  X_MO.translation -= across_M.dot(middle_M - X_MT.translation) * across_M;
  // And they touch it: where it was seen beside them, it was seen badly.
  const Eigen::Vector3d p_OT = X_MO.Inverse() * X_MT.translation;
  X_MO.translation +=
      X_MT.translation - X_MO * p_OT.cwiseMax(bounds.lower).cwiseMin(bounds.upper).eval();
  object.link = arm.palm_link;
  object.X_LO = links.X_ML(arm.palm_link).Inverse() * X_MO;
  object.is_held = object.is_observed = true;
  object.num_missed = 0;
  hand->holds = name;
  hand->grasp_gap = hand->gap;
}

/// Whether an object at X_MO may be what the hand that is said to hold it holds.
bool ObjectMemory::IsInHand(const Links& links, const RememberedObject& object,
                            const Pose3& X_MO) const {
  for (const auto& [name, arm] : robot_->profile.upper_body->arms) {
    if (arm.palm_link != object.link) continue;
    const geometry::Aabb bounds = BoundsOf(surroundings_->Model(object.model).collisions);
    const Eigen::Vector3d p_OT = X_MO.Inverse() * links.X_ML(arm.tool_link).translation;
    return DistanceTo(bounds, p_OT) <= params_.grasp_distance;
  }
  return false;
}

/// Where a thing that is seen at X_MO is if a hand holds it: as high and turned as in the hand.
/// What knows kinds by their shape takes all it sees for standing on the table below.
Pose3 ObjectMemory::AsHeld(const Links& links, const std::string& name, const Pose3& X_MO) const {
  const auto known = objects_.find(name);
  if (known == objects_.end() || !known->second.is_held) return X_MO;
  Pose3 X_MHeld = links.X_ML(known->second.link) * known->second.X_LO;
  X_MHeld.translation.head<2>() = X_MO.translation.head<2>();
  return IsInHand(links, known->second, X_MHeld) ? X_MHeld : X_MO;
}

void ObjectMemory::LetGo(const Links& links, const std::string& name, double time) {
  RememberedObject& object = objects_.at(name);
  const Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
  object.is_held = false;
  object.is_observed = true;
  object.time = time;
  object.num_missed = 0;
  PlaceAt(links, X_MO, &object);
}

}  // namespace hires::sensing
