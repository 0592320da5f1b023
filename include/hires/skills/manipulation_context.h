#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/manipulation/arm_kinematics.h"
#include "hires/manipulation/collision_scene.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/skills/manipulation_params.h"
#include "hires/world/standing.h"
#include "hires/world/world.h"

namespace hires::skills {

/// What all skills of the upper body share; constant.
struct ManipulationContext {
  std::shared_ptr<const world::World> world;
  std::shared_ptr<const robot::Robot> robot;  ///< has an upper body
  ManipulationParams params;
  world::StandingCriterion standing;
  std::map<std::string, std::shared_ptr<const manipulation::ArmKinematics>> arms;
  /// Without objects; to be cloned.
  std::shared_ptr<const manipulation::CollisionScene> empty_scene;

  const robot::UpperBodyProfile& upper_body() const { return *robot->profile.upper_body; }
  const robot::ArmProfile& arm(const std::string& name) const { return upper_body().arms.at(name); }
};

/// @pre the robot has an upper body.  @throws base::ConfigError for an arm that is no chain.
std::shared_ptr<const ManipulationContext> MakeManipulationContext(
    std::shared_ptr<const world::World> world, std::shared_ptr<const robot::Robot> robot,
    const ManipulationParams& params, const world::StandingCriterion& standing = {});

/// The same for the same action, parameters and attempt, in whichever process, place and time.
std::uint64_t SeedOf(const ManipulationParams& params, const base::ActionCall& action);
std::uint64_t AttemptSeed(std::uint64_t seed, int attempt);

/// Joint name -> position, put together from an arm's joints and their positions.
void SetJoints(const std::vector<std::string>& joints, const std::vector<double>& positions,
               robot::JointPositions* posture);
/// Positions of some joints; 0 for a joint that was not measured.
std::vector<double> JointsOf(const std::vector<std::string>& joints,
                             const robot::JointPositions& posture);

/// `goal`, joints that turn without end brought to within half a turn of `near`.
std::vector<double> NearestTurn(const robot::RobotModel& model,
                                const std::vector<std::string>& joints, std::vector<double> goal,
                                const std::vector<double>& near);

/// The arm's name in lower case.  @throws base::ConfigError with names like it.
std::string KnownArm(const ManipulationContext& context, const std::string& arm);

/// @throws base::ConfigError if the robot has no tray.
void RequireTray(const ManipulationContext& context);
/// Where an object is put on the tray at first, in the map.  @pre the robot has a tray.
geometry::Pose3 TrayFrame(const ManipulationContext& context,
                          const robot::Observation& observation);

/// Link poses in the map, for links that are asked for by name.
geometry::Pose3 LinkPose(const robot::Robot& robot, const geometry::Pose2& X_MB,
                         const robot::JointPositions& posture, const std::string& link);

/// unknown_model for the first seen object whose shape is unknown, so that no way round
/// it can be found; empty if all are known.
base::Failure WhyNotKnown(const ManipulationContext& context, const robot::Observation& seen);

/// What the arm holds, or nothing.
const robot::SeenObject* HeldBy(const robot::ArmProfile& arm, const robot::Observation& seen);
/// The object of that name (lower case), or nullptr.
const robot::SeenObject* FindSeen(const robot::Observation& seen, const std::string& name);

}  // namespace hires::skills
