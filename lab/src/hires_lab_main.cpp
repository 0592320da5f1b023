#include <ros/init.h>
#include <ros/package.h>

#include <vector>

#include "lab/src/verbs/command_line.h"
#include "lab/src/experiment/hypothesis_play.h"
#include "lab/src/graph/hypothesis_run.h"
#include "lab/src/graph/scenario_run.h"

int main(int argc, char** argv) {
  std::vector<std::string> arguments;  // roslaunch adds names and remappings that are not ours
  ros::removeROSArgs(argc, argv, arguments);
  hires::lab::LabBackends backends;
  backends.package_folder = ros::package::getPath("hires");
  backends.play_hypothesis = hires::lab::PlayHypothesisRun;
  backends.hypothesis_run = [&](const std::vector<std::string>& words) {
    return hires_ros::RunHypothesisProcess(words, backends.package_folder);
  };
  backends.scenario_run = [&](const std::vector<std::string>& words) {
    return hires_ros::RunScenarioProcess(words, backends.package_folder);
  };
  return hires::lab::RunLabCommandLine(arguments, backends);
}
