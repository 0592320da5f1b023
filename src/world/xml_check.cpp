#include "world/xml_check.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/files/missing_files.h"

namespace hires::world {
namespace {

/// Walks a file and all it includes before libsdformat does, which trusts its input.
class XmlWalk {
 public:
  XmlWalk(const ResourceFinder* finder, const XmlLimits& limits)
      : finder_(finder), limits_(limits) {}

  void VisitFile(const std::string& path) {
    CheckIncludes(path);
    open_files_.push_back(path);
    VisitText(base::ReadTextFile(path, limits_.max_file_bytes), path);
    open_files_.pop_back();
  }

  void VisitText(const std::string& text, const std::string& path) {
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) == tinyxml2::XML_ERROR_EMPTY_DOCUMENT) {
      throw base::ConfigError(fmt::format("{}: is empty, wanted XML; name another file", path));
    }
    if (document.Error()) {
      throw base::ConfigError(fmt::format("{}:{}: not well-formed XML ({}); correct it there", path,
                                          document.ErrorLineNum(), document.ErrorName()));
    }
    XmlFileInventory& file = inventory_[path];
    const tinyxml2::XMLElement* root = document.RootElement();
    if (root == nullptr) return;
    file.root = root->Name();
    if (const char* version = root->Attribute("version")) file.version = version;
    VisitElement(*root, path, 1, &file.elements);
  }

  const XmlInventory& inventory() const { return inventory_; }
  const MissingFiles& missing() const { return missing_; }

 private:
  void CheckIncludes(const std::string& path) const {
    if (std::find(open_files_.begin(), open_files_.end(), path) != open_files_.end()) {
      throw base::ConfigError(fmt::format("{}: includes itself ({} -> {}); break the circle",
                                          open_files_.front(), base::Join(open_files_, " -> "),
                                          path));
    }
    if (static_cast<int>(open_files_.size()) > limits_.max_include_depth) {
      throw base::ConfigError(fmt::format("{}: files include files more than {} deep; flatten them",
                                          open_files_.front(), limits_.max_include_depth));
    }
  }

  void VisitElement(const tinyxml2::XMLElement& element, const std::string& path, int depth,
                    std::set<std::string>* names) {
    const std::string place = fmt::format("{}:{}", path, element.GetLineNum());
    if (depth > limits_.max_element_depth) {
      throw base::ConfigError(fmt::format("{}: elements nest more than {} deep; flatten them",
                                          place, limits_.max_element_depth));
    }
    if (++num_elements_ > limits_.max_elements) {
      throw base::ConfigError(
          fmt::format("{}: more than {} elements, includes counted; split the world or replace "
                      "many bodies by a mesh",
                      place, limits_.max_elements));
    }
    names->insert(element.Name());
    if (finder_ != nullptr && element.Name() == std::string("include")) Include(element, place);
    if (finder_ != nullptr && element.Name() == std::string("mesh")) LookForMesh(element, path);
    for (const auto* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      VisitElement(*child, path, depth + 1, names);
    }
  }

  void Include(const tinyxml2::XMLElement& include, const std::string& place) {
    const auto* uri = include.FirstChildElement("uri");
    if (uri == nullptr || uri->GetText() == nullptr) {
      throw base::ConfigError(
          fmt::format("{}: <include> has no <uri>; add <uri>model://name</uri>", place));
    }
    std::string file;
    try {
      file = finder_->FindModel(uri->GetText(), place);
    } catch (const base::ConfigError& error) {
      missing_.Add(place, error.what());  // to be told with all others
      return;
    }
    VisitFile(file);
  }

  /// Of a collision: meshes that are only looked at are not read.
  void LookForMesh(const tinyxml2::XMLElement& mesh, const std::string& path) {
    const tinyxml2::XMLNode* collision =
        mesh.Parent() == nullptr ? nullptr : mesh.Parent()->Parent();
    const auto* uri = mesh.FirstChildElement("uri");
    if (uri == nullptr || uri->GetText() == nullptr || collision == nullptr ||
        collision->Value() != std::string("collision")) {
      return;
    }
    const std::string place = fmt::format("{}:{}", path, uri->GetLineNum());
    const char* name = collision->ToElement()->Attribute("name");
    const std::string where =
        name == nullptr ? place : fmt::format("{}: collision '{}'", place, name);
    try {
      finder_->FindMesh(uri->GetText(), path, where);
    } catch (const base::ConfigError& error) {
      missing_.Add(place, error.what());
    }
  }

  const ResourceFinder* finder_;  // null: includes are not followed
  XmlLimits limits_;
  int num_elements_{0};
  std::vector<std::string> open_files_;
  XmlInventory inventory_;
  MissingFiles missing_;
};

}  // namespace

void CheckXml(const std::string& text, const std::string& path, const XmlLimits& limits) {
  XmlWalk(nullptr, limits).VisitText(text, path);
}

XmlInventory CheckXmlFile(const std::string& path, const ResourceFinder& finder,
                          const XmlLimits& limits) {
  XmlWalk walk(&finder, limits);
  walk.VisitFile(path);
  walk.missing().ThrowIfAny(path);
  return walk.inventory();
}

}  // namespace hires::world
