#pragma once

#include <string>
#include <vector>

#include "hires/skills/activity.h"
#include "hires/skills/manipulation_context.h"
#include "skills/arm_planner.h"
#include "skills/joint_motion.h"

namespace hires::skills {

/// The torso to a height. Fails with timed_out.
class MoveTorso : public StagedSkill {
 public:
  /// @throws base::ConfigError for a posture that the torso does not have.
  MoveTorso(std::shared_ptr<const ManipulationContext> context, const base::ActionCall& action,
            const std::string& posture);
};

/// Folds and opens the arms in the order of the PR2's own tuck_arms action, so that one does not
/// get in the other's way: right arm up; left arm to its goal (before it folds: clear); right arm
/// to its goal (before it folds: clear, approach). Arms that are there already stay, and nothing
/// moves if both are. Fails with no_path, start_blocked or timed_out.
class TuckArms : public StagedSkill {
 public:
  /// @throws base::ConfigError for other goals than armtuckedposture and armuntuckedposture, and
  /// for a robot without the arms leftarm1 and rightarm1 or their way points.
  TuckArms(std::shared_ptr<const ManipulationContext> context, const base::ActionCall& action,
           const std::string& left_goal, const std::string& right_goal);
};

/// One arm beside the body, what it holds upright. Fails as TuckArms.
class MoveArmToSide : public StagedSkill {
 public:
  /// @throws base::ConfigError for an unknown arm or one without armtosideposture.
  MoveArmToSide(std::shared_ptr<const ManipulationContext> context, const base::ActionCall& action,
                const std::string& arm);
};

/// The right arm over its way point "above", then both before the body, what they hold upright; one
/// after the other where they cannot go together. Fails as TuckArms.
class MoveArmsToCarryPosture : public StagedSkill {
 public:
  /// @throws base::ConfigError as TuckArms.
  MoveArmsToCarryPosture(std::shared_ptr<const ManipulationContext> context,
                         const base::ActionCall& action);
};

/// [m] of a posture of the torso.  @throws base::ConfigError for one that it does not have.
double TorsoHeight(const ManipulationContext& context, const std::string& posture);

/// A stage that brings the torso to a height. Fails with timed_out.
Stage TorsoStage(std::shared_ptr<const ManipulationContext> context, const std::string& name,
                 double height);

/// Where an arm's joints are for a posture (lower-case name): the holding variant while it holds
/// something.  @throws base::ConfigError if the arm does not have it.
const std::vector<double>& PosturePositions(const robot::ArmProfile& arm,
                                            const std::string& posture, bool holds);
/// Sum of the joints' errors to the nearest variant of a posture [rad].
double PostureError(const robot::Robot& robot, const robot::ArmProfile& arm,
                    const std::string& posture, const robot::JointPositions& joints);

/// The robot's posture for driving, but with its arms as they are: exactly in the variant of a
/// posture that they are in (0.3 rad, summed over the joints), as measured where they are in none.
robot::JointPositions DrivingJoints(const robot::Robot& robot,
                                    const robot::JointPositions& measured);

/// How an arm gets somewhere.
struct ArmMove {
  std::string arm;
  std::vector<double> goal;
  std::uint64_t seed{0};
  MotionEnd end{MotionEnd::kSettled};
  bool is_makers_way{false};  ///< the robot's makers say that the straight way is free of itself
};

/// An arm to a posture or way point round everything that is seen. Where parts of the robot touch
/// in that posture or in the present one they may: shapes are coarser than the real parts, and the
/// robot's makers chose its postures.
Beginning MoveArmTo(std::shared_ptr<const ManipulationContext> context, const ArmMove& move,
                    const robot::Observation& observation);

}  // namespace hires::skills
