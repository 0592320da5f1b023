#include "nodes/execution_monitor/client_watch.h"

#include <ros/master.h>
#include <ros/this_node.h>

#include <chrono>
#include <optional>
#include <utility>

#include "hires/relay/uri.h"
#include "hires/ros/xmlrpc_master_api.h"

namespace hires_ros {
namespace {

constexpr auto kPeriod = std::chrono::seconds(1);
constexpr double kCallTimeout = 1.0;  // [s]
constexpr int kMostMisses = 3;        // in a row; a busy computer may miss one

std::optional<hires::relay::Endpoint> EndpointOf(const std::string& node) {
  XmlRpcMasterApi master(ros::master::getURI(), ros::this_node::getName(), kCallTimeout);
  const auto uri = master.LookupNode(node);
  return uri ? hires::relay::ParseUri(*uri) : std::nullopt;
}

}  // namespace

std::string ClientOf(const std::string& goal_id) {
  const std::size_t time = goal_id.rfind('-');
  if (time == std::string::npos || time == 0) return "";
  const std::size_t count = goal_id.rfind('-', time - 1);
  if (count == std::string::npos || goal_id[0] != '/') return "";
  return goal_id.substr(0, count);
}

ClientWatch::ClientWatch(std::function<void(const std::string&)> on_gone)
    : on_gone_(std::move(on_gone)), thread_([this] { Run(); }) {}

ClientWatch::~ClientWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ClientWatch::Watch(const std::string& goal_id) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    goal_id_ = goal_id;
  }
  changed_.notify_all();
}

void ClientWatch::Run() {
  for (;;) {
    std::string goal_id;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return is_ending_ || !goal_id_.empty(); });
      if (is_ending_) return;
      goal_id = goal_id_;
    }
    Follow(goal_id);
    std::unique_lock<std::mutex> lock(mutex_);
    if (goal_id_ == goal_id) goal_id_.clear();
  }
}

/// False once the goal is another one, or the watch ends.
bool ClientWatch::Rest(const std::string& goal_id) {
  std::unique_lock<std::mutex> lock(mutex_);
  return !changed_.wait_for(lock, kPeriod, [&] { return is_ending_ || goal_id_ != goal_id; });
}

void ClientWatch::Follow(const std::string& goal_id) {
  const std::string client = ClientOf(goal_id);
  if (client.empty() || client == ros::this_node::getName()) return;
  const auto endpoint = EndpointOf(client);
  if (!endpoint || !AskPid(*endpoint, ros::this_node::getName(), kCallTimeout)) return;
  for (int misses = 0; misses < kMostMisses;) {
    if (!Rest(goal_id)) return;
    misses = AskPid(*endpoint, ros::this_node::getName(), kCallTimeout) ? 0 : misses + 1;
  }
  on_gone_(goal_id);
}

}  // namespace hires_ros
