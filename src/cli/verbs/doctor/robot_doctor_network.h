#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/verbs/doctor/robot_needs.h"
#include "cli/verbs/doctor/robot_view.h"

/// What the nodes of a running system answer to `hires doctor --robot`.
namespace hires::cli {

/// What one node answers.
struct NodeAnswers {
  Reach reach{Reach::kAnswers};
  std::map<std::string, std::pair<hires::relay::Endpoint, Reach>>
      data;  ///< by topic: its data port
};

/// What all nodes answer, and what follows from it.
struct NetworkAnswers {
  std::map<std::string, NodeAnswers> nodes;
  std::map<std::string, std::vector<std::string>> addresses;
  std::map<std::string, ClockBounds> clocks;
};

/// Where a node serves the data of a topic that it publishes, as it says itself; nothing if it does
/// not answer, or has no such topic. Called from several threads at once.
/// @param timeout  [s]
using AskDataPort = std::function<std::optional<hires::relay::Endpoint>(
    const hires::relay::Endpoint& node, const std::string& topic, double timeout)>;

/// Asks all nodes at once, each on a thread of its own, then compares clocks with each other
/// computer; takes a few seconds where some are silent.
/// @param ask_data_port  how nodes are asked.
/// @param master         the master's address, which tells the time of its computer.
/// @param view           what the master said, and who this computer is.
/// @param wanted         topics whose data ports are tried as well.
NetworkAnswers AskNetwork(const AskDataPort& ask_data_port, const hires::relay::Endpoint& master,
                          RobotView view, const std::vector<WantedTopic>& wanted);

/// Puts the answers into what was seen.
void TakeAnswers(const NetworkAnswers& answers, RobotView* view);

}  // namespace hires::cli
