#pragma once

#include <actionlib/client/action_client.h>
#include <hires/RolloutAction.h>
#include <ros/node_handle.h>

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "hires/base/silence.h"

namespace hires_ros {

/// The imagination client's end of one worker: knows whether it lives, plays one goal after the
/// other on it, taking turns between the sessions that want it.
class WorkerLink {
 public:
  struct Joined {};
  struct Lost {};
  struct Played {
    int session, assignment;
    hires::RolloutRecord record;
  };
  struct Finished {
    int session, assignment;
    std::vector<hires::RolloutRecord> records;  ///< all of the assignment
  };
  struct Failed {
    int session, assignment;
    std::string reason;
    bool is_unusable;
  };
  using Event = std::variant<Joined, Lost, Played, Finished, Failed>;
  using Handler = std::function<void(const Event&)>;

  /// @param timeout  [s] of silence after which the worker counts as lost.
  /// The handler is called from ROS callbacks and from Look(), never from Send() or Cancel().
  WorkerLink(int index, double timeout, ros::NodeHandle* nh, Handler handler);
  ~WorkerLink();

  /// One assignment of a session; waits for its turn.
  void Send(int session, int assignment, const hires::RolloutGoal& goal);
  void Cancel(int session, int assignment);  ///< no event will come for it any more
  void CancelSession(int session);

  void Look();  ///< call often: notices joining and loss
  bool is_alive() const { return is_alive_; }
  const std::string& name() const { return name_; }

 private:
  using Client = actionlib::ActionClient<hires::RolloutAction>;
  struct Job {
    int session, assignment;
    hires::RolloutGoal goal;
  };
  struct Running {
    int session, assignment;
    Client::GoalHandle handle;
  };

  void StartNext();
  void OnTransition(Client::GoalHandle handle);
  void OnFeedback(Client::GoalHandle handle, const hires::RolloutFeedbackConstPtr& feedback);
  void Drop();

  std::string name_;
  Handler handler_;
  Client client_;
  ros::Subscriber status_;
  hires::base::Silence silence_;  // of its status
  bool is_alive_{false};
  int last_session_{0};
  std::deque<Job> jobs_;
  std::optional<Running> running_;
};

}  // namespace hires_ros
