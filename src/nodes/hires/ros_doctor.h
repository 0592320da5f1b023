#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/verbs/doctor/finding.h"
#include "hires/relay/listening_sockets.h"
#include "hires/relay/uri.h"

/// The part of `hires doctor` that knows ROS: masters, names, open ports, programs. What is seen is
/// handed in as values, so that every judgement can be tested.
namespace hires_ros {

using hires::cli::Finding;
using hires::cli::FindingLevel;

/// How the nodes of this computer call themselves.
struct NameSettings {
  std::optional<std::string> ros_hostname;  ///< ROS_HOSTNAME
  std::optional<std::string> ros_ip;        ///< ROS_IP
  std::string host_name;                    ///< what counts where neither is set
};

/// Addresses of a host name; none if it is unknown.
using ResolveHost = std::function<std::vector<std::string>(const std::string&)>;

/// Whether that name leads back to this computer, and who else can use it.
std::vector<Finding> JudgeNames(const NameSettings& settings, const ResolveHost& resolve,
                                const hires::relay::HostNames& this_host);

/// @param uri  ROS_MASTER_URI, if it is set.
/// @param ask  process id of the master there, nothing if none answers.
Finding JudgeMaster(const std::optional<std::string>& uri,
                    const std::function<std::optional<int>(const hires::relay::Endpoint&)>& ask);

using SocketOwners = std::map<std::uint64_t, hires::relay::SocketOwner>;

/// ROS programs that other computers can reach, and how to fence them.
/// @param first, last  ports from which the system takes those that programs do not name.
std::vector<Finding> JudgeOpenPorts(const std::vector<hires::relay::ListeningSocket>& sockets,
                                    const SocketOwners& owners, int first, int last);

/// Whether the masters of workers 1 .. num_workers can have the ports base_port + k on loopback.
std::vector<Finding> JudgeWorkerPorts(const std::vector<hires::relay::ListeningSocket>& sockets,
                                      const SocketOwners& owners, int base_port, int num_workers);

/// @param own, wanted  niceness of this program, and of workers.
/// @param is_allowed  whether a program may take `wanted` here.
Finding JudgeNiceness(int own, int wanted, bool is_allowed);

/// @param available  [bytes] where `folder` lies.
Finding JudgeSpace(const std::string& folder, std::uint64_t available);

/// Looks at this computer.
/// @throws hires::base::ConfigError if /proc cannot be read as Linux writes it.
std::vector<Finding> ExamineRos();

/// What ExamineRos() finds, or why it could not look.
std::vector<Finding> CheckRos();

}  // namespace hires_ros
