#pragma once

#include <optional>
#include <vector>

#include "hires/imagination/rollout.h"
#include "hires/imagination/rollout_reach.h"

namespace hires::imagination {

/// Nothing but what the robot holds moves. What does may be anywhere before anybody looks, so that
/// nothing can be left out.
bool AllAreAtRest(const world::WorldState& state);

/// Follows the robot and the objects of a rollout, notes where they were, and says when one of them
/// comes near something that was left out.
class ReachWatch {
 public:
  /// @pre AllAreAtRest(setup.world_state)
  /// @throws base::ConfigError for joints that the robot does not have.
  ReachWatch(const RolloutSetup& setup, const base::ActionCall& action);

  /// The start without what stands apart from all that was reached until now.
  const RolloutSetup& narrowed() const { return narrowed_; }
  /// False: something is near what is left out, and the rollout must begin again with it.
  bool Look(const simulation::RobotSimulator& simulator);
  bool is_touched() const { return is_touched_; }  ///< what the last look said
  void BeginAgain();                               ///< narrowed() is a wider start now

  const RolloutReach& reach() const { return reach_; }
  /// A world with what was left out, in the order of the start.
  world::WorldState WithLeftOut(const world::WorldState& narrowed) const;

 private:
  /// What is left out. Seen is what stands in the laser's plane.
  struct LeftOut {
    RolloutReach::Disc disc;
    bool is_seen;
  };

  void SeeTheWay(const Eigen::Vector2d& p_MGoal);
  bool IsWithin(const world::ObjectState& object) const;
  bool Note(std::size_t thing, const Eigen::Vector2d& p_M, double radius);
  bool NoteSeen(const RolloutReach::Disc& robot);

  const RolloutSetup& setup_;
  const base::ActionCall& action_;
  const std::optional<double> sight_;
  double robot_radius_;
  bool is_touched_{false};
  RolloutReach reach_;
  RolloutReach seen_;  // from where the robot was, or may be: what its laser's plane has there
  double more_{1.0};   // [m] around where something came in sight that was left out
  RolloutSetup narrowed_;
  std::vector<LeftOut> left_out_;
  std::vector<double> radii_;                          // of the narrowed objects
  std::vector<std::optional<Eigen::Vector2d>> noted_;  // the robot, then the objects
};

/// [m] From the base on: beyond, whatever stands in its laser's plane changes nothing, as it
/// neither marks what is driven round nor hides what does. Nothing where that is not known: where
/// the robot finds its place by all that the laser sees, and for actions other than our own drives
/// round obstacles.
std::optional<double> SightOf(const RolloutSetup& setup, const base::ActionCall& action);

/// Whether a rollout that reached so far has this object in it, or may have seen it.
bool IsWithin(const RolloutReach& reach, const RolloutSetup& setup, const base::ActionCall& action,
              const world::ObjectState& object);

}  // namespace hires::imagination
