#pragma once

#include <string>
#include <vector>

namespace hires::cli {

/// A file that was given as its path, or by its name in a folder of the package without ".yaml".
/// @param kind    what it is, for the message: "scenario".
/// @param others  what else stands at this place of the command, for the message.
/// @throws base::ConfigError for a name that is not there, with those that are like it.
std::string NamedFile(const std::string& kind, const std::string& name, const std::string& folder,
                      const std::vector<std::string>& others = {});

}  // namespace hires::cli
