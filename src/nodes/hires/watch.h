#pragma once

#include <string>
#include <vector>

namespace hires_ros {

/// The verb `watch`: plays a bag of `hires imagine --save-rollout` under a master of its own for
/// RViz, with keys to pause and seek.
/// @param arguments  what follows the verb.
/// @return exit code.  @throws hires::base::ConfigError for a bag that is none of a rollout.
int RunWatch(const std::vector<std::string>& arguments, const std::string& package_folder);

}  // namespace hires_ros
