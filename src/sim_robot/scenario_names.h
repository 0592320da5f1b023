#pragma once

#include <string>
#include <vector>

#include "sim_robot/scenario.h"

namespace hires::sim_robot {

/// What is wrong with the names by which scenario, task and knowledge files speak of each other,
/// each with its file and the nearest name: an area of RobotAt that the knowledge does not define;
/// an object that the robot is told of, of which the knowledge says nothing; an object of the task
/// that On places somewhere and the scenario does not have. Other objects of the knowledge may be
/// gone. Such a task can be played, and ends with a robot that looks for what is not there. Empty
/// where the scenario names no knowledge files.
/// @param path   of the scenario.
/// @param areas  that are defined elsewhere.
/// @throws base::ConfigError for a knowledge file that cannot be read.
std::vector<std::string> NamesThatDoNotFit(const Scenario& scenario, const std::string& path,
                                           const std::string& task,
                                           const std::vector<std::string>& areas = {});

}  // namespace hires::sim_robot
