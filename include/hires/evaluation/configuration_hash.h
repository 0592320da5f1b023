#pragma once

#include <string>

namespace hires::evaluation {

/// Of what a series of runs reads: all below config/, worlds/ and urdf/, by name and content. A
/// printed result is stale where it carries another one. Comments and white space of YAML files
/// count for nothing; nor does what says only which runs are played or how they are shown:
/// config/experiments, config/reproduce*.yaml, .rviz and .launch files.
/// @return 16 hexadecimal digits.
/// @throws base::ConfigError naming a file that cannot be read or is no YAML.
std::string ConfigurationHash(const std::string& package_folder);

/// What of a file counts for a result that rests on it: of YAML all but comments and white space.
/// @throws base::ConfigError naming the file, which cannot be read or is no YAML.
std::string ContentThatCounts(const std::string& path);

}  // namespace hires::evaluation
