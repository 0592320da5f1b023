#include "loop/tracker.h"

#include <algorithm>
#include <utility>

#include "hires/actions/catalogue.h"
#include "hires/translation/task_places.h"

namespace hires::loop {
namespace {

using robot::SeenObject;
using sensing::RobotEstimate;
using translation::ObservedWorld;

world::WorldState StateOf(const std::vector<SeenObject>& known) {
  world::WorldState state;
  for (const SeenObject& object : known) {
    state.objects.push_back({object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  return state;
}

}  // namespace

Tracker::Tracker(const imagination::ImaginationSetup& setup,
                 const translation::TranslatorContext& context, const sensing::FrameNames& frames,
                 const TrackerParams& params, VirtualClock* clock, Blackboard* blackboard,
                 Hooks hooks)
    : context_(context),
      actions_(setup.skills->actions->catalogue()),
      params_(params),
      clock_(*clock),
      blackboard_(*blackboard),
      hooks_(std::move(hooks)),
      senses_(setup, frames),
      tracker_(&senses_.state(), senses_.objects(), control::HeadSweep(context.robot, params.sweep),
               true,
               {[this](const RobotEstimate& now, const std::vector<SeenObject>& known) {
                  hooks_.known(now.time, StateOf(known));
                },
                [this](const robot::JointTrajectory& turn) { hooks_.turn(turn); },
                [this](double time, ObservedWorld observed) { Post(time, std::move(observed)); },
                [](const std::string&) {},
                [this] {
                  if (std::exchange(is_view_new_, false)) ReadView();
                }}) {}

void Tracker::Hear(const SensorNews& news) {
  senses_.Hear(news);
  tracker_.Process();
}

void Tracker::OnActions(const std::map<int, base::ActionCall>& running) {
  const bool is_busy = std::any_of(running.begin(), running.end(), [this](const auto& action) {
    return actions::MayUseHead(actions_, base::CanonicalName(action.second.name));
  });
  tracker_.sweep().SetBusy(is_busy, tracker_.time());
}

translation::TranslatorContext Tracker::ContextNow() const {
  return translation::WithKnowledge(context_, blackboard_.view());
}

void Tracker::ReadView() {
  const translation::TranslatorContext context = ContextNow();
  std::vector<sensing::StatedObject> stated;
  for (const auto& object : translation::StatedObjects(context, blackboard_.view())) {
    stated.push_back({object.name, object.model, object.link, object.X_LO});
  }
  senses_.objects()->OnStated(stated);
  tracker_.sweep().SetPlaces(translation::PlacesOfTasks(context, blackboard_.view()),
                             context.areas);
}

/// Replaces what was posted before and is not written yet.
void Tracker::Post(double time, ObservedWorld observed) {
  posted_ = Posted{time, std::move(observed)};
  if (std::exchange(is_write_due_, true)) return;
  clock_.At(written_ + params_.write_period, [this] { Write(); });
}

void Tracker::Write() {
  is_write_due_ = false;
  written_ = clock_.now();
  const Posted posted = *std::exchange(posted_, std::nullopt);
  const translation::FluentUpdate update = translation::ChangesFrom(
      ContextNow(), blackboard_.view(), posted.observed, params_.changes, params_.concepts);
  blackboard_.Write(update.added, update.updated, update.removed,
                    {knowledge::Source::kObservation, episode_, clock_.now()});
  hooks_.observed_until(posted.time);
}

}  // namespace hires::loop
