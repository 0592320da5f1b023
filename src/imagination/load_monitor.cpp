#include "hires/imagination/load_monitor.h"

#include <algorithm>

#include "hires/base/text.h"
#include "hires/imagination/rollout.h"

namespace hires::imagination {
namespace {

using geometry::Pose3;
using Code = base::FailureCode;

constexpr double kCauseWindow = 0.3;  // [s] how far back a cause may lie
constexpr double kDrop = 0.05;        // [m] lower than where it stood: fallen off
constexpr double kStillSpeed = 0.01;  // [m/s] below which an object stands still

}  // namespace

LoadMonitor::LoadMonitor(simulation::RobotSimulator* simulator, const RolloutParams& params,
                         const Purpose& purpose)
    : simulator_(simulator), params_(params), purpose_(purpose) {
  Sort(purpose);
}

void LoadMonitor::Sort(const Purpose& purpose) {
  const Pose3 X_BM = simulator_->X_MB().Inverse();
  const std::vector<int>& carried = simulator_->carried();
  const std::vector<world::ObjectState> all = simulator_->GetWorldState().objects;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const bool is_handled = !purpose.object.empty() && base::ToLower(all[i].name) == purpose.object;
    const bool stands_on_robot = std::count(carried.begin(), carried.end(), i) > 0;
    const bool is_held = !all[i].attached_to.empty();
    if (is_handled) handled_ = static_cast<int>(objects_.size());
    if (is_handled || stands_on_robot || is_held) {
      objects_.push_back({i, X_BM * all[i].X_MO, stands_on_robot && !is_handled, is_held, false});
    } else if (geometry::TiltOf(all[i].X_MO.rotation) < params_.topple_tilt) {
      bystanders_.push_back({i, base::ToLower(all[i].name), all[i].X_MO.translation.z()});
    }
  }
}

bool LoadMonitor::IsHandled(const Object& object) const {
  return handled_ >= 0 && &object == &objects_[handled_];
}

bool LoadMonitor::IsHeld(const Object& object) const {
  return !simulator_->HolderOf(object.index).empty();
}

void LoadMonitor::Look() {
  tilt_ = 0.0;
  for (Object& object : objects_) LookAt(&object);
  max_tilt_ = std::max(max_tilt_, tilt_);
  if (first_cause_.empty() && tilt_ > params_.shaking_tilt) first_cause_ = Cause();
}

void LoadMonitor::LookAt(Object* object) {
  const Pose3 X_MO = simulator_->PoseOf(object->index);
  if (!X_MO.IsFinite()) {
    is_lost_ = true;
    return;
  }
  const double tilt = geometry::TiltOf(X_MO.rotation);
  tilt_ = std::max(tilt_, tilt);
  const bool lies = tilt >= params_.topple_tilt;
  if (!object->is_load) {
    // What a hand holds may lean, it cannot fall.
    const bool falls = lies && !object->has_fallen && !IsHeld(*object);
    if (falls) {
      NoteFall(object, object->was_held && !IsHandled(*object) ? Code::kObjectSlipped
                                                               : Code::kObjectToppled);
    }
    return;
  }
  const Pose3 X_BO = simulator_->X_MB().Inverse() * X_MO;
  const bool slid = (X_BO.translation - object->X_BO.translation).norm() > params_.lost_distance;
  if (!object->has_fallen && (lies || slid)) {
    NoteFall(object, lies ? Code::kObjectFell : Code::kObjectSlid);
  }
  if (params_.put_back && object->has_fallen && (slid || tilt > params_.put_back_tilt)) {
    simulator_->PutBack(object->index);
    object->has_fallen = false;
  }
}

void LoadMonitor::NoteFall(Object* object, Code code) {
  object->has_fallen = true;
  ++falls_;
  if (!first_fall_) first_fall_ = code;
}

OutcomeCounts LoadMonitor::Sample() const {
  OutcomeCounts counts;
  if (objects_.empty()) return counts;
  if (tilt_ <= params_.shaking_tilt) {
    counts.notopple = 1;
  } else if (tilt_ >= params_.topple_tilt) {
    counts.topple = 1;
  } else {
    counts.shaking = 1;
  }
  return counts;
}

bool LoadMonitor::Moves(int index) const {
  return simulator_->VelocityOf(index).linear.norm() > kStillSpeed;
}

bool LoadMonitor::IsSettled() const {
  if (tilt_ > params_.shaking_tilt && tilt_ < params_.topple_tilt) return false;
  const bool is_put_down =
      purpose_.kind == Purpose::Kind::kPutOnArea || purpose_.kind == Purpose::Kind::kPutOnTray;
  if (handled_ >= 0 && is_put_down && Moves(objects_[handled_].index)) return false;
  // What has fallen may roll on for ever; nothing more depends on it.
  return std::none_of(bystanders_.begin(), bystanders_.end(), [&](const Bystander& bystander) {
    return Moves(bystander.index) && !HasFallen(bystander);
  });
}

bool LoadMonitor::HasFallen(const Bystander& bystander) const {
  const Pose3 X_MO = simulator_->PoseOf(bystander.index);
  return geometry::TiltOf(X_MO.rotation) >= params_.topple_tilt ||
         X_MO.translation.z() < bystander.height - kDrop;
}

std::vector<std::string> LoadMonitor::KnockedOver() const {
  std::vector<std::string> names;
  for (const Bystander& bystander : bystanders_) {
    if (HasFallen(bystander)) names.push_back(bystander.name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

void LoadMonitor::Conclude() {
  Look();
  falls_ += static_cast<int>(KnockedOver().size());
}

base::Failure LoadMonitor::WhyNotWell() const {
  base::Failure why = WhyHandledIsNotWell();
  if (!why) why = first_fall_;
  if (!why) why = WhyNotHeldAnyMore();
  const std::vector<std::string> knocked_over = KnockedOver();
  if (!why && !knocked_over.empty()) why = {Code::kKnockedOver, knocked_over};
  return why;
}

base::Failure LoadMonitor::WhyHandledIsNotWell() const {
  if (handled_ < 0) return {};
  const Object& object = objects_[handled_];
  return purpose_.kind == Purpose::Kind::kTake ? WhyNotTaken(object) : WhyNotStanding(object);
}

base::Failure LoadMonitor::WhyNotTaken(const Object& object) const {
  const auto held = simulator_->held();
  const auto hand = held.find(purpose_.arm);
  if (hand != held.end() && hand->second == object.index) return {};
  const double z_start = (simulator_->X_MB() * object.X_BO).translation.z();
  const double z = simulator_->PoseOf(object.index).translation.z();
  return z < z_start - kDrop ? Code::kObjectFell
         : object.has_fallen ? Code::kObjectToppled
                             : Code::kObjectSlipped;
}

/// Where the object was to be put: the frame of the area, or the middle of the tray.
Pose3 LoadMonitor::X_MGoal() const {
  const simulation::Scene& scene = simulator_->scene();
  if (purpose_.kind == Purpose::Kind::kPutOnTray) return simulator_->X_MB() * scene.X_BO;
  return scene.world.FindFrame(purpose_.area).value_or(Pose3());
}

base::Failure LoadMonitor::WhyNotStanding(const Object& object) const {
  if (IsHeld(object)) return Code::kObjectNotReleased;
  const Pose3 X_MO = simulator_->PoseOf(object.index);
  const Pose3 X_GO = X_MGoal().Inverse() * X_MO;
  if (X_GO.translation.z() < -kDrop) return Code::kObjectFell;
  if (geometry::TiltOf(X_MO.rotation) >= params_.topple_tilt) return Code::kObjectToppled;
  const double away = X_GO.translation.head<2>().cwiseAbs().maxCoeff();
  return away > purpose_.area_half_width ? Code::kObjectSlipped : base::Failure();
}

base::Failure LoadMonitor::WhyNotHeldAnyMore() const {
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const Object& object = objects_[i];
    if (i != handled_ && object.was_held && !IsHeld(object)) return Code::kObjectSlipped;
  }
  return {};
}

std::string LoadMonitor::Cause() const {
  const simulation::Disturbances& last = simulator_->disturbances();
  const double since = simulator_->time() - kCauseWindow;
  if (last.late_command >= since) return "late_command";
  if (last.braking >= since) return "braking";
  if (last.accelerating >= since) return "accelerating";
  if (last.turning >= since) return "turning";
  return "floor";
}

}  // namespace hires::imagination
