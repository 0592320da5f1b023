#pragma once

#include <actionlib/client/action_client.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "hires/control/move_base_drive.h"
#include "hires/geometry/map_to_world.h"
#include "hires/geometry/pose.h"

namespace hires_ros {

/// A robot's move_base, by its action. Its answers come on a thread of its own; all calls may
/// come from any thread, and none waits.
///
/// Goals go out between Open and Shut only, so that a skill on its own thread cannot give one after
/// it was broken off.
class MoveBaseLink : public hires::control::MoveBaseServer {
 public:
  /// @param action     e.g. "move_base"
  /// @param map_frame  of the goals
  /// @param map_to_world  how that map lies in the world that goals are given in
  MoveBaseLink(const std::string& action, const std::string& map_frame,
               const hires::geometry::MapToWorld& map_to_world = {});
  ~MoveBaseLink() override;  ///< takes the goal back
  MoveBaseLink(const MoveBaseLink&) = delete;
  MoveBaseLink& operator=(const MoveBaseLink&) = delete;

  void Open();
  void Shut();  ///< takes the goal back

  bool IsThere() override;
  void Go(const hires::geometry::Pose2& X_MGoal) override;  ///< nothing happens while it is shut
  void Cancel() override;
  hires::control::MoveBaseNews News() override;

 private:
  using Client = actionlib::ActionClient<move_base_msgs::MoveBaseAction>;

  void OnTransition(std::uint64_t goal, Client::GoalHandle handle);
  void SetNews(std::uint64_t goal, const hires::control::MoveBaseNews& news);

  const std::string map_frame_;
  const hires::geometry::MapToWorld map_to_world_;
  ros::CallbackQueue queue_;
  std::unique_ptr<Client> client_;

  std::mutex handle_mutex_;  // never taken by what is called from the queue
  Client::GoalHandle handle_;
  bool is_open_{false};

  std::mutex news_mutex_;
  std::uint64_t current_{0};  // number of the goal that the news is about
  hires::control::MoveBaseNews news_;

  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace hires_ros
