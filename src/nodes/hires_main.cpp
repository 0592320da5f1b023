#include <ros/package.h>

#include "hires/evaluation/command_line.h"
#include "hires/ros/remote_imagination.h"

int main(int argc, char** argv) {
  hires::evaluation::Backends backends;
  backends.package_folder = ros::package::getPath("hires");
  backends.imagine_remotely = hires_ros::ImagineRemotely;
  return hires::evaluation::RunCommandLine(argc, argv, backends);
}
