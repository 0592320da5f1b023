#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "hires/skills/skill.h"

namespace hires::skills {

/// One stretch of a skill: a motion, a wait. It begins with its first Update.
class Activity {
 public:
  virtual ~Activity() = default;
  virtual Status Update(const robot::Observation& observation, robot::Command* command) = 0;
};

/// How a stage begins: with an activity, with nothing to do, or not at all.
struct Beginning {
  std::unique_ptr<Activity> activity;  ///< null: nothing to do, or it cannot be begun
  base::Failure failure;               ///< why it cannot; nothing: it can
};
inline Beginning NothingToDo() { return {}; }
inline Beginning CannotBegin(base::Failure failure) { return {nullptr, std::move(failure)}; }
inline Beginning Begin(std::unique_ptr<Activity> activity) { return {std::move(activity), {}}; }

/// A named part of a skill. What it does is decided by what is seen when its turn comes.
struct Stage {
  std::string name;  ///< for people: "approach", "close_gripper"
  std::function<Beginning(const robot::Observation&)> begin;
  /// Looked at in every cycle while the stage lasts; a failure ends it. May be empty.
  std::function<base::Failure(const robot::Observation&)> watch;
};

/// A skill made of stages, one after the other. When one fails, the skill may still tidy up; then
/// it fails as that stage did.
class StagedSkill : public Skill {
 public:
  explicit StagedSkill(double period) : period_(period) {}

  Status Update(const robot::Observation& observation, robot::Command* command) final;
  double period() const final { return period_; }
  std::string phase() const final { return stage_.name; }

 protected:
  void Append(Stage stage) { stages_.push_back(std::move(stage)); }
  /// The next stages, in front of those that are still to come.
  void Insert(std::vector<Stage> stages);

  /// What remains to be done when `stage` failed, so that the robot is left in order.
  virtual std::vector<Stage> AfterFailure(const std::string& /*stage*/,
                                          const robot::Observation& /*observation*/) {
    return {};
  }

 private:
  base::Failure Continue(const robot::Observation& observation, robot::Command* command);
  void Fail(const base::Failure& failure, const robot::Observation& observation);

  double period_;  // [s]
  std::deque<Stage> stages_;
  Stage stage_;  // the present one
  std::unique_ptr<Activity> activity_;
  base::Failure failure_;  // of the first stage that failed
};

}  // namespace hires::skills
