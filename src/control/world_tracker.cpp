#include "hires/control/world_tracker.h"

#include <algorithm>
#include <limits>

#include "hires/base/action.h"
#include "hires/translation/task_places.h"
#include "hires/world/unknown_box.h"

namespace hires::control {
namespace {

constexpr double kKnownPeriod = 0.1;  // [s] at most, between words about known objects
constexpr double kNever = -1e9;       // [s]
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kAbout = 0.2;  // [m] about an object, where all that is seen is the object

/// Whether a thing on the floor is an object that lies or stands there.
bool Explains(const robot::SeenObject& object, const robot::SeenObject& thing) {
  const Eigen::Vector3d size = world::SizeOfUnknownBox(thing.model);
  const Eigen::Vector3d p_TO = thing.X_MO.Inverse() * object.X_MO.translation;
  const Eigen::Vector2d farthest = p_TO.head<2>().cwiseAbs() + 0.5 * size.head<2>();
  return object.attached_to.empty() && p_TO.z() < size.z() && farthest.norm() <= kAbout;
}

}  // namespace

world::WorldState WorldOf(const std::vector<robot::SeenObject>& known) {
  world::WorldState state;
  for (const robot::SeenObject& object : known) {
    state.objects.push_back({object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  return state;
}

WorldTracker::WorldTracker(const sensing::RobotStateEstimator* state,
                           sensing::ObjectEstimator* objects, sensing::FloorWatch* floor,
                           HeadSweep sweep, bool lockstep, Hooks hooks)
    : state_(*state),
      objects_(*objects),
      floor_(floor),
      sweep_(std::move(sweep)),
      lockstep_(lockstep),
      hooks_(std::move(hooks)),
      time_(kNever),
      published_(kNever) {}

void WorldTracker::Process() {
  while (const auto time = NextMoment()) Handle(*time);
}

std::vector<std::string> WorldTracker::OnView(const translation::TranslatorContext& context,
                                              const knowledge::FluentView& fluents) {
  const translation::TranslatorContext now = translation::WithKnowledge(context, fluents);
  std::vector<sensing::StatedObject> stated;
  for (const auto& object : translation::StatedObjects(now, fluents)) {
    if (StandsOnFloor(object.name)) continue;  // its own words
    stated.push_back({object.name, object.model, object.link, object.X_LO});
  }
  std::vector<std::string> doubts = objects_.OnStated(stated);
  sweep_.SetPlaces(translation::PlacesOfTasks(now, fluents), now.areas);
  return doubts;
}

void WorldTracker::OnTemperatures(const std::map<std::string, double>& degrees) {
  for (const auto& [object, temperature] : degrees) {
    if (!IsHearsay(object)) temperatures_[object] = temperature;
  }
}

void WorldTracker::OnActions(const actions::Catalogue& catalogue,
                             const std::vector<std::string>& names) {
  const bool is_busy = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return actions::MayUseHead(catalogue, base::CanonicalName(name));
  });
  sweep_.SetBusy(is_busy, time_);
}

/// The next joint states or look, once nothing can change any more what is known of that time.
std::optional<double> WorldTracker::NextMoment() const {
  const double last = restarts_ != state_.num_restarts() ? kNever : time_;
  const auto joints = state_.NextJoints(last);
  const auto look = objects_.NextLook(last);
  if (!joints && !look) return std::nullopt;
  const double next = std::min(joints.value_or(kForever), look.value_or(kForever));
  if (!state_.IsSettled(next)) return std::nullopt;
  return next;
}

void WorldTracker::Handle(double time) {
  if (restarts_ != state_.num_restarts()) published_ = kNever;
  restarts_ = state_.num_restarts();
  time_ = time;
  lack_ = state_.MissingAt(time);
  if (lack_ != sensing::Missing::kNothing) {
    ++num_dropped_;
    objects_.DropUntil(time);  // else it would be the next moment for good
    return;
  }
  ++num_moments_;
  const sensing::RobotEstimate now = *state_.At(time);
  if (hooks_.before_update) hooks_.before_update();
  const sensing::LookNews news = objects_.Update(now);
  for (const std::string& why : news.warnings) hooks_.warn(why);
  num_looks_ += static_cast<std::uint64_t>(news.num_looks);
  if (floor_ != nullptr) floor_->Update(time);
  const auto known = Known(now);
  const bool is_due = news.has_changed_hands || time - published_ >= kKnownPeriod;
  if (news.num_looks > 0 || (is_due && !lockstep_)) {
    published_ = time;
    hooks_.known(now, known);
  }
  const auto turn = sweep_.Update(now.Body(), news.newest_look == time, known);
  if (turn) hooks_.turn(*turn);
  hooks_.observed(time, Observed(now, known));
}

/// Whether the floor's watch knows of a thing of that name, if only that it is gone.
bool WorldTracker::StandsOnFloor(const std::string& name) const {
  if (floor_ == nullptr) return false;
  const auto& gone = floor_->vanished();
  return std::find(gone.begin(), gone.end(), name) != gone.end() ||
         std::any_of(floor_->things().begin(), floor_->things().end(),
                     [&](const robot::SeenObject& thing) { return thing.name == name; });
}

/// Whether it is only said to be somewhere.
bool WorldTracker::IsHearsay(const std::string& name) const {
  const auto& objects = objects_.memory().objects();
  const auto remembered = objects.find(name);
  return remembered != objects.end() && !remembered->second.is_observed &&
         !remembered->second.is_held;
}

/// Things on tables and on the floor, by name. A thing on the floor that an object explains, which
/// fell there, is left out.
std::vector<robot::SeenObject> WorldTracker::Known(const sensing::RobotEstimate& now) const {
  std::vector<robot::SeenObject> known = objects_.memory().Known(now.Body());
  if (floor_ == nullptr || floor_->things().empty()) return known;
  std::vector<robot::SeenObject> things = floor_->things();
  things.erase(std::remove_if(things.begin(), things.end(),
                              [&](const robot::SeenObject& thing) {
                                return std::any_of(
                                    known.begin(), known.end(),
                                    [&](const auto& object) { return Explains(object, thing); });
                              }),
               things.end());
  known.insert(known.end(), things.begin(), things.end());
  std::stable_sort(known.begin(), known.end(),
                   [](const auto& a, const auto& b) { return a.name < b.name; });
  return known;
}

translation::ObservedWorld WorldTracker::Observed(
    const sensing::RobotEstimate& now, const std::vector<robot::SeenObject>& known) const {
  const sensing::ObjectMemory& memory = objects_.memory();
  translation::ObservedWorld observed;
  observed.state.robot = {now.X_WB, now.V_B, now.posture};
  for (const robot::SeenObject& object : known) {
    if (IsHearsay(object.name)) continue;
    observed.state.world.objects.push_back(
        {object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  observed.vanished = memory.Vanished();
  if (floor_ != nullptr) {
    observed.vanished.insert(observed.vanished.end(), floor_->vanished().begin(),
                             floor_->vanished().end());
    for (const robot::SeenObject& thing : floor_->things()) {
      const bool is_told =
          std::any_of(known.begin(), known.end(),
                      [&](const robot::SeenObject& one) { return one.name == thing.name; });
      if (!is_told) observed.vanished.push_back(thing.name);
    }
  }
  observed.temperatures = temperatures_;
  return observed;
}

}  // namespace hires::control
