#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/sensing/object_estimator.h"
#include "hires/sensing/robot_state_estimator.h"

namespace hires::reports {

/// The robot and what it knew, at one moment of an episode.
struct EpisodeSample {
  double time{0.0};            ///< [s] on the robot's clock
  geometry::Pose2 X_WB;        ///< in the world that is imagined
  geometry::Twist2 V_B;        ///< by the odometry: corrections of the localisation are no motion
  std::vector<double> joints;  ///< in the order of Episode::joint_names
  std::vector<robot::SeenObject> objects;
};

enum class ActionFate { kSucceeded, kFailed, kPreempted, kUnknown };
std::string ToString(ActionFate fate);  ///< "succeeded", "failed", "stopped", "unknown"

/// An action that the robot was asked for, as the topics of the action tell.
struct RecordedAction {
  std::string id;  ///< of the goal
  base::ActionCall action;
  double begin{0.0};          ///< [s] when the goal was sent
  std::optional<double> end;  ///< [s] none: its result was not recorded
  double duration{0.0};       ///< [s] as the robot says
  ActionFate fate{ActionFate::kUnknown};
  base::Failure failure;
};

/// One stretch of the robot's clock without a jump back.
struct Episode {
  std::vector<std::string> joint_names;
  std::vector<EpisodeSample> samples;   ///< oldest first; what is missing between two is not known
  std::vector<RecordedAction> actions;  ///< as they were asked for

  /// The newest sample that is not newer than that; null: there is none.
  const EpisodeSample* At(double time) const;
  /// The longest time [s] between the two in which nothing is known of the robot.
  double LongestGap(double from, double to) const;
};

/// Makes episodes of what was recorded, with the estimators that middle layer and tracker have:
/// what they dropped is dropped, and counted. To be told in the order in which it was recorded.
class EpisodeBuilder {
 public:
  /// @param tree    of frames; whoever fills it tells OnTransforms.
  /// @param period  [s] from sample to sample.  @pre `setup` outlives this.
  EpisodeBuilder(const imagination::ImaginationSetup& setup, const sensing::FrameNames& frames,
                 const geometry::MapToWorld& map_to_world, std::shared_ptr<sensing::FrameTree> tree,
                 double period);

  void OnOdometry(double stamp, const std::string& frame, const std::string& child,
                  const robot::OdometryReading& reading);
  void OnJoints(double stamp, const robot::JointReading& reading);
  void OnTransforms(double stamp);
  void OnLook(sensing::Look look);
  void OnKnownObjects(double stamp, const world::WorldState& known);
  void OnGoal(const std::string& id, const base::ActionCall& action, double stamp);
  /// Of a goal that was not recorded it says nothing.
  void OnResult(const std::string& id, double stamp, double duration, ActionFate fate,
                const base::Failure& failure);
  /// Something was left out, and why.
  void Drop(const std::string& topic, const std::string& why);

  /// What is still missing for a state; empty: nothing.
  std::string MissingText() const;
  /// Joints of arms and torso of which no joint state told: they stand as in the driving posture.
  std::vector<std::string> UntoldJoints() const;
  /// "odometry: it is not finite" -> how often.
  const std::map<std::string, int>& dropped() const { return dropped_; }
  /// All that have a sample or an action, in their order.
  std::vector<Episode> Take();

 private:
  struct Known {
    double stamp;  // [s]
    world::WorldState objects;
  };
  void Note(const std::string& topic, const sensing::Receipt& receipt);
  void FollowClock();
  void Sample();
  void Add(const sensing::RobotEstimate& now);

  const sensing::FrameNames frames_;
  const double period_;
  sensing::RobotStateEstimator state_;
  std::unique_ptr<sensing::ObjectEstimator> objects_;
  std::optional<Known> known_;  // not taken into account yet
  std::vector<Episode> episodes_;
  std::optional<double> next_;  // [s] of the next sample
  int restarts_{0};             // of the clock, so far
  std::map<std::string, int> dropped_;
  const std::vector<std::string> body_joints_;  // of arms and torso
  std::set<std::string> told_joints_;
};

}  // namespace hires::reports
