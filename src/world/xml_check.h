#pragma once

#include <cstddef>
#include <string>

namespace tinyxml2 {
class XMLDocument;
}

namespace hires::world {

/// What one SDF or URDF file and all it includes may hold, so that no file exhausts memory or
/// stack. Files that are included twice count twice.
struct XmlLimits {
  std::size_t max_file_bytes{16u << 20};
  int max_element_depth{64};
  int max_include_depth{16};
  int max_elements{200000};
  int max_models{10000};    ///< of a world or model, and as many frames
  int max_links{2000};      ///< of a model
  int max_pose_chain{100};  ///< of poses that are relative to one another in a world or model
};

/// Checks well-formedness, size and depth of the XML in `text` without looking at its meaning.
/// @throws base::ConfigError naming `path` and line.
void CheckXml(const std::string& text, const std::string& path, const XmlLimits& limits = {});

/// The same, and keeps what was parsed.
void ParseXml(const std::string& text, const std::string& path, const XmlLimits& limits,
              tinyxml2::XMLDocument* document);

}  // namespace hires::world
