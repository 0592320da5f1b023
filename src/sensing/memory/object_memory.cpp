#include "hires/sensing/object_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/tray.h"
#include "sensing/memory/memory_parts.h"

namespace hires::sensing {

using geometry::Pose3;

geometry::Aabb BoundsOf(const std::vector<geometry::Collision>& collisions) {
  geometry::Aabb bounds;
  for (const geometry::Collision& collision : collisions) {
    bounds.Include(geometry::BoundsOf(collision.shape, collision.X_BS));
  }
  return bounds;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool MemoryParams::operator==(const MemoryParams& other) const {
  const auto numbers = [](const MemoryParams& p) {
    return std::make_tuple(p.expected_share, p.expected_margin, p.expected_size,
                           p.expected_distance, p.looks_to_vanish, p.blending, p.moved_distance,
                           p.moved_angle, p.grasp_distance, p.closed_gap, p.gap_below, p.gap_above,
                           p.open_gap, p.opening, p.still_gap, p.still_time, p.hand_distance,
                           p.instance_distance, p.told_distance, p.instance_margin,
                           p.looks_to_appear, p.scans_to_vanish, p.scans_to_appear);
  };
  return numbers(*this) == numbers(other);
}

Pose3 ObjectMemory::Links::X_ML(const std::string& link) const {
  if (link.empty()) return {};
  const robot::RobotModel& model = robot_.model;
  const auto index = model.FindLink(link);
  if (!index) throw base::ConfigError(base::UnknownName("link", link, model.LinkNames()));
  if (X_RL_.empty()) Place();
  return X_MR_ * X_RL_[*index];
}

void ObjectMemory::Links::Place() const {
  X_RL_ = robot::ForwardKinematics(robot_.model, body_.joints);
  const auto base = robot_.model.FindLink(robot_.profile.base_link);
  X_MR_ = geometry::Lift(body_.X_MB) * (base ? X_RL_[*base].Inverse() : Pose3());
}

ObjectMemory::ObjectMemory(std::shared_ptr<const perception::Surroundings> surroundings,
                           std::shared_ptr<const robot::Robot> robot, const MemoryParams& params)
    : surroundings_(std::move(surroundings)),
      robot_(std::move(robot)),
      params_(params),
      tray_T_(robot::TrayPlateOf(*robot_)) {
  if (!robot_->profile.upper_body) return;
  for (const auto& [arm, unused] : robot_->profile.upper_body->arms) hands_[arm] = {};
}

// ---- Hearsay.

void ObjectMemory::Believe(const std::string& name, const std::string& model,
                           const std::string& link, const Pose3& X_LO) {
  surroundings_->Model(model);
  if (!link.empty() && !robot_->model.FindLink(link)) {
    throw base::ConfigError(fmt::format(
        "object '{}': {}", name, base::UnknownName("link", link, robot_->model.LinkNames())));
  }
  const std::string key = base::ToLower(name);
  const auto known = objects_.find(key);
  if (vanished_.count(key) > 0 || (known != objects_.end() && known->second.is_observed)) return;
  RememberedObject object;
  object.name = key;
  object.model = model;
  object.link = link;
  object.X_LO = X_LO;
  for (auto& [arm, hand] : hands_) {
    const bool is_palm = robot_->profile.upper_body->arms.at(arm).palm_link == link;
    if (hand.holds == key && !is_palm) hand.holds.clear();
    if (!is_palm || (!hand.holds.empty() && hand.holds != key)) continue;
    object.is_held = true;
    hand.holds = key;
    hand.grasp_gap = hand.gap;
  }
  objects_[key] = object;
}

void ObjectMemory::Disbelieve(const std::string& name) {
  const auto known = objects_.find(base::ToLower(name));
  if (known == objects_.end() || known->second.is_observed) return;
  if (Hand* hand = HandOf(known->first)) hand->holds.clear();
  objects_.erase(known);
}

void ObjectMemory::DisbelieveAllBut(const std::vector<std::string>& names) {
  std::vector<std::string> said, unsaid;
  for (const std::string& name : names) said.push_back(base::ToLower(name));
  for (const auto& [name, unused] : objects_) {
    if (!Contains(said, name)) unsaid.push_back(name);
  }
  for (const std::string& name : unsaid) Disbelieve(name);
}

// ---- Places.

void ObjectMemory::Lose(const Links& links, const std::string& name) {
  if (Hand* hand = HandOf(name)) hand->holds.clear();
  const RememberedObject& object = objects_.at(name);
  vanished_[name] = {object.model, PlaceOf(links, object), object.num_points};
  objects_.erase(name);
}

ObjectMemory::Hand* ObjectMemory::HandOf(const std::string& object) {
  for (auto& [arm, hand] : hands_) {
    if (hand.holds == object) return &hand;
  }
  return nullptr;
}

Eigen::Vector3d ObjectMemory::PlaceOf(const Links& links, const RememberedObject& object) const {
  return (links.X_ML(object.link) * object.X_LO).translation;
}

bool ObjectMemory::IsOverTray(const Links& links, const Pose3& X_MO) const {
  if (!tray_T_) return false;
  return robot::IsOverPlate(*tray_T_,
                            links.X_ML(robot_->profile.tray_link).Inverse() * X_MO.translation);
}

void ObjectMemory::PlaceAt(const Links& links, const Pose3& X_MO, RememberedObject* object) const {
  object->link = IsOverTray(links, X_MO) ? robot_->profile.base_link : "";
  object->X_LO = links.X_ML(object->link).Inverse() * X_MO;
}

// ---- What is known.

std::vector<std::string> ObjectMemory::Vanished() const {
  std::vector<std::string> names;
  for (const auto& [name, unused] : vanished_) names.push_back(name);
  return names;
}

int ObjectMemory::num_newcomers() const {
  return num_ambiguous_ + static_cast<int>(std::count_if(
                              newcomers_.begin(), newcomers_.end(), [this](const Newcomer& one) {
                                return one.num_looks < params_.looks_to_appear;
                              }));
}

std::vector<robot::SeenObject> ObjectMemory::Known(const BodyReading& body) const {
  const Links links(*robot_, body);
  std::vector<robot::SeenObject> known;
  for (const auto& [name, object] : objects_) {
    known.push_back({name, object.model, links.X_ML(object.link) * object.X_LO, object.time,
                     object.is_held ? object.link : ""});
  }
  return known;
}

}  // namespace hires::sensing
