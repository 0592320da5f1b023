#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/skills/action_set.h"

namespace hires::skills {

/// The robot's own actions and those of shared libraries, in this order. A library is code: its
/// path may come from a command line or a parameter of a node, never from a data file. It stays
/// loaded until the process ends.
/// @throws base::ConfigError naming the library: it is missing, cannot be loaded, holds no actions,
/// was built with other headers; or an action of it makes no sense, or has a name that another has.
std::shared_ptr<const ActionSet> LoadActionSet(const std::vector<std::string>& libraries);

/// Why a worker with `own` does not play for a client whose actions have the hash `wanted`, with
/// the libraries that are loaded here; "" where both are the same.
std::string WhyActionsDiffer(std::uint64_t wanted, const ActionSet& own);

}  // namespace hires::skills
