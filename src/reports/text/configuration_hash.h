#pragma once

#include <string>

namespace hires::reports {

/// Of what a series of runs reads: all below config/, worlds/ and urdf/, by name and content. A
/// printed result is stale where it carries another one. Comments and white space of YAML files
/// count for nothing; nor does what says only which runs are played or how they are shown:
/// lab/config/experiments, lab/config/reproduce*.yaml, .rviz and .launch files.
/// @return 16 hexadecimal digits.
/// @throws base::ConfigError naming a file that cannot be read or is no YAML.
std::string ConfigurationHash(const std::string& package_folder);

/// The same of one file or folder of the package, experiments included: "config", "worlds".
std::string InputHash(const std::string& package_folder, const std::string& input);

}  // namespace hires::reports
