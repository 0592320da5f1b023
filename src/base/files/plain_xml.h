#pragma once

#include <string>

namespace hires::base {

/// The same text with comments, processing instructions (<?xml ...?>), document types and a byte
/// order mark replaced by blanks, line by line: what is left is in its place, and readers that want
/// <?xml in front of all comments, or the text of an element in one piece, are content. CDATA
/// stays. Entities that a document type defines are not expanded; nothing that HIRES reads has any.
/// @param path  for messages.
/// @throws ConfigError naming path and line: a comment or the like that does not end, or text
/// in UTF-16.
std::string PlainXml(std::string text, const std::string& path);

}  // namespace hires::base
