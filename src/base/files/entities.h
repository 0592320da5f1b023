#pragma once

#include <string>

namespace hires::base {

/// Refuses XML that uses entities of its own (`<!ENTITY name "text">` in its document type,
/// `&name;` where the text is to stand): no reader here puts the text in, so that names and numbers
/// would be wrong, and a few lines of them can stand for gigabytes.
/// @throws ConfigError naming the entities and the first line that uses one.
void RefuseEntities(const std::string& xml, const std::string& path);

}  // namespace hires::base
