#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/skills/move_base.h"
#include "hires/skills/skill.h"
#include "hires/skills/skill_factory.h"

namespace hires::control {

/// What became of a goal that move_base was given.
struct MoveBaseNews {
  enum class State {
    kNone,      ///< no goal
    kSent,      ///< not answered yet
    kDriving,   ///< accepted
    kArrived,   ///< by its own tolerances
    kAborted,   ///< `text` says why
    kRejected,  ///< likewise
    kReplaced,  ///< taken back, by us or by another client; another goal may be driven to
    kLost,      ///< move_base does not know it any more: it was restarted
  };
  State state{State::kNone};
  std::string text;  ///< what move_base said
};

/// A server that drives to goals: move_base, or what stands for it in a test.
class MoveBaseServer {
 public:
  virtual ~MoveBaseServer() = default;
  virtual bool IsThere() = 0;
  virtual void Go(const geometry::Pose2& X_MGoal) = 0;  ///< forgets the goal before
  virtual void Cancel() = 0;  ///< the last goal; nothing happens if it has ended
  virtual MoveBaseNews News() = 0;
};

/// What news mean in the codes of our skills; nothing while all is well: unreachable (no way, or a
/// goal that move_base refuses), stuck, interrupted (another client took move_base), no_controller.
base::Failure FailureOf(const MoveBaseNews& news);

/// Section `navigation` of config/middle_layer.yaml.
struct MoveBaseDriveParams {
  bool is_used{false};          ///< long ways are driven by move_base, not by our own skill
  double start_patience{10.0};  ///< [s] until there is permission to drive, and a server
  double answer_patience{5.0};  ///< [s] from the goal to the server's first word
  /// Where move_base stops short, our own straight drive does the rest: at most so far ...
  double max_rest{0.5};       ///< [m]
  double max_rest_turn{0.8};  ///< [rad] ... and so much of a turn
};

/// Drives to a pose in the map by the robot's own move_base, which knows its costmaps. Ends where
/// skills::MoveBase would: within the same tolerances. While move_base drives, it wants no velocity
/// itself.
///
/// Fails as FailureOf says, with goal_missed where move_base says it has arrived and has not, with
/// unreachable where an obstacle stands on the last stretch, and with no_permit where the base's
/// guard never lets it begin.
class MoveBaseDrive : public skills::Skill {
 public:
  /// @param may_drive  whether velocities would get to the base, with the motion set in force at
  ///                   move_base; called from the thread of Update.
  MoveBaseDrive(std::shared_ptr<MoveBaseServer> server, std::function<bool()> may_drive,
                const MoveBaseDriveParams& params,
                std::shared_ptr<const skills::DrivingContext> driving,
                const skills::MoveBaseBlindParams& blind, const geometry::Pose2& X_MGoal,
                const robot::MotionSet& motion_set);
  ~MoveBaseDrive() override;  ///< takes the goal back

  skills::Status Update(const robot::Observation& observation, robot::Command* command) override;
  double period() const override { return rest_.period(); }
  std::string phase() const override;

 private:
  enum class Stage { kWaiting, kDriving, kRest };
  skills::Status Begin(const robot::Observation& seen);
  skills::Status Follow(const robot::Observation& seen, robot::Command* command);
  skills::Status BeginRest(const robot::Observation& seen, robot::Command* command);
  skills::Status DriveRest(const robot::Observation& seen, robot::Command* command);
  bool IsWayFree(const robot::Observation& seen) const;
  std::vector<geometry::Pose2> WayFrom(const geometry::Pose2& X_MB, double resolution) const;

  std::shared_ptr<MoveBaseServer> server_;
  std::function<bool()> may_drive_;
  MoveBaseDriveParams params_;
  std::shared_ptr<const skills::DrivingContext> driving_;
  geometry::Pose2 X_MGoal_;
  robot::MotionSet motion_set_;
  skills::MoveBaseBlind rest_;
  Stage stage_{Stage::kWaiting};
  double sent_{0.0};        // [s]
  bool has_looked_{false};  // along its first way
};

/// Whether the robot's own move_base may do an action, as its description says. The straight last
/// stretch (move_base_blind) leads under furniture, where move_base would not go.
/// @throws base::ConfigError for an unknown action.
bool IsForMoveBase(const skills::SkillSet& skills, const base::ActionCall& action);

/// The same as skills::MakeSkill makes, by move_base.
/// @pre IsForMoveBase(skills, action)
/// @throws base::ConfigError as skills::MakeSkill.
std::unique_ptr<skills::Skill> MakeMoveBaseDrive(const skills::SkillSet& skills,
                                                 const base::ActionCall& action,
                                                 std::shared_ptr<MoveBaseServer> server,
                                                 std::function<bool()> may_drive,
                                                 const MoveBaseDriveParams& params);

}  // namespace hires::control
