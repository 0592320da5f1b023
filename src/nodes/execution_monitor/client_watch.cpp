#include "nodes/execution_monitor/client_watch.h"

#include <fmt/format.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <chrono>
#include <utility>

#include "hires/base/log.h"
#include "hires/relay/master_api.h"
#include "hires/ros/master/xmlrpc_master_api.h"

namespace hires_ros {
namespace {

constexpr auto kPeriod = std::chrono::seconds(1);
constexpr double kCallTimeout = 1.0;  // [s]
constexpr int kMostRefusals = 3;      // in a row: nothing listens where the client did
constexpr int kMostSilences = 15;     // in a row, half a minute: a busy computer is slow to answer
constexpr int kToldSilences = 3;      // from then on it is said

using Reply = hires::relay::PingReply::Kind;

std::string UriOf(const std::string& node) {
  XmlRpcMasterApi master(ros::master::getURI(), ros::this_node::getName(), kCallTimeout);
  return master.LookupNode(node).value_or("");
}

Reply Ping(const std::string& uri) {
  return XmlRpcPinger(ros::this_node::getName(), kCallTimeout).Ping({uri}).front().kind;
}

void TellOfSilence(const std::string& client) {
  hires::base::Log(
      hires::base::LogLevel::kWarn,
      fmt::format("{}, which asked for the task, is slow to answer or cut off; the task is "
                  "preempted once {} calls in a row are lost",
                  client, kMostSilences));
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
  const std::string uri = UriOf(client);
  if (uri.empty() || Ping(uri) != Reply::kAnswered) return;
  for (int refusals = 0, silences = 0; refusals < kMostRefusals && silences < kMostSilences;) {
    if (!Rest(goal_id)) return;
    const Reply reply = Ping(uri);
    refusals = reply == Reply::kRefused ? refusals + 1 : 0;
    silences = reply == Reply::kAnswered ? 0 : silences + 1;
    if (silences == kToldSilences && refusals == 0) TellOfSilence(client);
  }
  on_gone_(goal_id);
}

}  // namespace hires_ros
