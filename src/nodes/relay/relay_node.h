#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "hires/relay/relay.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/master_watch.h"

namespace hires_ros {

/// Reads the file in ~config; ~foreign_master and ~namespace win over it.
/// @throws hires::base::ConfigError for whatever is wrong there, and when the foreign master is
/// the main one.
hires::relay::RelayParams LoadRelayParams();

/// Runs a relay::Relay between this node's own master and the foreign one.
class RelayNode {
 public:
  /// Nothing is registered at either master yet but this node's own /diagnostics.
  RelayNode(const hires::relay::RelayParams& params, ros::NodeHandle* nh);

  /// Relays until ROS is shut down; then withdraws what was registered, unless the main master
  /// was replaced: the relay starts again then, and its mirrors stay in use meanwhile.
  void Run(const MasterWatch& master_watch);

 private:
  void PublishDiagnostics();

  hires::relay::RelayParams params_;
  XmlRpcMasterApi local_;
  XmlRpcMasterApi foreign_;
  XmlRpcPinger pinger_;
  hires::relay::Relay relay_;
  ros::Publisher diagnostics_;
};

}  // namespace hires_ros
