#include "world/sdf/pose_chains.h"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "hires/base/error.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

struct Placed {
  std::string relative_to;  ///< in the same world or model, or ""
  int line;
  int depth{0};  ///< of its chain; 0: not known yet
};
using PlacedByName = std::map<std::string, Placed>;

/// The part before "::", which stands beside it.
std::string Named(const XMLElement* element, const char* attribute) {
  const char* value = element == nullptr ? nullptr : element->Attribute(attribute);
  const std::string name = value == nullptr ? "" : value;
  return name.substr(0, name.find("::"));
}

PlacedByName PlacedIn(const XMLElement& parent) {
  PlacedByName placed;
  for (const auto* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string name = Named(child, "name");
    if (name.empty()) continue;
    std::string base = Named(child->FirstChildElement("pose"), "relative_to");
    if (base.empty()) base = Named(child, "attached_to");
    placed.emplace(name, Placed{std::move(base), child->GetLineNum()});
  }
  return placed;
}

/// Goes down from `start` to what is known or counts from nothing, and back.
void FindDepth(PlacedByName::iterator start, PlacedByName* placed) {
  std::vector<Placed*> chain;
  int depth = 0;
  bool is_circle = false;
  for (auto at = start; at != placed->end(); at = placed->find(at->second.relative_to)) {
    depth = at->second.depth;
    is_circle = chain.size() > placed->size();
    if (depth != 0 || is_circle) break;
    chain.push_back(&at->second);
  }
  for (; !chain.empty(); chain.pop_back()) chain.back()->depth = is_circle ? 1 : ++depth;
}

}  // namespace

void CheckPoseChains(const XMLElement& root, const std::string& path, int longest) {
  for (const auto* child = root.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    CheckPoseChains(*child, path, longest);
  }
  const std::string name = root.Name();
  if (name != "world" && name != "model") return;
  PlacedByName placed = PlacedIn(root);
  for (auto at = placed.begin(); at != placed.end(); ++at) {
    if (at->second.depth == 0) FindDepth(at, &placed);
    if (at->second.depth <= longest) continue;
    throw base::ConfigError(fmt::format(
        "{}:{}: the pose of '{}' is relative to a chain of {} others, at most {} are followed; "
        "give it in the world or the model",
        path, at->second.line, at->first, at->second.depth - 1, longest));
  }
}

}  // namespace hires::world
