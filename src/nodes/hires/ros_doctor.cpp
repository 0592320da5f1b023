#include "nodes/hires/ros_doctor.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "cli/verbs/doctor/network_probe.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/text.h"
#include "hires/relay/worker_host_params.h"
#include "hires/ros/master/xmlrpc_master_api.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::relay::Endpoint;
using hires::relay::HostNames;
using hires::relay::IsLoopback;

constexpr int kNumWorkers = 8;          // whose ports are looked at
constexpr double kPidTimeout = 1.0;     // [s]
constexpr int kMainMasterPort = 11311;  // ROS's own default
constexpr double kLittleSpace = 1e9;    // [bytes] an hour of recording at 300 kB/s

// ---------------------------------------------------------------- names

std::string Joined(const std::vector<std::string>& parts) { return hires::base::Join(parts, ", "); }

bool IsDotted(const std::string& text) {
  in_addr address;
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

/// One finding for the name under which nodes can be called.
/// @param what  "ROS_IP", "ROS_HOSTNAME" or "the host's name".
Finding JudgeName(const std::string& what, const std::string& name, const ResolveHost& resolve,
                  const HostNames& this_host) {
  const std::vector<std::string> addresses = resolve(name);
  if (addresses.empty()) {
    return {FindingLevel::kFailed,
            fmt::format(
                "{} is '{}', a name that cannot be looked up, so nodes cannot reach each other; "
                "set ROS_HOSTNAME=localhost, or add the name to /etc/hosts",
                what, name)};
  }
  const bool is_ours =
      std::any_of(addresses.begin(), addresses.end(), [&](const std::string& address) {
        return IsLoopback(address) || this_host.count(address) > 0;
      });
  if (!is_ours) {
    return {FindingLevel::kFailed,
            fmt::format("{} is '{}', that is {}, no address of this computer, so nothing can reach "
                        "its nodes; set ROS_HOSTNAME=localhost, or ROS_IP to one of its addresses",
                        what, name, Joined(addresses))};
  }
  if (std::all_of(addresses.begin(), addresses.end(), IsLoopback)) {
    return {FindingLevel::kOk,
            fmt::format("{} is '{}': nodes talk within this computer", what, name)};
  }
  return {FindingLevel::kNote,
          fmt::format("{} is '{}', that is {}: other computers can talk to these nodes and command "
                      "the robot; if that is not wanted, set ROS_HOSTNAME=localhost",
                      what, name, Joined(addresses))};
}

// ---------------------------------------------------------------- ports

std::string OwnerText(const hires::relay::ListeningSocket& socket, const SocketOwners& owners) {
  const auto owner = owners.find(socket.inode);
  if (owner == owners.end()) return fmt::format("a program of user id {}", socket.uid);
  return fmt::format("{} (process id {})", owner->second.name, owner->second.pid);
}

std::string FenceText(int first, int last) {
  return fmt::format(
      "roscpp opens a port on all interfaces whatever ROS_IP says; fence them on this computer:\n"
      "sudo nft add table inet hires\n"
      "sudo nft 'add chain inet hires input {{ type filter hook input priority 0; }}'\n"
      "sudo nft 'add rule inet hires input iif != lo ct state new tcp dport "
      "{{ {}, {}-{}, {}-{} }} drop'\n"
      "or, where ufw is used: sudo ufw default deny incoming (allow ssh first: sudo ufw allow ssh)",
      kMainMasterPort, hires::relay::WorkerHostParams().base_port + 1,
      hires::relay::WorkerHostParams().base_port + kNumWorkers, first, last);
}

bool BlocksLoopback(const hires::relay::ListeningSocket& socket) {
  return socket.is_everywhere() || socket.address == "127.0.0.1";
}

Finding TakenPort(int worker, const hires::relay::ListeningSocket& socket,
                  const SocketOwners& owners) {
  const auto owner = owners.find(socket.inode);
  if (owner != owners.end() && owner->second.name == "rosmaster") {
    return {FindingLevel::kOk, fmt::format("port {} has a master: worker {} runs, {}", socket.port,
                                           worker, OwnerText(socket, owners))};
  }
  return {FindingLevel::kWarning,
          fmt::format("port {} is taken by {}, so worker {} cannot start; end that program, or "
                      "choose other ports with base_port:=...",
                      socket.port, OwnerText(socket, owners), worker)};
}

// ---------------------------------------------------------------- this computer

std::optional<std::string> Variable(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return std::string(value);
}

std::string HostName() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string LogFolder() {
  if (const auto folder = Variable("ROS_LOG_DIR")) return *folder;
  if (const auto home = Variable("ROS_HOME")) return *home + "/log";
  return Variable("HOME").value_or("") + "/.ros/log";
}

std::vector<hires::relay::ListeningSocket> ListeningHere() {
  if (!std::filesystem::exists("/proc/net/tcp")) {
    throw ConfigError(
        "/proc/net/tcp is missing, so what listens here is unknown; mount /proc (is this "
        "Linux?)");
  }
  std::vector<hires::relay::ListeningSocket> sockets;
  for (const char* path : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(path);  // has no size, so ReadTextFile() is not for it; tcp6 may be missing
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto more = hires::relay::ParseListeningSockets(text, path);
    sockets.insert(sockets.end(), more.begin(), more.end());
  }
  return sockets;
}

/// Whether a process may take that niceness; tried by one that does nothing else.
bool MayBeNice(int nice) {
  const pid_t child = fork();
  if (child == 0) _exit(setpriority(PRIO_PROCESS, 0, nice) == 0 ? 0 : 1);
  int status = 1;
  if (child < 0 || waitpid(child, &status, 0) != child) return false;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::vector<Finding> ExaminePorts() {
  const std::vector<hires::relay::ListeningSocket> sockets = ListeningHere();
  const SocketOwners owners = hires::relay::FindSocketOwners(sockets, "/proc", LogFolder());
  int first = 32768, last = 60999;  // Linux's defaults
  std::ifstream("/proc/sys/net/ipv4/ip_local_port_range") >> first >> last;
  std::vector<Finding> findings = JudgeOpenPorts(sockets, owners, first, last);
  for (Finding& finding :
       JudgeWorkerPorts(sockets, owners, hires::relay::WorkerHostParams().base_port, kNumWorkers)) {
    findings.push_back(std::move(finding));
  }
  return findings;
}

std::vector<Finding> ExaminePrograms() {
  std::vector<Finding> findings;
  const std::vector<std::string> programs{"rosmaster", "relay", "sim_worker", "worker_host",
                                          "imagination_client"};
  for (const std::string& program : programs) {
    try {
      hires::base::FindExecutable(program);
    } catch (const ConfigError& error) {
      findings.push_back({FindingLevel::kFailed, error.what()});
    }
  }
  if (findings.empty()) {
    findings.push_back({FindingLevel::kOk, "programs found: " + Joined(programs)});
  }
  return findings;
}

Finding ExamineSpace() {
  std::filesystem::path folder = LogFolder();
  std::error_code error;
  while (!std::filesystem::exists(folder, error) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  const auto space = std::filesystem::space(folder, error);
  return JudgeSpace(folder.string(), error ? 0 : space.available);
}

}  // namespace

std::vector<Finding> JudgeNames(const NameSettings& settings, const ResolveHost& resolve,
                                const HostNames& this_host) {
  std::vector<Finding> findings;
  if (settings.ros_hostname && settings.ros_ip) {
    findings.push_back({FindingLevel::kWarning,
                        fmt::format("ROS_HOSTNAME '{}' and ROS_IP '{}' are both set, only the "
                                    "first one counts; unset the other",
                                    *settings.ros_hostname, *settings.ros_ip)});
  }
  if (settings.ros_hostname) {
    findings.push_back(JudgeName("ROS_HOSTNAME", *settings.ros_hostname, resolve, this_host));
  } else if (settings.ros_ip && !IsDotted(*settings.ros_ip)) {
    findings.push_back({FindingLevel::kFailed,
                        fmt::format("ROS_IP is '{}', wanted an address such as 127.0.0.1; names "
                                    "belong into ROS_HOSTNAME",
                                    *settings.ros_ip)});
  } else if (settings.ros_ip) {
    findings.push_back(JudgeName("ROS_IP", *settings.ros_ip, resolve, this_host));
  } else {
    findings.push_back(JudgeName("ROS_HOSTNAME is not set, so the host's name counts: it",
                                 settings.host_name, resolve, this_host));
  }
  return findings;
}

Finding JudgeMaster(const std::optional<std::string>& uri,
                    const std::function<std::optional<int>(const Endpoint&)>& ask) {
  if (!uri) {
    return {FindingLevel::kWarning,
            "ROS_MASTER_URI is not set, nodes will not start; source the workspace's setup.bash, "
            "or set ROS_MASTER_URI=http://localhost:11311"};
  }
  std::optional<int> pid;
  try {
    pid = ask(hires::relay::RequireMasterUri(*uri, "ROS_MASTER_URI"));
  } catch (const ConfigError& error) {
    return {FindingLevel::kFailed, error.what()};
  }
  if (pid) {
    return {FindingLevel::kOk,
            fmt::format("a master answers at {} (process id {} there)", *uri, *pid)};
  }
  return {FindingLevel::kNote,
          fmt::format("no master answers at {}; roslaunch starts one when it is needed", *uri)};
}

std::vector<Finding> JudgeOpenPorts(const std::vector<hires::relay::ListeningSocket>& sockets,
                                    const SocketOwners& owners, int first, int last) {
  std::set<std::string> lines;  // a program that listens on IPv4 and IPv6 alike is named once
  for (const hires::relay::ListeningSocket& socket : sockets) {
    const auto owner = owners.find(socket.inode);
    if (socket.is_loopback() || owner == owners.end() || !owner->second.is_ros) continue;
    lines.insert(
        fmt::format("{} port {}: {}", socket.address, socket.port, OwnerText(socket, owners)));
  }
  if (lines.empty()) {
    return {{FindingLevel::kOk, "no ROS program of yours listens beyond this computer"}};
  }
  std::string text = "ROS programs that accept commands from any other computer:\n";
  for (const std::string& line : lines) text += "  " + line + '\n';
  return {{FindingLevel::kWarning, text + FenceText(first, last)}};
}

std::vector<Finding> JudgeWorkerPorts(const std::vector<hires::relay::ListeningSocket>& sockets,
                                      const SocketOwners& owners, int base_port, int num_workers) {
  std::vector<Finding> findings;
  for (int k = 1; k <= num_workers; ++k) {
    const auto taken = std::find_if(sockets.begin(), sockets.end(),
                                    [&](const hires::relay::ListeningSocket& socket) {
                                      return socket.port == base_port + k && BlocksLoopback(socket);
                                    });
    if (taken != sockets.end()) findings.push_back(TakenPort(k, *taken, owners));
  }
  if (findings.empty()) {
    findings.push_back(
        {FindingLevel::kOk, fmt::format("ports {} to {} are free for masters of workers",
                                        base_port + 1, base_port + num_workers)});
  }
  return findings;
}

Finding JudgeNiceness(int own, int wanted, bool is_allowed) {
  if (own > wanted) {
    return {
        FindingLevel::kWarning,
        fmt::format("this shell runs at niceness {}, above the {} of workers, so what it starts "
                    "yields to them; open another one, or start workers with nice:={}",
                    own, wanted, own)};
  }
  if (!is_allowed) {
    return {FindingLevel::kFailed,
            fmt::format("niceness {} is refused here, so workers cannot start; allow setpriority() "
                        "(a container's profile?), or start workers with nice:=0",
                        wanted)};
  }
  return {FindingLevel::kOk,
          fmt::format("workers may run at niceness {}, behind all others at {}", wanted, own)};
}

Finding JudgeSpace(const std::string& folder, std::uint64_t available) {
  const double gigabytes = static_cast<double>(available) / 1e9;
  if (static_cast<double>(available) >= kLittleSpace) {
    return {FindingLevel::kOk,
            fmt::format("{:.1f} GB are free for logs and bags in {}", gigabytes, folder)};
  }
  return {
      FindingLevel::kWarning,
      fmt::format("only {:.1f} GB are free for logs and bags in {}; make room (`rosclean purge` "
                  "drops old logs), or set ROS_LOG_DIR to a larger disk",
                  gigabytes, folder)};
}

std::vector<Finding> ExamineRos() {
  QuietXmlRpc();
  const auto ask = [](const Endpoint& master) {
    return AskPid(master, "/hires_doctor", kPidTimeout);
  };
  std::vector<Finding> findings{JudgeMaster(Variable("ROS_MASTER_URI"), ask)};
  const NameSettings settings{Variable("ROS_HOSTNAME"), Variable("ROS_IP"), HostName()};
  const auto append = [&](const std::vector<Finding>& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  append(JudgeNames(settings, hires::cli::AddressesOf, NamesOfThisHost()));
  append(ExaminePorts());
  append(ExaminePrograms());
  const int nice = hires::relay::WorkerHostParams().nice;
  append({JudgeNiceness(getpriority(PRIO_PROCESS, 0), nice, MayBeNice(nice)), ExamineSpace()});
  return findings;
}

std::vector<Finding> CheckRos() {
  try {
    return ExamineRos();
  } catch (const ConfigError& error) {
    return {{FindingLevel::kFailed, error.what()}};
  }
}

}  // namespace hires_ros
