#pragma once

#include <actionlib/server/action_server.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <hires/ImagineAction.h>
#include <ros/node_handle.h>

#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/topic_warnings.h"
#include "hires/geometry/map_to_world.h"
#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/kept_rollouts.h"
#include "hires/imagination/scheduler.h"
#include "hires/imagination/start_spread.h"
#include "hires/ros/imagination/imagine_request.h"
#include "nodes/imagination_client/asker_watch.h"
#include "nodes/imagination_client/rollout_replayer.h"
#include "nodes/imagination_client/worker_link.h"

namespace hires_ros {

struct ImaginationClientParams {
  hires::imagination::ClientConfig config;
  hires::imagination::SetupConfig setup;
  int num_workers{1};  ///< worker_1 .. worker_n may come and go
  /// Topic (geometry_msgs/PoseWithCovarianceStamped) that tells where the robot stands and how sure
  /// that is: the spread of start poses of what begins there. Empty: as the uncertainty says.
  std::string localisation;
  hires::geometry::MapToWorld map_to_world;  ///< of the localisation's map
  std::string rollout_folder;                ///< where rollouts are saved that somebody asks for
};

/// The file in ~config (config/imagination_client.yaml where there is none); ~workers, ~world,
/// ~robot, ~objects, ~uncertainty win over it; ~localisation, ~map_to_world, ~rollout_folder.
/// @throws hires::base::ConfigError.
ImaginationClientParams LoadImaginationClientParams();

/// Answers the action `imagine`: several requests at once share the workers fairly, each has a
/// scheduler of its own. All work is done on the thread that spins; callbacks never block.
class ImaginationClientNode {
 public:
  ImaginationClientNode(const ImaginationClientParams& params,
                        hires::imagination::ImaginationSetup setup, ros::NodeHandle* nh);
  ~ImaginationClientNode();

 private:
  using Server = actionlib::ActionServer<hires::ImagineAction>;
  using GoalHandle = Server::GoalHandle;

  /// One request being answered.
  struct Session {
    int id;
    GoalHandle goal;
    std::shared_ptr<const ImagineRequest> request;  ///< shared with what is kept of it
    std::unique_ptr<hires::imagination::Scheduler> scheduler;
    std::map<int, int> alternative_of;        ///< assignment -> alternative
    std::set<std::pair<int, int>> from_kept;  ///< alternative and index
    double started;                           ///< [s] by the scheduler's clock
    double begun;                             ///< [s] steady
    double next_feedback;                     ///< [s] steady
  };

  void OnGoal(GoalHandle goal);
  void OnCancel(GoalHandle goal);
  void CancelForNobody(Session* session, double now);
  void OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg);
  void SpreadStart(ImagineRequest* request) const;
  void OnTick();
  void SetPace();  ///< ticks are rare while nothing is asked
  void OnWorkerEvent(int worker, const WorkerLink::Event& event);
  std::unique_ptr<Session> MakeSession(GoalHandle goal);
  void Refuse(GoalHandle goal, const std::string& why);
  void CarryOut(Session* session, const std::vector<hires::imagination::Command>& commands);
  std::vector<hires::imagination::Event> Begin(Session* session,
                                               const hires::imagination::Assign& assign);
  void OnPlayed(int worker, const WorkerLink::Played& played);
  void Feed(Session* session, const hires::imagination::Event& event);
  std::string OwnLibraries() const;
  hires::RolloutGoal RolloutGoalFor(const Session& session,
                                    const hires::imagination::Assign& assign) const;
  void PublishFeedback(Session* session, double now);
  void FinishSessions();
  void Finish(Session* session);
  void Keep(const Session& session);
  int NumWorkers() const;
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ImaginationClientParams params_;
  hires::imagination::ImaginationSetup setup_;
  std::map<int, std::unique_ptr<WorkerLink>> workers_;
  std::list<std::unique_ptr<Session>> sessions_;
  hires::imagination::KeptRollouts kept_;
  int next_session_{1};
  std::optional<hires::imagination::BelievedPose> believed_;
  std::string believed_frame_{"map"};  // of its message
  hires::base::TopicWarnings topic_warnings_;
  Server server_;
  AskerWatch askers_;
  RolloutReplayer replayer_;
  ros::Subscriber localisation_;
  ros::Publisher ranking_markers_, world_markers_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
  double period_{0.0};  // [s] of it
};

}  // namespace hires_ros
