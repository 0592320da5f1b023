#include "world/xml_check.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include "hires/base/error.h"

namespace hires::world {
namespace {

[[noreturn]] void FailByDepth(const std::string& place, const XmlLimits& limits) {
  throw base::ConfigError(fmt::format("{}: elements nest more than {} deep; flatten them", place,
                                      limits.max_element_depth));
}

/// @return how many elements there are.
int CheckElement(const tinyxml2::XMLElement& element, const std::string& path, int depth,
                 const XmlLimits& limits) {
  if (depth > limits.max_element_depth)
    FailByDepth(fmt::format("{}:{}", path, element.GetLineNum()), limits);
  int count = 1;
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    count += CheckElement(*child, path, depth + 1, limits);
  }
  return count;
}

}  // namespace

void ParseXml(const std::string& text, const std::string& path, const XmlLimits& limits,
              tinyxml2::XMLDocument* document) {
  const tinyxml2::XMLError error = document->Parse(text.data(), text.size());
  if (error == tinyxml2::XML_ERROR_EMPTY_DOCUMENT) {
    throw base::ConfigError(fmt::format("{}: is empty, wanted XML; name another file", path));
  }
  if (error == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    FailByDepth(fmt::format("{}:{}", path, document->ErrorLineNum()), limits);
  if (document->Error()) {
    throw base::ConfigError(fmt::format("{}:{}: not well-formed XML ({}); correct it there", path,
                                        document->ErrorLineNum(), document->ErrorName()));
  }
  const tinyxml2::XMLElement* root = document->RootElement();
  if (root == nullptr || CheckElement(*root, path, 1, limits) <= limits.max_elements) return;
  throw base::ConfigError(
      fmt::format("{}: more than {} elements; split it, or replace many bodies by a mesh", path,
                  limits.max_elements));
}

void CheckXml(const std::string& text, const std::string& path, const XmlLimits& limits) {
  tinyxml2::XMLDocument document;
  ParseXml(text, path, limits, &document);
}

}  // namespace hires::world
