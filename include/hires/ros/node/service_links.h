#pragma once

#include <ros/ros.h>

#include <map>
#include <string>
#include <utility>

namespace hires_ros {

/// Services of one node that are asked again and again, each over a connection that lasts. roscpp
/// else asks the master and connects again for every call: a master with many nodes lets
/// connections wait in vain, and TCP tries again after 1 and after 3 s. For one thread at a time.
class ServiceLinks {
 public:
  /// @param prefix  of all names, as "blackboard/".
  ServiceLinks(const ros::NodeHandle& nh, std::string prefix)
      : nh_(nh), prefix_(std::move(prefix)) {}

  /// @return false if no server answers, or the connection broke off, which leaves open whether the
  /// call was heard; the next call connects again.
  template <typename Service>
  bool Call(const std::string& name, Service* call) {
    ros::ServiceClient& client = clients_[name];
    if (!client.isValid()) {
      // A server that was killed is still registered. Connecting to it can lock up roscpp for good:
      // the thread that connects holds the lock of all links and wants the transport's, the thread
      // that serves all sockets finds the connection refused, holds that one and wants the other. A
      // probe has a transport of its own.
      if (!ros::service::exists(NameOf(name), false)) return false;
      client = nh_.serviceClient<Service>(prefix_ + name, true);
    }
    if (client.isValid() && client.call(*call)) return true;
    client = {};  // a link whose server died may go on calling itself valid
    return false;
  }

  /// The same of what changes nothing, and may be asked twice: a server that was restarted since
  /// the last call is found at once.
  template <typename Service>
  bool Ask(const std::string& name, Service* call) {
    const auto link = clients_.find(name);
    const bool was_there = link != clients_.end() && link->second;
    return Call(name, call) || (was_there && Call(name, call));
  }

  std::string NameOf(const std::string& name) const { return nh_.resolveName(prefix_ + name); }

 private:
  ros::NodeHandle nh_;
  std::string prefix_;
  std::map<std::string, ros::ServiceClient> clients_;
};

}  // namespace hires_ros
