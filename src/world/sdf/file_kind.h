#pragma once

#include <string>

namespace hires::world {

/// What a file that was given as a world is instead, and with which option to give it: a map or its
/// picture, a robot, an object, a mesh, a template that is to be expanded, a bag. Told by its
/// beginning first, by its ending only where that says nothing.
/// @param text  of the file.
/// @return "" if it may be a world.
std::string WhyNoWorld(const std::string& text, const std::string& path);

/// The same of XML, by the name of its outermost element. "" for <sdf>.
std::string WhyNoWorldBy(const std::string& root, const std::string& path);

}  // namespace hires::world
