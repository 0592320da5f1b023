#include "hires/ros/sim_robot_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hires_ros {
namespace {

constexpr double kToppled = 0.5;  // [rad] alpha_t of Eq. 5.1
constexpr double kUpright = 0.1;  // [rad]
constexpr double kDropped = 0.3;  // [m]

}  // namespace

void TruthRecord::Look(const hires::simulation::RobotSimulator& simulator) {
  for (const auto& object : simulator.GetWorldState().objects) LookAt(object);
  const hires::geometry::Pose2& X_MB = simulator.base().X_MB;
  if (last_) distance_ += std::hypot(X_MB.x - last_->x, X_MB.y - last_->y);
  last_ = X_MB;
  if (contact_.empty() && simulator.contact()) {
    contact_ = fmt::format("{} touches {}", simulator.contact()->robot_part,
                           simulator.contact()->obstacle);
  }
}

void TruthRecord::LookAt(const hires::world::ObjectState& object) {
  const bool is_new = objects_.count(object.name) == 0;
  ObjectFate& fate = objects_[object.name];
  const double height = object.X_MO.translation.z();
  const bool is_held = !object.attached_to.empty();
  fate.tilt = hires::geometry::TiltOf(object.X_MO.rotation);
  fate.max_tilt = std::max(fate.max_tilt, fate.tilt);
  if (is_new || is_held) fate.held_up = height;
  const bool has_dropped = !is_held && height < fate.held_up - kDropped;
  if (!fate.is_down && !is_held && (fate.tilt >= kToppled || has_dropped)) {
    fate.is_down = true;
    ++fate.falls;
  }
  if (fate.tilt < kUpright && !has_dropped) {
    fate.is_down = false;
    fate.held_up = height;
  }
}

int TruthRecord::falls() const {
  int falls = 0;
  for (const auto& [name, fate] : objects_) falls += fate.falls;
  return falls;
}

}  // namespace hires_ros
