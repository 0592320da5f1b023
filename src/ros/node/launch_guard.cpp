#include "hires/ros/node/launch_guard.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <ros/duration.h>
#include <ros/master.h>
#include <ros/package.h>
#include <ros/this_node.h>
#include <signal.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "hires/relay/uri.h"
#include "hires/ros/master/xmlrpc_master_api.h"

namespace hires_ros {
namespace {

namespace fs = std::filesystem;

constexpr char kSimulated[] = "HIRES_SIMULATED_ROBOT";
constexpr double kCallTimeout = 0.5;  // [s]
constexpr double kPatience = 15.0;    // [s] as long as roslaunch waits for nodes that it ends

/// The process that bears the name and answers.
std::optional<int> BearerOf(const std::string& name) {
  XmlRpcMasterApi master(ros::master::getURI(), name, kCallTimeout);
  const auto uri = master.LookupNode(name);
  if (!uri) return std::nullopt;
  const auto endpoint = hires::relay::ParseUri(*uri);
  return endpoint ? AskPid(*endpoint, name, kCallTimeout) : std::nullopt;
}

std::vector<std::string> CommandOf(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/cmdline", process), std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

/// Of the program and of what it interprets: /usr/bin/python3 /usr/bin/roslaunch.
bool IsRoslaunch(const std::vector<std::string>& command) {
  const auto end =
      command.begin() + std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(command.size()));
  return std::any_of(command.begin(), end, [](const std::string& word) {
    return fs::path(word).filename() == "roslaunch";
  });
}

/// Whether it was asked for a launch file of this package, by whatever path, and not for one that
/// includes it: a robot's drivers are not ours to end. Where the robot is simulated, the launch
/// file says that there are none.
bool LaunchesThisPackage(pid_t roslaunch) {
  if (std::getenv(kSimulated) != nullptr) return true;
  std::error_code error;  // what is no file is none of ours
  const fs::path at = fs::read_symlink(fmt::format("/proc/{}/cwd", roslaunch), error);
  const fs::path package = fs::canonical(ros::package::getPath("hires"), error);
  const std::vector<std::string> command = CommandOf(roslaunch);
  return std::any_of(command.begin(), command.end(), [&](const std::string& word) {
    if (word == "hires") return true;
    if (!fs::is_regular_file(at / word, error)) return false;
    const fs::path below = fs::canonical(at / word, error).lexically_relative(package);
    return !below.empty() && *below.begin() != "..";
  });
}

void EndOwnLaunch() {
  if (LaunchesThisPackage(getppid())) EndLaunch();
}

}  // namespace

void EndLaunch() {
  const pid_t parent = getppid();
  if (!IsRoslaunch(CommandOf(parent))) return;
  std::fflush(nullptr);  // what was printed, before a signal ends this process
  std::signal(SIGINT, SIG_DFL);
  sigset_t interrupt;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  pthread_sigmask(SIG_UNBLOCK, &interrupt, nullptr);  // nodes that wait for signals block it
  if (kill(parent, SIGINT) != 0) return;
  // A child that ends before roslaunch ends it would be called dead, or started again.
  ros::WallDuration(kPatience).sleep();
}

int EndMisconfigured(const std::string& node, const hires::base::ConfigError& error) {
  ROS_FATAL("%s: %s", node.c_str(), error.what());
  EndOwnLaunch();
  return EXIT_FAILURE;
}

bool ClaimName() {
  const std::string name = ros::this_node::getName();
  const auto bearer = BearerOf(name);
  if (!bearer || *bearer == getpid()) return true;
  ROS_FATAL("%s",
            fmt::format("{}: process {} bears this name at the master {} already; end the other "
                        "launch, or give this one a master of its own (roslaunch -p PORT) and "
                        "another base_port",
                        name, *bearer, ros::master::getURI())
                .c_str());
  EndOwnLaunch();
  return false;
}

}  // namespace hires_ros
