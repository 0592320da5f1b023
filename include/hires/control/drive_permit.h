#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/robot/robot_profile.h"
#include "hires/skills/skill_factory.h"

namespace hires::control {

/// How fast an action may drive, and how hard its load lets the base brake.
struct DriveLimits {
  std::string set_name;  ///< of the motion set
  robot::MotionSet limits;
  double max_braking{0.0};       ///< [m/s^2]
  double max_braking_jerk{0.0};  ///< [m/s^3]
};

/// The motion set in force while an action has the base: the one that it names, else the robot's
/// default; never more than a straight approach may have. Braking is left at 0.
/// @pre skills::MakeSkill accepts the action.
DriveLimits LimitsFor(const skills::SkillSet& skills, const base::ActionCall& action);

/// What the guard of the base is asked for.
struct DriveRequest {
  std::uint64_t id{0};  ///< of the action; 0: no action wants to drive
  DriveLimits limits;
};

/// What the guard says.
struct GuardAnswer {
  std::uint64_t request{0};  ///< that it is about; 0: it has none
  bool passes{false};        ///< velocities go through
  base::Failure failure;     ///< why they do not
};

/// Permission to drive, asked of the guard of the base again and again while an action has the
/// base. A stop by the guard holds for the rest of the action: the next action asks with another
/// id. A guard that was restarted during the drive does not know its request any more and could not
/// brake for it, so that ends the drive as well. Time is handed in; requests go out through the
/// hooks.
class DrivePermit {
 public:
  struct Hooks {
    std::function<void(const DriveRequest&)> send;
    std::function<void(const base::Failure&)> stopped;  ///< once for each request
  };

  /// @param period  [s] between two requests.
  DrivePermit(double period, Hooks hooks) : period_(period), hooks_(std::move(hooks)) {}

  /// @param wall  [ns] since 1970, so that ids differ from those of this node's predecessors.
  void Begin(int action, const DriveLimits& limits, std::uint64_t wall);

  /// The load has changed.
  void SetBraking(double max_braking, double max_braking_jerk);

  /// The action has ended; nothing happens if it never had the base.
  void End(int action);

  /// Sends what is due.
  /// @param now  [s] steady.
  void Tick(double now);

  void OnAnswer(const GuardAnswer& answer);

  bool is_asking() const { return action_.has_value(); }
  std::uint64_t id() const { return request_.id; }  ///< 0: no action wants to drive

  /// Whether the guard lets velocities of the present request pass; any thread may read it, also
  /// after the end of this object.
  std::shared_ptr<const std::atomic<bool>> granted() const { return granted_; }

 private:
  double period_;
  Hooks hooks_;
  std::optional<int> action_;
  DriveRequest request_;
  std::uint64_t last_id_{0};
  std::optional<double> sent_;  // [s] steady
  bool is_stopped_{false};
  std::shared_ptr<std::atomic<bool>> granted_{std::make_shared<std::atomic<bool>>(false)};
};

}  // namespace hires::control
