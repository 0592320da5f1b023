#include "hires/imagination/load_monitor.h"

#include <algorithm>

#include "hires/imagination/rollout.h"

namespace hires::imagination {
namespace {
constexpr double kCauseWindow = 0.3;  // [s] how far back a cause may lie
}

LoadMonitor::LoadMonitor(simulation::RobotSimulator* simulator, const RolloutParams& params)
    : simulator_(simulator), params_(params) {
  const geometry::Pose3 X_BM = simulator->X_MB().Inverse();
  for (const int index : simulator->carried()) {
    objects_.push_back({index, X_BM * simulator->PoseOf(index), false});
  }
}

void LoadMonitor::Look() {
  tilt_ = 0.0;
  for (Object& object : objects_) LookAt(&object);
  max_tilt_ = std::max(max_tilt_, tilt_);
  if (first_cause_.empty() && tilt_ > params_.shaking_tilt) first_cause_ = Cause();
}

void LoadMonitor::LookAt(Object* object) {
  const geometry::Pose3 X_MO = simulator_->PoseOf(object->index);
  if (!X_MO.IsFinite()) {
    is_lost_ = true;
    return;
  }
  const double tilt = geometry::TiltOf(X_MO.rotation);
  tilt_ = std::max(tilt_, tilt);
  const geometry::Pose3 X_BO = simulator_->X_MB().Inverse() * X_MO;
  const bool slid = (X_BO.translation - object->X_BO.translation).norm() > params_.lost_distance;
  if (!object->has_fallen && (tilt >= params_.topple_tilt || slid)) {
    NoteFall(object, tilt, slid);
  }
  if (params_.put_back && object->has_fallen && (slid || tilt > params_.put_back_tilt)) {
    simulator_->PutBack(object->index);
    object->has_fallen = false;
  }
}

void LoadMonitor::NoteFall(Object* object, double tilt, bool slid) {
  object->has_fallen = true;
  ++falls_;
  if (first_fall_.empty()) {
    first_fall_ = slid && tilt < params_.topple_tilt ? "object_slid" : "object_fell";
  }
}

OutcomeCounts LoadMonitor::Sample() const {
  OutcomeCounts counts;
  if (tilt_ <= params_.shaking_tilt) {
    counts.notopple = 1;
  } else if (tilt_ >= params_.topple_tilt) {
    counts.topple = 1;
  } else {
    counts.shaking = 1;
  }
  return counts;
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
