#include "world/world_parts.h"

#include <tinyxml2.h>

#include <algorithm>
#include <set>

#include "world/sdf/line_printer.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

std::string AttributeOf(const XMLElement* element, const char* name) {
  const char* value = element == nullptr ? nullptr : element->Attribute(name);
  return value == nullptr ? "" : value;
}

bool IsModel(const XMLElement& element) {
  const std::string name = element.Name();
  return name == "model" || name == "include";
}

/// "" where an <include> leaves its name to the file.
std::string NameOf(const XMLElement& model) {
  if (model.Name() == std::string("model")) return AttributeOf(&model, "name");
  const XMLElement* name = model.FirstChildElement("name");
  return name == nullptr || name->GetText() == nullptr ? "" : name->GetText();
}

/// "" for the world, which is in every part.
std::string UnlessWorld(const std::string& name) { return name == "world" ? "" : name; }

std::string CountsFrom(const XMLElement& element) {
  return UnlessWorld(AttributeOf(element.FirstChildElement("pose"), "relative_to"));
}

/// What poses of models and frames count from, by the model's name.
std::set<std::string> NamedByOthers(const XMLElement& world) {
  std::set<std::string> names;
  for (const auto* child = world.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    for (const std::string& name :
         {CountsFrom(*child), UnlessWorld(AttributeOf(child, "attached_to"))}) {
      if (!name.empty()) names.insert(name.substr(0, name.find("::")));
    }
  }
  return names;
}

bool StandsAlone(const XMLElement& model, const std::set<std::string>& named) {
  const std::string name = NameOf(model);
  const bool may_be_named = named.count(name) > 0 || (name.empty() && !named.empty());
  return CountsFrom(model).empty() && !may_be_named;
}

class Cutter {
 public:
  Cutter(const XMLElement& root, const XMLElement& world) : root_(root), world_(world) {
    const std::set<std::string> named = NamedByOthers(world);
    std::size_t place = 0;
    for (const auto* child = world.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (!IsModel(*child)) continue;
      (StandsAlone(*child, named) ? alone_ : joined_).push_back({child, place++});
    }
  }

  std::size_t num_alone() const { return alone_.size(); }

  WorldPart FirstPart() const {
    WorldPart part;
    for (const Model& model : joined_) part.places.push_back(model.place);
    std::set<const XMLElement*> elsewhere;
    for (const Model& model : alone_) elsewhere.insert(model.element);
    LineKeepingPrinter out;
    out.Open(root_);
    for (const auto* top = root_.FirstChildElement(); top != nullptr;
         top = top->NextSiblingElement()) {
      if (top != &world_) {
        top->Accept(&out);
        continue;
      }
      out.Open(world_);
      for (const auto* child = world_.FirstChildElement(); child != nullptr;
           child = child->NextSiblingElement()) {
        if (elsewhere.count(child) == 0) child->Accept(&out);
      }
      out.CloseElement(true);
    }
    out.CloseElement(true);
    part.text = out.CStr();
    return part;
  }

  WorldPart Part(std::size_t begin, std::size_t end) const {
    WorldPart part;
    LineKeepingPrinter out;
    out.Open(root_);
    out.Open(world_);
    for (std::size_t i = begin; i < std::min(end, alone_.size()); ++i) {
      alone_[i].element->Accept(&out);
      part.places.push_back(alone_[i].place);
    }
    out.CloseElement(true);
    out.CloseElement(true);
    part.text = out.CStr();
    return part;
  }

 private:
  struct Model {
    const XMLElement* element;
    std::size_t place;
  };
  const XMLElement& root_;
  const XMLElement& world_;
  std::vector<Model> alone_, joined_;
};

/// A joint of the world names models in ways of its own.
bool CanBeCut(const XMLElement* world) {
  return world != nullptr && world->NextSiblingElement("world") == nullptr &&
         world->FirstChildElement("joint") == nullptr;
}

}  // namespace

std::vector<WorldPart> CutWorld(const std::string& text, std::size_t models_per_part) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return {};
  const XMLElement* root = document.RootElement();
  const XMLElement* world = root == nullptr ? nullptr : root->FirstChildElement("world");
  if (!CanBeCut(world)) return {};
  const Cutter cutter(*root, *world);
  if (cutter.num_alone() <= models_per_part) return {};
  std::vector<WorldPart> parts{cutter.FirstPart()};
  for (std::size_t i = 0; i < cutter.num_alone(); i += models_per_part) {
    parts.push_back(cutter.Part(i, i + models_per_part));
  }
  return parts;
}

}  // namespace hires::world
