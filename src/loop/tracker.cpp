#include "loop/tracker.h"

#include <utility>

#include "hires/translation/translator.h"

namespace hires::loop {
namespace {

using robot::SeenObject;
using sensing::RobotEstimate;
using translation::ObservedWorld;

/// A robot without camera and laser has none; what others say of objects it keeps track of, too.
std::shared_ptr<const perception::Surroundings> SurroundingsOf(const simulation::Scene& scene) {
  return scene.surroundings ? scene.surroundings
                            : std::make_shared<const perception::Surroundings>(scene.world);
}

std::optional<sensing::FloorWatch> FloorOf(const imagination::ImaginationSetup& setup,
                                           const sensing::RobotStateEstimator& state,
                                           const sensing::FloorWatchParams& params) {
  const robot::Robot& robot = setup.scene->robot;
  sensing::GroundWatchParams ground = setup.sensing.ground;
  ground.is_enabled = ground.is_enabled && robot.profile.sensors.tilting_laser;
  if (!params.is_enabled || (robot.profile.laser_link.empty() && !ground.is_enabled))
    return std::nullopt;
  return sensing::FloorWatch(&state, {setup.scene, &setup.scene->world}, {setup.scene, &robot},
                             params, ground);
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
      surroundings_(SurroundingsOf(*setup.scene)),
      senses_(setup, frames, surroundings_),
      floor_(FloorOf(setup, senses_.state(), params.floor)),
      tracker_(&senses_.state(), senses_.objects(), floor_ ? &*floor_ : nullptr,
               control::HeadSweep(context.robot, params.sweep), true,
               {[this](const RobotEstimate& now, const std::vector<SeenObject>& known) {
                  known_ = control::WorldOf(known);
                  hooks_.known(now.time, known_);
                },
                [this](const robot::JointTrajectory& turn) { hooks_.turn(turn); },
                [this](double time, ObservedWorld observed) { Post(time, std::move(observed)); },
                [](const std::string&) {},
                [this] {
                  if (std::exchange(is_view_new_, false))
                    tracker_.OnView(context_, blackboard_.view());
                }}) {}

void Tracker::Hear(const SensorNews& news, const simulation::LaserParams& laser) {
  if (floor_ && !news.scan.empty())
    floor_->OnScan(news.stamp, laser.link, simulation::ReadingOf(news.scan, laser));
  if (floor_ && floor_->hears_clouds() && news.sweep)
    floor_->OnCloud(news.stamp, senses_.frames().odometry, *news.sweep);
  senses_.Hear(news);
  tracker_.Process();
}

void Tracker::See(double stamp, const perception::Sighting& seen) {
  senses_.See(stamp, seen);
  tracker_.Process();
}

void Tracker::See(const perception::HeatView& heat) {
  tracker_.OnTemperatures(perception::SureDegrees(
      perception::ReadHeat(heat, surroundings_, known_.objects, params_.warm)));
}

void Tracker::OnActions(const std::map<int, base::ActionCall>& running) {
  std::vector<std::string> names;
  for (const auto& [activity, action] : running) names.push_back(action.name);
  tracker_.OnActions(actions_, names);
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
  const translation::FluentUpdate update =
      translation::ChangesFrom(translation::WithKnowledge(context_, blackboard_.view()),
                               blackboard_.view(), posted.observed, params_.changes);
  blackboard_.Write(update.added, update.updated, update.removed,
                    {knowledge::Source::kObservation, episode_, clock_.now()});
  hooks_.observed_until(posted.time);
}

}  // namespace hires::loop
