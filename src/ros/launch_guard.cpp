#include "hires/ros/launch_guard.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <ros/duration.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "hires/relay/uri.h"
#include "hires/ros/xmlrpc_master_api.h"

namespace hires_ros {
namespace {

constexpr double kCallTimeout = 0.5;  // [s]
constexpr double kPatience = 1.0;     // [s]

/// The process that bears the name and answers.
std::optional<int> BearerOf(const std::string& name) {
  XmlRpcMasterApi master(ros::master::getURI(), name, kCallTimeout);
  const auto uri = master.LookupNode(name);
  if (!uri) return std::nullopt;
  const auto endpoint = hires::relay::ParseUri(*uri);
  return endpoint ? AskPid(*endpoint, name, kCallTimeout) : std::nullopt;
}

/// Of the program and of what it interprets: /usr/bin/python3 /usr/bin/roslaunch.
bool IsRoslaunch(pid_t process) {
  std::ifstream words(fmt::format("/proc/{}/cmdline", process), std::ios::binary);
  std::string word;
  for (int i = 0; i < 2 && std::getline(words, word, '\0'); ++i) {
    if (std::filesystem::path(word).filename() == "roslaunch") return true;
  }
  return false;
}

}  // namespace

void EndLaunch() {
  const pid_t parent = getppid();
  if (!IsRoslaunch(parent) || kill(parent, SIGINT) != 0) return;
  // A child that ends before roslaunch has understood would be called dead, or started again.
  ros::WallDuration(kPatience).sleep();
}

int EndMisconfigured(const std::string& node, const hires::base::ConfigError& error) {
  ROS_FATAL("%s: %s", node.c_str(), error.what());
  EndLaunch();
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
  EndLaunch();
  return false;
}

}  // namespace hires_ros
