#include <ros/init.h>
#include <ros/package.h>

#include <vector>

#include "hires/evaluation/command_line.h"
#include "hires/ros/remote_imagination.h"

int main(int argc, char** argv) {
  std::vector<std::string> arguments;  // roslaunch adds names and remappings that are not ours
  ros::removeROSArgs(argc, argv, arguments);
  hires::evaluation::Backends backends;
  backends.package_folder = ros::package::getPath("hires");
  backends.imagine_remotely = hires_ros::ImagineRemotely;
  return hires::evaluation::RunCommandLine(arguments, backends);
}
