#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "hires/geometry/angles.h"
#include "hires/skills/skill.h"

namespace hires::skills::test_support {

/// A robot without mass: it drives exactly as it is told, from the first moment on.
struct PointRobot {
  geometry::Pose2 X_MB;
  geometry::Twist2 V_B;
  bool is_held{false};  ///< its wheels turn in vain

  void Move(double dt) {
    if (is_held) return;
    X_MB = X_MB * geometry::Pose2{V_B.vx * dt, V_B.vy * dt, V_B.wz * dt};
    X_MB.yaw = geometry::WrapToPi(X_MB.yaw);
  }
};

/// What became of a skill that was run to its end.
struct SkillRun {
  Status status;
  PointRobot robot;
  double duration{0.0};      ///< [s]
  double fastest{0.0};       ///< [m/s]
  double fastest_turn{0.0};  ///< [rad/s]
  geometry::Twist2 last_command;
};

/// Called before each cycle; may change what the robot sees and where it stands.
using Disturb = std::function<void(robot::Observation*, PointRobot*)>;

/// Closed loop of a skill and a point robot.
inline SkillRun RunSkill(Skill* skill, PointRobot robot, const Disturb& disturb = {},
                         double longest = 120.0) {
  SkillRun run;
  const double dt = skill->period();
  for (int cycle = 0; run.status.progress == Progress::kRunning && run.duration < longest;
       ++cycle) {
    run.duration = cycle * dt;
    robot::Observation seen;
    seen.time = run.duration;
    if (disturb) disturb(&seen, &robot);
    seen.X_MB = robot.X_MB;
    seen.V_B = robot.is_held ? geometry::Twist2{} : robot.V_B;
    robot::Command command;
    run.status = skill->Update(seen, &command);
    robot.V_B = command.base_velocity.value_or(geometry::Twist2{});
    run.last_command = robot.V_B;
    run.fastest = std::max(run.fastest, std::hypot(robot.V_B.vx, robot.V_B.vy));
    run.fastest_turn = std::max(run.fastest_turn, std::abs(robot.V_B.wz));
    robot.Move(dt);
  }
  run.robot = robot;
  return run;
}

}  // namespace hires::skills::test_support
