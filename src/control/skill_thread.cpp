#include "hires/control/skill_thread.h"

#include "hires/base/check.h"

namespace hires::control {

SkillThread::SkillThread(std::unique_ptr<skills::Skill> skill, std::function<void()> wake)
    : skill_(std::move(skill)),
      wake_(std::move(wake)),
      period_(skill_->period()),
      thread_([this] { Run(); }) {}

SkillThread::~SkillThread() {
  looks_.Post(std::nullopt);
  thread_.join();
}

void SkillThread::Look(robot::Observation observation) {
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

SkillTurn SkillThread::Update(const robot::Observation& observation) {
  SkillTurn turn;
  try {
    turn.status = skill_->Update(observation, &turn.command);
    turn.phase = skill_->phase();
    turn.drive = skill_->drive_view();
  } catch (const std::exception& error) {  // one skill's fault must not end the others
    turn.status.progress = skills::Progress::kFailed;
    turn.command = {};
    turn.error = error.what();
  }
  return turn;
}

}  // namespace hires::control
