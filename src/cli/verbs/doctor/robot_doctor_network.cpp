#include "cli/verbs/doctor/robot_doctor_network.h"

#include <future>

namespace hires::cli {
namespace {

using hires::relay::Endpoint;

constexpr double kProbeTimeout = 1.0;  // [s] for one port of a node
constexpr double kClockTimeout = 1.5;  // [s] until the second of another computer changes
constexpr double kClockWidth = 0.02;   // [s] of bounds that are good enough

/// On a thread of its own: silent nodes take their time.
NodeAnswers AskNode(const AskDataPort& ask_data_port, const std::string& uri,
                    const std::vector<std::string>& topics) {
  NodeAnswers answers;
  const auto node = hires::relay::ParseUri(uri);
  answers.reach = node ? ProbePort(*node, kProbeTimeout) : Reach::kBadUri;
  if (answers.reach != Reach::kAnswers) return answers;
  for (const std::string& topic : topics) {
    const auto port = ask_data_port(*node, topic, kProbeTimeout);
    if (port) answers.data[topic] = {*port, ProbePort(*port, kProbeTimeout)};
  }
  return answers;
}

/// Wanted topics by the nodes that publish them.
std::map<std::string, std::vector<std::string>> WantedByNode(const std::vector<WantedTopic>& wanted,
                                                             const RobotView& view) {
  std::map<std::string, std::vector<std::string>> topics;
  for (const WantedTopic& one : wanted) {
    const SeenTopic* topic = view.FindTopic(one.name);
    if (topic == nullptr) continue;
    for (const std::string& node : topic->publishers) topics[node].push_back(one.name);
  }
  return topics;
}

std::optional<ClockBounds> CompareWithAny(const std::vector<Endpoint>& servers) {
  for (const Endpoint& server : servers) {
    if (auto bounds = CompareClocks(server, kClockWidth, kClockTimeout)) return bounds;
  }
  return std::nullopt;
}

/// Only programs that answered: each silent one would take the whole time limit.
std::map<std::string, std::vector<Endpoint>> ClockServers(const Endpoint& master,
                                                          const RobotView& view,
                                                          const NetworkAnswers& answers) {
  std::map<std::string, std::vector<Endpoint>> servers;
  if (!view.IsHere(master.host)) servers[master.host].push_back(master);
  for (const auto& [name, node] : answers.nodes) {
    const auto endpoint = hires::relay::ParseUri(view.nodes.at(name).uri);
    if (node.reach != Reach::kAnswers || view.IsHere(endpoint->host)) continue;
    servers[endpoint->host].push_back(*endpoint);
  }
  return servers;
}

void CompareAllClocks(const Endpoint& master, const RobotView& view, NetworkAnswers* answers) {
  std::map<std::string, std::future<std::optional<ClockBounds>>> running;
  for (const auto& [host, servers] : ClockServers(master, view, *answers)) {
    running[host] = std::async(std::launch::async, CompareWithAny, servers);
  }
  for (auto& [host, future] : running) {
    if (const auto bounds = future.get()) answers->clocks[host] = *bounds;
  }
}

}  // namespace

NetworkAnswers AskNetwork(const AskDataPort& ask_data_port, const Endpoint& master, RobotView view,
                          const std::vector<WantedTopic>& wanted) {
  NetworkAnswers answers;
  std::map<std::string, std::future<std::vector<std::string>>> lookups;
  std::map<std::string, std::future<NodeAnswers>> running;
  auto topics = WantedByNode(wanted, view);
  const bool is_master_here = view.IsHere(master.host);
  for (const auto& [name, node] : view.nodes) {
    const std::string host = node.host();
    if (!host.empty() && lookups.count(host) == 0) {
      lookups[host] = std::async(std::launch::async, AddressesOf, host);
    }
    // A loopback address of another computer would lead to a program of this one.
    if (!is_master_here && hires::relay::IsLoopback(host)) continue;
    running[name] = std::async(std::launch::async, AskNode, ask_data_port, node.uri, topics[name]);
  }
  for (auto& [host, future] : lookups) answers.addresses[host] = future.get();
  for (auto& [name, future] : running) answers.nodes[name] = future.get();
  for (const auto& [host, addresses] : answers.addresses) view.addresses[host] = addresses;
  CompareAllClocks(master, view, &answers);
  return answers;
}

void TakeAnswers(const NetworkAnswers& answers, RobotView* view) {
  for (const auto& [host, addresses] : answers.addresses) view->addresses[host] = addresses;
  view->clocks = answers.clocks;
  for (const auto& [name, node] : answers.nodes) {
    view->nodes[name].reach = node.reach;
    for (const auto& [topic, data] : node.data) {
      view->topics[topic].data_at[name] = data.first;
      view->topics[topic].data_ports[name] = data.second;
    }
  }
}

}  // namespace hires::cli
