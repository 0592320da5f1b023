#pragma once

#include <tinyxml2.h>

#include <string>

namespace hires::world {

/// Refuses models, links, joints and frames whose poses are relative to one another (`relative_to`,
/// `attached_to`) in a chain of more than `longest`: libsdformat walks the whole chain for each of
/// them. Chains in a circle are its own to tell.
/// @throws base::ConfigError naming file, line and the one whose chain is too long.
void CheckPoseChains(const tinyxml2::XMLElement& root, const std::string& path, int longest);

}  // namespace hires::world
