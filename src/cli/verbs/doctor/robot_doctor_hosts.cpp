#include "cli/verbs/doctor/robot_doctor_hosts.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/short_text.h"
#include "hires/base/text.h"

namespace hires::cli {
namespace {

using hires::base::FirstNames;
using hires::base::Join;
using hires::relay::IsLoopback;

constexpr double kMostSkew = 0.05;       // [s] between two computers
constexpr std::size_t kMostNamed = 4;    // nodes in one finding; the others are counted
constexpr std::size_t kFewMessages = 5;  // fewer say nothing about a clock

std::string HostOf(const std::string& uri) {
  const auto endpoint = hires::relay::ParseUri(uri);
  return endpoint ? endpoint->host : "";
}

bool IsMasterHere(const RobotView& view) { return view.IsHere(HostOf(view.master_uri)); }

/// Whether more than one computer takes part.
bool HasOthers(const RobotView& view) {
  return !IsMasterHere(view) ||
         std::any_of(view.nodes.begin(), view.nodes.end(), [&](const auto& node) {
           return !node.second.host().empty() && !view.IsHere(node.second.host());
         });
}

/// Host of a URI -> nodes there that answer so.
std::map<std::string, std::vector<std::string>> NodesBy(Reach reach, const RobotView& view) {
  std::map<std::string, std::vector<std::string>> nodes;
  for (const auto& [name, node] : view.nodes) {
    if (node.reach == reach) nodes[node.host()].push_back(name);
  }
  return nodes;
}

std::string OwnAddressText(const RobotView& view) {
  return view.own_address ? "ROS_IP=" + *view.own_address
                          : "ROS_IP to this computer's address in the robot's network";
}

RobotFindings JudgeOwnName(const RobotView& view) {
  if (IsMasterHere(view) || !IsLoopback(view.own_host)) return {};
  return {{FindingLevel::kFailed, "own_loopback", "this computer",
           fmt::format("tells the robot to find its nodes at {}, which is the robot itself there",
                       view.own_host),
           fmt::format("unset ROS_HOSTNAME; export {}; then ask again, for nothing was heard",
                       OwnAddressText(view))}};
}

RobotFindings JudgeLoopback(const RobotView& view) {
  if (!HasOthers(view)) return {};
  std::map<std::string, std::vector<std::string>> nodes;
  for (const auto& [name, node] : view.nodes) {
    if (IsLoopback(node.host())) nodes[node.host()].push_back(name);
  }
  RobotFindings findings;
  for (const auto& [host, names] : nodes) {
    findings.push_back(
        {FindingLevel::kFailed, "loopback", "address " + host,
         fmt::format(
             "is what {} told the master; on any other computer it means that computer itself",
             FirstNames(names, kMostNamed)),
         "start them with ROS_IP set to their computer's address (in /etc/ros or the robot's "
         "setup.bash), and without ROS_HOSTNAME=localhost"});
  }
  return findings;
}

/// A name of another computer that this one's /etc/hosts takes for itself.
RobotFindings JudgeLookups(const RobotView& view) {
  RobotFindings findings;
  for (const auto& [host, addresses] : view.addresses) {
    const bool is_loopback = !addresses.empty() && !IsLoopback(host) && !view.IsHere(host) &&
                             std::all_of(addresses.begin(), addresses.end(), IsLoopback);
    if (!is_loopback) continue;
    findings.push_back({FindingLevel::kFailed, "loopback", "host " + host,
                        fmt::format("is looked up as {} here, but is no name of this computer",
                                    Join(addresses, ", ")),
                        "correct its line in /etc/hosts of this computer"});
  }
  for (const auto& [host, nodes] : NodesBy(Reach::kUnresolvable, view)) {
    findings.push_back(
        {FindingLevel::kFailed, "unresolvable", "host " + host,
         fmt::format("cannot be looked up here, so {} cannot be reached",
                     FirstNames(nodes, kMostNamed)),
         fmt::format("add a line 'ADDRESS {}' to /etc/hosts of this computer, or start these nodes "
                     "with ROS_IP=ADDRESS instead of ROS_HOSTNAME",
                     host)});
  }
  return findings;
}

std::vector<std::string> WithPorts(const std::vector<std::string>& nodes, const RobotView& view) {
  std::vector<std::string> texts;
  for (const std::string& name : nodes) {
    const auto endpoint = hires::relay::ParseUri(view.nodes.at(name).uri);
    texts.push_back(endpoint ? fmt::format("{} (port {})", name, endpoint->port) : name);
  }
  return texts;
}

std::string FirewallRemedy(const std::string& host, const RobotView& view) {
  return fmt::format(
      "is it on, and in this network (ping {})? If so, let its firewall pass TCP from {}: ROS "
      "takes "
      "any port from 1024 on (sudo ufw allow from {} to any port 1024:65535 proto tcp)",
      host, view.own_address.value_or("this computer"), view.own_address.value_or("THIS_COMPUTER"));
}

RobotFindings JudgeReach(const RobotView& view) {
  RobotFindings findings;
  for (const auto& [host, nodes] : NodesBy(Reach::kSilent, view)) {
    findings.push_back({FindingLevel::kFailed, "node_unreachable", "host " + host,
                        "does not answer for " + FirstNames(WithPorts(nodes, view), kMostNamed),
                        FirewallRemedy(host, view)});
  }
  for (const auto& [host, nodes] : NodesBy(Reach::kRefused, view)) {
    findings.push_back({FindingLevel::kWarning, "node_gone", "host " + host,
                        "refuses connections to " + FirstNames(WithPorts(nodes, view), kMostNamed),
                        "they have ended without saying so (rosnode cleanup), or a firewall there "
                        "rejects"});
  }
  for (const auto& [host, nodes] : NodesBy(Reach::kBadUri, view)) {
    findings.push_back({FindingLevel::kFailed, "node_unreachable", "master",
                        fmt::format("knows no usable address of {}", FirstNames(nodes, kMostNamed)),
                        "restart these nodes"});
  }
  return findings;
}

RobotFindings JudgeDataPorts(const RobotView& view) {
  RobotFindings findings;
  for (const auto& [name, topic] : view.topics) {
    for (const auto& [node, reach] : topic.data_ports) {
      if (reach == Reach::kAnswers) continue;
      const auto& at = topic.data_at.at(node);
      const char* what = reach == Reach::kUnresolvable ? "cannot be looked up here"
                         : reach == Reach::kRefused    ? "refuses connections"
                                                       : "does not answer";
      findings.push_back(
          {FindingLevel::kFailed, "data_unreachable", "topic " + name,
           fmt::format("{} sends its data from {} port {}, which {}", node, at.host, at.port, what),
           reach == Reach::kUnresolvable
               ? fmt::format("add a line 'ADDRESS {}' to /etc/hosts of this computer", at.host)
               : FirewallRemedy(at.host, view)});
    }
  }
  return findings;
}

RobotFindings JudgeHearing(const RobotView& view) {
  if (view.is_heard.value_or(true) || !JudgeOwnName(view).empty()) return {};
  return {{FindingLevel::kFailed, "not_heard", "this computer",
           fmt::format("/rosout of the robot did not come to fetch this program's log from {}, so "
                       "no node there can hear nodes here",
                       view.own_host),
           fmt::format("can the robot look up that name? If not, export {}; if so, let this "
                       "computer's firewall pass TCP from the robot (ports 1024:65535)",
                       OwnAddressText(view))}};
}

// ---------------------------------------------------------------- clocks

RobotFinding Skewed(const std::string& host, const std::string& how_much, const std::string& why) {
  return {FindingLevel::kFailed, "clock_skew", "clock of " + host,
          fmt::format("is {} this computer's ({})", how_much, why),
          "synchronise both with one server (sudo apt install chrony; on the other computers a "
          "line 'server ROBOT iburst' in /etc/chrony/chrony.conf)"};
}

/// Bounds by questions and answers: sure on both sides.
RobotFindings JudgeBounds(const std::string& host, const ClockBounds& bounds) {
  const std::string why = fmt::format("sure to {:.0f} ms, by {} answers of a Python node there",
                                      0.5e3 * bounds.width(), bounds.num_answers);
  const double middle = 0.5 * (bounds.lower + bounds.upper);
  if (bounds.lower > kMostSkew) {
    return {Skewed(host, fmt::format("{:.3f} s ahead of", middle), why)};
  }
  if (bounds.upper < -kMostSkew) {
    return {Skewed(host, fmt::format("{:.3f} s behind", -middle), why)};
  }
  if (bounds.width() <= 2.0 * kMostSkew) return {};
  return {{FindingLevel::kNote, "clock_unsure", "clock of " + host,
           fmt::format("is between {:.3f} s behind and {:.3f} s ahead of this computer's",
                       -bounds.lower, bounds.upper),
           "the network is too slow to tell; look there with `chronyc tracking`"}};
}

/// What the stamps of one computer's messages say.
struct HostAges {
  double youngest{1e9};  // [s]
  std::string topic;     // of that message
  std::size_t num_messages{0};
};

std::map<std::string, HostAges> AgesByHost(const RobotView& view) {
  std::map<std::string, HostAges> hosts;
  for (const auto& [name, topic] : view.topics) {
    for (const auto& [node, messages] : topic.messages) {
      const auto known = view.nodes.find(node);
      if (known == view.nodes.end() || messages.ages.empty()) continue;
      HostAges& host = hosts[known->second.host()];
      host.num_messages += messages.ages.size();
      const double youngest = *std::min_element(messages.ages.begin(), messages.ages.end());
      if (youngest >= host.youngest) continue;
      host.youngest = youngest;
      host.topic = name;
    }
  }
  return hosts;
}

/// A message cannot come before it is sent, so that a stamp from the future proves a clock that is
/// ahead; a stamp from the past may also be a message that took its time.
RobotFindings JudgeAges(const std::string& host, const HostAges& ages) {
  if (ages.youngest < -kMostSkew) {
    return {Skewed(host, fmt::format("{:.3f} s or more ahead of", -ages.youngest),
                   fmt::format("sure: {} comes before its stamp; by {} messages", ages.topic,
                               ages.num_messages))};
  }
  if (ages.youngest <= kMostSkew || ages.num_messages < kFewMessages) return {};
  return {{FindingLevel::kWarning, "clock_unsure", "clock of " + host,
           fmt::format("may be up to {:.3f} s behind this computer's: no stamp of {} messages is "
                       "younger (not sure: they may be late instead)",
                       ages.youngest, ages.num_messages),
           "look there with `chronyc tracking`, or ask again while a Python node runs there, whose "
           "answers tell the time"}};
}

}  // namespace

RobotFindings JudgeHosts(const RobotView& view) {
  RobotFindings findings = JudgeOwnName(view);
  for (const RobotFindings& more : {JudgeLoopback(view), JudgeLookups(view), JudgeReach(view),
                                    JudgeDataPorts(view), JudgeHearing(view)}) {
    Append(more, &findings);
  }
  return findings;
}

RobotFindings JudgeClocks(const RobotView& view) {
  RobotFindings findings;
  for (const auto& [host, bounds] : view.clocks) {
    if (!view.IsHere(host)) Append(JudgeBounds(host, bounds), &findings);
  }
  if (view.uses_sim_time) return findings;
  for (const auto& [host, ages] : AgesByHost(view)) {
    if (!view.IsHere(host) && view.clocks.count(host) == 0) {
      Append(JudgeAges(host, ages), &findings);
    }
  }
  return findings;
}

}  // namespace hires::cli
