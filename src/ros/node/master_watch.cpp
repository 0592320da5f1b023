#include "hires/ros/node/master_watch.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

#include "hires/base/check.h"
#include "hires/base/log.h"
#include "hires/ros/master/xmlrpc_master_api.h"

namespace hires_ros {
namespace {

using hires::base::Log;
using hires::base::LogLevel;
using XmlRpc::XmlRpcValue;
using SteadyClock = std::chrono::steady_clock;

/// Looks in a row that must find the node unregistered: it may just be starting.
constexpr int kMissingLooks = 3;

std::optional<int> PidOf(BoundedXmlRpcClient* master) {
  auto reply = CallRos(master, "getPid", ros::this_node::getName(), {});
  if (!reply || reply->value.getType() != XmlRpcValue::TypeInt) return std::nullopt;
  return static_cast<int>(reply->value);
}

/// Empty if none is set: a bare rosmaster has none, roslaunch sets one.
std::optional<std::string> RunIdOf(BoundedXmlRpcClient* master) {
  auto reply = CallRos(master, "getParam", ros::this_node::getName(), {"/run_id"});
  if (!reply) return std::nullopt;
  if (reply->code != 1 || reply->value.getType() != XmlRpcValue::TypeString) return "";
  return static_cast<std::string>(reply->value);
}

/// Whether the master knows a node of this name, wherever it lives. Nothing: no answer.
std::optional<bool> IsRegistered(BoundedXmlRpcClient* master) {
  const auto reply =
      CallRos(master, "lookupNode", ros::this_node::getName(), {ros::this_node::getName()});
  if (!reply) return std::nullopt;
  return reply->code == 1;
}

void PutBack(const std::string& key, const XmlRpcValue& value, BoundedXmlRpcClient* master) {
  const auto there = CallRos(master, "hasParam", ros::this_node::getName(), {key});
  if (!there || static_cast<bool>(XmlRpcValue(there->value))) return;
  XmlRpcValue params;
  params[0] = ros::this_node::getName();
  params[1] = key;
  params[2] = value;
  master->Call("setParam", params);
}

/// One look at the master; nothing: no answer.
struct Look {
  int pid{0};
  std::string run_id;
  bool is_registered{false};
};

std::optional<Look> LookAt(BoundedXmlRpcClient* master) {
  const auto pid = PidOf(master);
  if (!pid) return std::nullopt;
  const auto run_id = RunIdOf(master);
  if (!run_id) return std::nullopt;
  const auto is_registered = IsRegistered(master);
  if (!is_registered) return std::nullopt;
  return Look{*pid, *run_id, *is_registered};
}

/// Tells a new master from the old one by what was seen before.
class Memory {
 public:
  bool SaysReplaced(const Look& look) {
    num_missing_ = look.is_registered ? 0 : num_missing_ + 1;
    if (!first_) first_ = look;
    // roslaunch sets the run id a moment after the master is up.
    if (first_->run_id.empty() && first_->pid == look.pid) first_->run_id = look.run_id;
    const bool is_other_run = !look.run_id.empty() && look.run_id != first_->run_id;
    return look.pid != first_->pid || is_other_run || num_missing_ >= kMissingLooks;
  }

 private:
  std::optional<Look> first_;
  int num_missing_{0};
};

std::vector<std::string> ProgramArguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::vector<std::string> arguments;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = text.find('\0', begin);
    arguments.push_back(text.substr(begin, end - begin));
    begin = end == std::string::npos ? text.size() : end + 1;
  }
  return arguments;
}

void ShutDownOnSignal(int) { ros::requestShutdown(); }

volatile std::sig_atomic_t stop_wanted = 0;

void WantStop(int /*signal*/) { stop_wanted = 1; }

void OnStopSignals(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

}  // namespace

MasterWatch::MasterWatch(const MasterWatchParams& params) : params_(params) {
  HIRES_CHECK(ros::isStarted(), "a master is watched by a node that is registered");
  for (const std::string& key : {ros::this_node::getName(), std::string("/use_sim_time")}) {
    XmlRpcValue value;
    if (ros::param::get(key, value)) parameters_[key] = value;
  }
  thread_ = std::thread([this] { Run(); });
}

MasterWatch::~MasterWatch() { Stop(); }

void MasterWatch::Stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_stopping_ = true;
  }
  stop_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void MasterWatch::Run() {
  const auto endpoint = hires::relay::RequireMasterUri(ros::master::getURI(), "ROS_MASTER_URI");
  BoundedXmlRpcClient master(endpoint, params_.call_timeout);
  Memory memory;
  auto last_answer = SteadyClock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!is_stopping_) {
    lock.unlock();
    const auto look = LookAt(&master);
    const auto now = SteadyClock::now();
    if (look) last_answer = now;
    silent_for_ = look ? 0.0 : std::chrono::duration<double>(now - last_answer).count();
    if (look && memory.SaysReplaced(*look)) {
      Log(LogLevel::kWarn, "master=main state=replaced: this node starts again to register there");
      for (const auto& [key, value] : parameters_) PutBack(key, value, &master);
      is_replaced_ = true;
      ros::requestShutdown();
      return;
    }
    lock.lock();
    stop_.wait_for(lock, std::chrono::duration<double>(params_.poll_period),
                   [this] { return is_stopping_; });
  }
}

int MasterWatch::Finish(int code) {
  Stop();
  if (!is_replaced_) return code;
  ros::shutdown();
  RestartProgram();
  return EXIT_FAILURE;
}

void RestartProgram() {
  std::vector<std::string> arguments = ProgramArguments();
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  std::array<char, 4096> path{};
  if (readlink("/proc/self/exe", path.data(), path.size() - 1) <= 0) return;
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  execv(path.data(), argv.data());
}

void ShutDownRosOnSignals() { OnStopSignals(ShutDownOnSignal, 0); }
void NoteStopSignals() { OnStopSignals(WantStop, SA_RESTART); }
bool IsStopWanted() { return stop_wanted != 0; }

}  // namespace hires_ros
