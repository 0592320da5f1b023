#include "hires/ros/middle_layer_thread.h"

#include "hires/base/check.h"

namespace hires_ros {

SkillThread::SkillThread(std::unique_ptr<hires::skills::Skill> skill, std::function<void()> wake)
    : skill_(std::move(skill)),
      wake_(std::move(wake)),
      period_(skill_->period()),
      thread_([this] { Run(); }) {}

SkillThread::~SkillThread() {
  looks_.Post(std::nullopt);
  thread_.join();
}

void SkillThread::Look(hires::robot::Observation observation) {
  HIRES_CHECK(!is_thinking_, "a skill gets one look at a time");
  is_thinking_ = true;
  looks_.Post(std::move(observation));
}

std::optional<SkillTurn> SkillThread::Take() {
  auto turn = turns_.Take();
  if (turn) is_thinking_ = false;
  return turn;
}

void SkillThread::Run() {
  while (true) {
    const auto look = looks_.WaitAndTake(std::chrono::hours(1));
    if (!look) continue;
    if (!*look) return;
    turns_.Post(Update(**look));
    wake_();
  }
}

SkillTurn SkillThread::Update(const hires::robot::Observation& observation) {
  SkillTurn turn;
  try {
    turn.status = skill_->Update(observation, &turn.command);
    turn.phase = skill_->phase();
  } catch (const std::exception& error) {  // one skill's fault must not end the others
    turn.status.progress = hires::skills::Progress::kFailed;
    turn.command = {};
    turn.error = error.what();
  }
  return turn;
}

}  // namespace hires_ros
