#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>

#include <map>
#include <string>

namespace hires_ros {

struct AskedGoal;

/// Who asked, and whether somebody is still there to hear the answer: a node that asked and no
/// longer listens to the action's result has died, or it gave up and left before its cancel was
/// read. A goal of somebody who never listened (rostopic pub) is nobody's to end. Callbacks come on
/// the thread that spins.
class AskerWatch {
 public:
  /// @param action  its name; the node serves it.
  AskerWatch(const std::string& action, ros::NodeHandle* nh);

  /// The node that sent the goal and has not been listening for a while, or empty.
  /// @param now  [s] steady
  std::string GoneFor(const std::string& goal_id, double now) const;
  /// The goal is over.
  void Forget(const std::string& goal_id) { asker_of_.erase(goal_id); }

 private:
  struct Asker {
    std::string node;
    double asked{0.0};  // [s] steady
  };
  void OnLeft(const std::string& node);
  void OnGoal(const ros::MessageEvent<const AskedGoal>& event);

  std::map<std::string, Asker> asker_of_;  // by goal id
  std::map<std::string, int> num_links_;   // node -> that listen to results
  std::map<std::string, double> left_;     // node -> [s] when its last link ended
  ros::Subscriber goals_;
  ros::Publisher result_;  // the server's own topic, for news of who listens
};

}  // namespace hires_ros
