#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "hires/base/mailbox.h"
#include "hires/skills/skill.h"

namespace hires::control {

/// What a skill made of one look.
struct SkillTurn {
  skills::Status status;
  robot::Command command;
  std::string phase;
  std::optional<skills::DriveView> drive;
  std::string error;  ///< it threw this; empty otherwise
};

/// A skill on a thread of its own, so that one that plans an arm's path does not keep another from
/// driving. One look at a time: Look, then Take until there is an answer.
class SkillThread {
 public:
  /// @param wake  called on the skill's thread when there is something to take.
  SkillThread(std::unique_ptr<skills::Skill> skill, std::function<void()> wake);
  ~SkillThread();  ///< waits for the end of a look
  SkillThread(const SkillThread&) = delete;
  SkillThread& operator=(const SkillThread&) = delete;

  void Look(robot::Observation observation);  ///< @pre !is_thinking()
  std::optional<SkillTurn> Take();
  bool is_thinking() const { return is_thinking_; }  ///< a look is not taken yet
  double period() const { return period_; }          ///< [s] of the skill

 private:
  void Run();
  SkillTurn Update(const robot::Observation& observation);

  std::unique_ptr<skills::Skill> skill_;
  std::function<void()> wake_;
  double period_;
  bool is_thinking_{false};                                 // of the owner's thread
  base::Mailbox<std::optional<robot::Observation>> looks_;  // nothing: the end
  base::Mailbox<SkillTurn> turns_;
  std::thread thread_;
};

}  // namespace hires::control
