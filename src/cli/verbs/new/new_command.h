#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace hires::cli {

struct NewOptions {
  CLI::App* verb{nullptr};
  std::vector<std::string> robot;  ///< URDF or xacro file, then arguments of xacro
  std::string output;              ///< ""; the robot's file name with .yaml, here
  bool is_forced{false};           ///< a file that is there is written over
};

void AddNewVerb(CLI::App* app, NewOptions* options);

/// Writes a robot's profile.  @return exit code.  @throws base::ConfigError as robot::WriteProfile,
/// and for a file that is there already or cannot be written.
int RunNewVerb(const NewOptions& options);

}  // namespace hires::cli
