#pragma once

#include <string>
#include <vector>

namespace hires::base {

/// The names that things have in a folder: of its files NAME.yaml, in order; none where it is none.
std::vector<std::string> NamesIn(const std::string& folder);

/// The path of NAME.yaml in a folder of things that have names there.
/// @param kind    what it is, for the message: "truth".
/// @param others  what else stands at this place of the command, for the message.
/// @throws ConfigError for a name that is not there, with those that are like it.
std::string FileNamed(const std::string& kind, const std::string& name, const std::string& folder,
                      const std::vector<std::string>& others = {});

/// Likewise, or a path: what has a folder or an ending, or is a file where the program runs.
std::string NamedFile(const std::string& kind, const std::string& name, const std::string& folder,
                      const std::vector<std::string>& others = {});

}  // namespace hires::base
