#include "hires/skills/activity.h"

#include <iterator>

namespace hires::skills {

void StagedSkill::Insert(std::vector<Stage> stages) {
  stages_.insert(stages_.begin(), std::make_move_iterator(stages.begin()),
                 std::make_move_iterator(stages.end()));
}

/// Why the present stage has failed; nothing while it has not. Its activity is gone when it is
/// over.
base::Failure StagedSkill::Continue(const robot::Observation& observation,
                                    robot::Command* command) {
  if (stage_.watch) {
    base::Failure why = stage_.watch(observation);
    if (why) return why;
  }
  const Status status = activity_->Update(observation, command);
  if (status.progress == Progress::kSucceeded) activity_.reset();
  return status.progress == Progress::kFailed ? status.failure : base::Failure();
}

void StagedSkill::Fail(const base::Failure& failure, const robot::Observation& observation) {
  activity_.reset();
  stages_.clear();
  if (failure_) return;  // tidying up failed too: that is not why the skill fails
  failure_ = failure;
  Insert(AfterFailure(stage_.name, observation));
}

Status StagedSkill::Update(const robot::Observation& observation, robot::Command* command) {
  while (activity_ != nullptr || !stages_.empty()) {
    if (activity_ == nullptr) {
      stage_ = std::move(stages_.front());
      stages_.pop_front();
      Beginning beginning = stage_.begin(observation);
      activity_ = std::move(beginning.activity);
      if (beginning.failure) Fail(beginning.failure, observation);
    } else {
      const base::Failure failure = Continue(observation, command);
      if (failure) {
        Fail(failure, observation);
      } else if (activity_ != nullptr) {
        return {};
      }
    }
  }
  return failure_ ? Failed(failure_) : Succeeded();
}

}  // namespace hires::skills
