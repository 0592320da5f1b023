#include "loop/middle_layer.h"

#include <utility>

#include "hires/actions/action_spec.h"
#include "hires/base/error.h"
#include "hires/skills/skill_factory.h"

namespace hires::loop {
namespace {

using base::ActionCall;
using control::ActionEnd;
using control::ActionNews;
using imagination::ImaginationSetup;

sensing::ScanObstacles ObstaclesOf(const ImaginationSetup& setup, const sensing::ScanParams& scan) {
  const robot::RobotProfile& profile = setup.scene->robot.profile;
  return {setup.skills->driving->costmap,
          geometry::Padded(profile.footprint, profile.footprint_padding), scan};
}

}  // namespace

MiddleLayer::MiddleLayer(const ImaginationSetup& setup, const sensing::FrameNames& frames,
                         const control::RunnerParams& runner, const sensing::ScanParams& scan,
                         Hooks hooks)
    : setup_(setup),
      hooks_(std::move(hooks)),
      senses_(setup, frames, setup.scene->in_camera()),
      observations_(&senses_.state(), ObstaclesOf(setup, scan),
                    robot::BaseOutlineOf(setup.scene->robot)),
      looked_(0.0),
      runner_(setup.scene->robot, runner,
              {[this](const robot::Command& command) { hooks_.send(command); },
               [this](const ActionNews& news, ActionEnd end, const base::Failure& failure) {
                 running_.erase(news.id);
                 hooks_.ended(news.id, end, failure);
               },
               [this] {
                 const std::lock_guard<std::mutex> lock(mutex_);
                 ++num_answers_;
                 woken_.notify_one();
               }}) {
  if (!setup.sensing.ground.is_enabled) return;
  ground_.emplace(&senses_.state(),
                  std::shared_ptr<const robot::Robot>(setup.scene, &setup.scene->robot),
                  setup.skills->driving->costmap, setup.sensing.ground);
}

void MiddleLayer::Start(int activity, const ActionCall& action, double time_limit) {
  base::Failure refusal;
  try {
    auto skill = skills::MakeSkill(*setup_.skills, action);
    const auto groups = actions::GroupsOf(skills::SpecOf(*setup_.skills, action), action);
    running_[activity] = action;
    refusal = runner_.Start(activity, action, groups, std::move(skill), time_limit, looked_);
  } catch (const base::ConfigError& error) {
    refusal = {base::FailureCode::kInvalidAction, {}, error.what()};
  }
  if (!refusal) return;
  running_.erase(activity);
  hooks_.ended(activity, ActionEnd::kFailed, refusal);
}

base::Failure MiddleLayer::Refusal(const ActionCall& action) const {
  try {
    skills::MakeSkill(*setup_.skills, action);
    actions::GroupsOf(skills::SpecOf(*setup_.skills, action), action);
  } catch (const base::ConfigError& error) {
    return {base::FailureCode::kInvalidAction, {}, error.what()};
  }
  return {};
}

void MiddleLayer::Cancel(int activity) { runner_.Cancel(activity); }

void MiddleLayer::Hear(const SensorNews& news, const simulation::LaserParams& laser) {
  if (!news.scan.empty()) {
    observations_.OnScan(news.stamp, laser.link, simulation::ReadingOf(news.scan, laser));
  }
  if (news.is_tick) observations_.OnLocalised(news.readings.covariance);
  if (news.sweep && ground_) ground_->OnCloud(news.stamp, senses_.frames().odometry, *news.sweep);
  senses_.Hear(news);
}

void MiddleLayer::OnKnownObjects(double stamp, world::WorldState known) {
  known_ = Known{stamp, std::move(known)};
}

void MiddleLayer::Look(double stamp) {
  looked_ = stamp;
  const auto now = senses_.state().At(stamp);
  if (!now) return runner_.CheckFreshness(stamp);
  runner_.Look(stamp, ObservationOf(*now));
  AwaitSkills();
}

robot::Observation MiddleLayer::ObservationOf(const sensing::RobotEstimate& now) {
  robot::Observation seen = observations_.Observe(now);
  if (ground_) {
    const auto& on_the_floor = ground_->Obstacles(now);
    seen.obstacles_M.insert(seen.obstacles_M.end(), on_the_floor.begin(), on_the_floor.end());
  }
  sensing::ObjectEstimator* objects = senses_.objects();
  if (objects == nullptr) return seen;
  if (known_) {
    const auto then = senses_.state().At(known_->stamp);
    objects->OnStated(known_->objects, then.value_or(now));
    known_.reset();
  }
  objects->Update(now);
  seen.objects = objects->memory().Known(now.Body());
  seen.num_newcomers = objects->memory().num_newcomers();
  return seen;
}

/// Answers are taken once all are there: in the order of the actions, not of who was first.
void MiddleLayer::AwaitSkills() {
  const int num_asked = runner_.num_thinking();
  {
    std::unique_lock<std::mutex> lock(mutex_);
    woken_.wait(lock, [&] { return num_answers_ >= num_asked; });
    num_answers_ = 0;
  }
  runner_.Collect();
}

}  // namespace hires::loop
