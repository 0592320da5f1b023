#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"

namespace hires_ros {

/// Private parameters of this node. All errors are hires::base::ConfigError: "~index is 300,
/// wanted ...".
std::optional<std::string> PrivateText(const std::string& key);
/// One that fits; nothing where it is empty. `rosparam` and launch files may have made a bool of
/// it, as of off.
std::optional<std::string> PrivateWord(const std::string& key,
                                       const hires::base::Bound<std::string>& bound);
std::optional<int> PrivateInt(const std::string& key);
std::optional<double> PrivateNumber(const std::string& key);  ///< whole numbers too
std::optional<bool> PrivateBool(const std::string& key);
/// A list of text, or one text split into words as SplitWords does.
std::optional<std::vector<std::string>> PrivateWords(const std::string& key);

/// ~action_libraries: paths of shared libraries with more actions, see skills::LoadActionSet,
/// separated by colons. Never from a file, as they are code.
std::vector<std::string> PrivateActionLibraries();

/// @throws ConfigError naming a private parameter that is not among `known`.
void RejectUnknownPrivate(const std::vector<std::string>& known);

/// Puts `value` into `target` if there is one and it fits.
template <typename T>
void Override(const std::string& key, const std::optional<T>& value,
              const hires::base::Bound<T>& bound, T* target) {
  if (!value) return;
  if (!bound.holds(*value)) {
    throw hires::base::ConfigError(fmt::format("~{} is {}, wanted {}", key, *value, bound.wanted));
  }
  *target = *value;
}

/// Path of the YAML file in ~config.  @throws ConfigError if there is none.
std::string ConfigPath(const std::string& node);

}  // namespace hires_ros
