#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "nodes/hires/robot_doctor_view.h"

/// What the nodes of a running system answer to `hires doctor --robot`.
namespace hires_ros {

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

/// Asks all nodes at once, each on a thread of its own, then compares clocks with each other
/// computer; takes a few seconds where some are silent.
/// @param caller_id  under which it asks.
/// @param master     the master's address, which tells the time of its computer.
/// @param view       what the master said, and who this computer is.
/// @param wanted     topics whose data ports are tried as well.
NetworkAnswers AskNetwork(const std::string& caller_id, const hires::relay::Endpoint& master,
                          RobotView view, const std::vector<WantedTopic>& wanted);

/// Puts the answers into what was seen.
void TakeAnswers(const NetworkAnswers& answers, RobotView* view);

}  // namespace hires_ros
