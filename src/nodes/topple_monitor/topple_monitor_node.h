#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/ExecuteActionActionGoal.h>
#include <hires/ExecuteActionActionResult.h>
#include <hires/RobotState.h>
#include <hires/WorldState.h>
#include <ros/node_handle.h>

#include <deque>
#include <map>
#include <string>

#include "hires/base/topic_warnings.h"
#include "hires/knowledge/experience.h"
#include "nodes/topple_monitor/topple_monitor_params.h"
#include "reports/experience/experience_writer.h"
#include "reports/experience/load_follower.h"

namespace hires_ros {

/// Looks at what really happens to the load on the tray of a simulated robot, tells it at 20 Hz and
/// writes it into a store of experiences, with what the robot does meanwhile.
class ToppleMonitorNode {
 public:
  ToppleMonitorNode(const ToppleMonitorParams& params, ros::NodeHandle* nh);
  ~ToppleMonitorNode();  ///< writes what is there, or says what is lost

 private:
  struct Moment {
    ros::Time stamp;
    hires::WorldStateConstPtr world;
    hires::RobotStateConstPtr robot;
  };

  void OnWorld(const hires::WorldStateConstPtr& msg);
  void OnRobot(const hires::RobotStateConstPtr& msg);
  void OnGoal(const hires::ExecuteActionActionGoalConstPtr& msg);
  void OnResult(const hires::ExecuteActionActionResultConstPtr& msg);
  Moment* MomentAt(const ros::Time& stamp);
  void TakeWhole();
  void Use(const Moment& moment);
  void Note(const hires::knowledge::ToppleEpisodePart& part, const std_msgs::Header& header);
  void TellActions();
  void TellProblem();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const ToppleMonitorParams params_;
  hires::knowledge::ExperienceStore store_;
  hires::reports::LoadFollower follower_;
  hires::reports::ExperienceWriter writer_;
  std::deque<Moment> moments_;                  // of which one half came, in that order
  ros::Time last_;                              // moment that was used
  std::map<std::string, std::string> actions_;  // what the robot does, by id of the goal
  int num_runs_{1};                             // each time that the clock begins anew is one
  long num_moments_{0}, num_parts_{0}, num_falls_{0}, num_refused_{0};
  hires::knowledge::ToppleState state_{hires::knowledge::ToppleState::kNoTopple};
  std::string refused_, problem_;  // the last that was told of moments, of the file
  hires::base::TopicWarnings warnings_;

  ros::Publisher parts_;
  ros::Subscriber worlds_, robots_, goals_, results_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace hires_ros
