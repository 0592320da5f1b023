#include "imagination/rollout/load_monitor.h"

#include <algorithm>

#include "hires/base/text.h"
#include "hires/imagination/rollout.h"
#include "hires/world/fall_code.h"

namespace hires::imagination {
namespace {

using geometry::Pose3;
using world::Fall;
using Code = base::FailureCode;

constexpr double kCauseWindow = 0.3;  // [s] how far back a cause may lie
constexpr double kStillSpeed = 0.01;  // [m/s] below which an object stands still

}  // namespace

std::string CauseNow(const simulation::RobotSimulator& simulator) {
  const simulation::Disturbances& last = simulator.disturbances();
  const double since = simulator.time() - kCauseWindow;
  if (last.late_command >= since) return "late_command";
  if (last.braking >= since) return "braking";
  if (last.accelerating >= since) return "accelerating";
  if (last.turning >= since) return "turning";
  return "floor";
}

bool FellWhileSettling(const simulation::RobotSimulator& simulator, int object,
                       const Pose3& X_BOstart, const world::StandingCriterion& standing) {
  const std::vector<int>& carried = simulator.carried();
  if (std::count(carried.begin(), carried.end(), object) == 0) return false;
  const Pose3 X_MO = simulator.PoseOf(object);
  if (!world::IsUpright(standing, X_MO) || simulator.StandsOnRobot(object)) return false;
  const Pose3 X_BO = simulator.X_MB().Inverse() * X_MO;
  return world::IsAway(standing, world::DepartureFrom(X_BOstart, X_BO));
}

LoadMonitor::LoadMonitor(simulation::RobotSimulator* simulator, const RolloutParams& params,
                         const world::StandingCriterion& standing, const Purpose& purpose,
                         const std::vector<Pose3>& X_BOstart)
    : simulator_(simulator), params_(params), standing_(standing), purpose_(purpose) {
  Sort(purpose);
  if (!X_BOstart.empty()) NoteFallsWhileSettling(X_BOstart);
}

void LoadMonitor::NoteFallsWhileSettling(const std::vector<Pose3>& X_BOstart) {
  for (Object& object : objects_) {
    if (!FellWhileSettling(*simulator_, object.index, X_BOstart[object.index], standing_)) continue;
    object.fell_while_settling = true;
    ++falls_;
    NoteFall(FailureOf(object, Fall::kDropped));
    if (params_.put_back && object.is_load) PutBackIfDown(&object);
  }
}

void LoadMonitor::Sort(const Purpose& purpose) {
  const simulation::FallWatch watch(standing_);
  const std::vector<int>& carried = simulator_->carried();
  const std::vector<world::ObjectState> all = simulator_->GetWorldState().objects;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const bool is_handled = !purpose.object.empty() && base::ToLower(all[i].name) == purpose.object;
    const bool stands_on_robot = std::count(carried.begin(), carried.end(), i) > 0;
    const bool is_held = !all[i].attached_to.empty();
    if (is_handled) handled_ = static_cast<int>(objects_.size());
    const std::string name = base::ToLower(all[i].name);
    if (is_handled || stands_on_robot || is_held) {
      objects_.push_back({i, name, stands_on_robot && !is_handled, is_held, watch});
    } else if (simulator_->IsBall(i) || world::IsUpright(standing_, all[i].X_MO)) {
      bystanders_.push_back({i, name, watch});
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
  LookAtBystanders();
  max_tilt_ = std::max(max_tilt_, tilt_);
  if (first_cause_.empty() && tilt_ > params_.shaking_tilt) first_cause_ = CauseNow(*simulator_);
}

/// What moves by its own weight alone stands where it has come to; what fell over like that is no
/// bystander any more.
void LoadMonitor::LookAtBystanders() {
  const auto fell_alone = [this](Bystander& bystander) {
    bystander.watch.Look(*simulator_, bystander.index);
    if (!bystander.watch.detector().is_down() || simulator_->IsReached(bystander.index)) {
      return false;
    }
    bystander.watch.Reset();
    return !simulator_->IsBall(bystander.index) &&
           !world::IsUpright(standing_, simulator_->PoseOf(bystander.index));
  };
  const auto kept = std::remove_if(bystanders_.begin(), bystanders_.end(), fell_alone);
  bystanders_.erase(kept, bystanders_.end());
}

void LoadMonitor::LookAt(Object* object) {
  const int falls_before = object->watch.detector().falls();
  const Fall fall = object->watch.Look(*simulator_, object->index);
  NoteFall(FailureOf(*object, fall));
  if (fall == Fall::kLost) {
    lost_ = FailureOf(*object, fall);
    return;
  }
  tilt_ = std::max(tilt_, object->watch.detector().now().tilt);
  if (!object->fell_while_settling) falls_ += object->watch.detector().falls() - falls_before;
  if (params_.put_back && object->is_load) PutBackIfDown(object);
}

/// What fell is put back once it lies, or is far from where it stood.
void LoadMonitor::PutBackIfDown(Object* object) {
  const world::FallDetector& detector = object->watch.detector();
  const world::Departure& now = detector.now();
  const bool lies = now.tilt > params_.put_back_tilt;
  const bool is_down = detector.is_down() && (lies || world::IsAway(standing_, now));
  if (!is_down && !object->fell_while_settling) return;
  object->fell_while_settling = false;
  simulator_->PutBack(object->index);
  object->watch.Reset();
}

/// Of several that fall alike, all are named. What falls is worse than what slid before.
void LoadMonitor::NoteFall(const base::Failure& fall) {
  if (!fall) return;
  const bool is_worse = first_fall_.code == Code::kObjectSlid && fall.code != Code::kObjectSlid;
  if (!first_fall_ || is_worse) first_fall_ = fall;
  std::vector<std::string>& names = first_fall_.subjects;
  if (fall.code != first_fall_.code || names == fall.subjects) return;
  const auto place = std::lower_bound(names.begin(), names.end(), fall.subjects.front());
  if (place == names.end() || *place != fall.subjects.front()) {
    names.insert(place, fall.subjects.front());
  }
}

base::Failure LoadMonitor::FailureOf(const Object& object, Fall fall) const {
  if (fall == Fall::kNone) return {};
  const world::FallenThing thing = object.is_load      ? world::FallenThing::kLoad
                                   : IsHandled(object) ? world::FallenThing::kHandled
                                                       : world::FallenThing::kHeld;
  return {world::CodeOf(fall, thing), {object.name}};
}

OutcomeCounts LoadMonitor::Sample() const {
  return objects_.empty() ? OutcomeCounts() : SampleOf(tilt_, params_);
}

bool LoadMonitor::Moves(int index) const {
  return simulator_->VelocityOf(index).linear.norm() > kStillSpeed;
}

/// It leans, or slides, and may come to fall.
bool LoadMonitor::MayFall(const Object& object) const {
  const world::FallDetector& detector = object.watch.detector();
  if (detector.fall() == Fall::kSlid) return Moves(object.index);
  return detector.now().tilt > params_.shaking_tilt && !detector.is_down();
}

bool LoadMonitor::IsSettled() const {
  if (std::any_of(objects_.begin(), objects_.end(), [&](const Object& o) { return MayFall(o); })) {
    return false;
  }
  const bool is_put_down =
      purpose_.kind == Purpose::Kind::kPutOnArea || purpose_.kind == Purpose::Kind::kPutOnTray;
  if (handled_ >= 0 && is_put_down && Moves(objects_[handled_].index)) return false;
  // What has fallen may go on rolling; nothing more depends on it.
  return std::none_of(bystanders_.begin(), bystanders_.end(), [&](const Bystander& bystander) {
    return Moves(bystander.index) && !bystander.watch.detector().is_down();
  });
}

std::vector<std::string> LoadMonitor::KnockedOver() const {
  std::vector<std::string> names;
  for (const Bystander& bystander : bystanders_) {
    if (bystander.watch.detector().is_down()) names.push_back(bystander.name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> LoadMonitor::Down() const {
  std::vector<std::string> names;
  for (const Object& object : objects_) {
    if (object.watch.detector().is_down() || object.fell_while_settling) {
      names.push_back(object.name);
    }
  }
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
  const Fall fall = object.watch.detector().fall();
  if (fall == Fall::kNone) return {Code::kObjectSlipped, {object.name}};
  return FailureOf(object, fall);
}

/// Where the object was to be put: the frame of the area, or the middle of the tray.
Pose3 LoadMonitor::X_MGoal() const {
  const simulation::Scene& scene = simulator_->scene();
  if (purpose_.kind == Purpose::Kind::kPutOnTray) return simulator_->X_MB() * scene.X_BO;
  return scene.world.FindFrame(purpose_.area).value_or(Pose3());
}

/// The tray's middle has the square of an area that nothing is said of.
Eigen::AlignedBox2d LoadMonitor::ExtentOfGoal() const {
  const std::string area = purpose_.kind == Purpose::Kind::kPutOnTray ? "" : purpose_.area;
  return world::Inset(simulator_->scene().world.ExtentOf(area), purpose_.area_edge);
}

base::Failure LoadMonitor::WhyNotStanding(const Object& object) const {
  if (IsHeld(object)) return {Code::kObjectNotReleased, {object.name}};
  const Fall fall = object.watch.detector().fall();
  if (fall != Fall::kNone) return FailureOf(object, fall);
  const Eigen::Vector3d p_GO = (X_MGoal().Inverse() * simulator_->PoseOf(object.index)).translation;
  if (p_GO.z() < -standing_.drop) {  // it stands on something lower
    return {Code::kObjectFell, {object.name}};
  }
  const bool is_there = ExtentOfGoal().contains(p_GO.head<2>().eval());
  return is_there ? base::Failure() : base::Failure(Code::kObjectSlipped, {object.name});
}

base::Failure LoadMonitor::WhyNotHeldAnyMore() const {
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const Object& object = objects_[i];
    if (i != handled_ && object.was_held && !IsHeld(object)) {
      return {Code::kObjectSlipped, {object.name}};
    }
  }
  return {};
}

}  // namespace hires::imagination
