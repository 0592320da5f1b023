#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/skills/drive_view.h"

namespace hires::skills {

enum class Progress { kRunning, kSucceeded, kFailed };

struct Status {
  Progress progress{Progress::kRunning};
  base::Failure failure;  ///< why it failed; nothing while it runs and when it succeeded
};

inline Status Succeeded() { return {Progress::kSucceeded, {}}; }
/// @pre failure is one.
inline Status Failed(base::Failure failure) { return {Progress::kFailed, std::move(failure)}; }

/// Something the robot can do, as a state machine that is the same in reality and in a rollout.
class Skill {
 public:
  virtual ~Skill() = default;

  /// One control cycle: looks, decides, and fills `command` (empty on entry).
  virtual Status Update(const robot::Observation& observation, robot::Command* command) = 0;

  virtual double period() const = 0;  ///< [s] between two calls of Update

  /// What it is at, for people: "approach", "close_gripper"; empty where there is nothing to tell.
  virtual std::string phase() const { return ""; }

  /// What it drives by; nothing where it does not drive along a path of its own.
  virtual std::optional<DriveView> drive_view() const { return std::nullopt; }
};

}  // namespace hires::skills
