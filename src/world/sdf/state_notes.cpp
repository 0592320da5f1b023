#include "world/sdf/state_notes.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <vector>

#include "hires/geometry/pose.h"
#include "world/sdf/prune_sdf.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;
using ByName = std::map<std::string, const XMLElement*>;

ByName NamedIn(const XMLElement& parent, const char* kind) {
  ByName named;
  for (const auto* child = parent.FirstChildElement(kind); child != nullptr;
       child = child->NextSiblingElement(kind)) {
    const char* name = child->Attribute("name");
    if (name != nullptr) named.emplace(name, child);
  }
  return named;
}

/// Numbers of a text, those that are missing as `otherwise`.
std::vector<double> NumbersIn(const std::string& text, int count, double otherwise) {
  std::vector<double> numbers(count, otherwise);
  const char* at = text.c_str();
  for (double& number : numbers) {
    char* end = nullptr;
    const double read = std::strtod(at, &end);
    if (end == at) break;
    number = read;
    at = end;
  }
  return numbers;
}

geometry::Pose3 PoseOf(const XMLElement& element) {
  const auto n = NumbersIn(TrimmedText(element.FirstChildElement("pose")), 6, 0.0);
  return {{n[0], n[1], n[2]}, geometry::RotationFromRpy(n[3], n[4], n[5])};
}

bool AreSamePlace(const geometry::Pose3& a, const geometry::Pose3& b) {
  constexpr double kSame = 5e-3;  // [m], [rad]
  return (a.translation - b.translation).cwiseAbs().maxCoeff() <= kSame &&
         a.rotation.angularDistance(b.rotation) <= kSame;
}

bool CountsFromAnother(const XMLElement& element) {
  const XMLElement* pose = element.FirstChildElement("pose");
  if (pose == nullptr) return false;
  for (const char* attribute : {"relative_to", "frame"}) {
    const char* other = pose->Attribute(attribute);
    if (other != nullptr && *other != '\0') return true;
  }
  return false;
}

/// In a <state> poses of links count from the world.
bool HasLinkElsewhere(const XMLElement& state, const XMLElement& written) {
  const bool has_pose = state.FirstChildElement("pose") != nullptr;
  const geometry::Pose3 X_WM = PoseOf(has_pose ? state : written);
  const ByName links = NamedIn(written, "link");
  for (const auto& [name, link] : NamedIn(state, "link")) {
    const auto found = links.find(name);
    if (found == links.end() || link->FirstChildElement("pose") == nullptr) continue;
    if (CountsFromAnother(*found->second) || CountsFromAnother(*link)) continue;
    if (!AreSamePlace(PoseOf(*link), X_WM * PoseOf(*found->second))) return true;
  }
  return false;
}

bool IsScaled(const XMLElement& state) {
  constexpr double kSame = 1e-6;
  for (const double n : NumbersIn(TrimmedText(state.FirstChildElement("scale")), 3, 1.0))
    if (std::abs(n - 1.0) > kSame) return true;
  return false;
}

}  // namespace

void NoteState(const XMLElement& state, const XMLElement& world, const std::string& path,
               LoadNotes* notes) {
  const ByName written = NamedIn(world, "model");
  for (const auto* model = state.FirstChildElement("model"); model != nullptr;
       model = model->NextSiblingElement("model")) {
    const char* name = model->Attribute("name");
    const auto found = written.find(name == nullptr ? "" : name);
    if (found == written.end()) continue;
    const std::string place = fmt::format("{}:{} '{}'", path, model->GetLineNum(), name);
    const bool is_elsewhere = model->FirstChildElement("pose") != nullptr &&
                              !AreSamePlace(PoseOf(*model), PoseOf(*found->second));
    if (is_elsewhere) {
      notes->Add("model",
                 "that <state> has elsewhere: taken where its own <pose> says, the state is left "
                 "out",
                 place);
    }
    if (HasLinkElsewhere(*model, *found->second)) {
      notes->Add("model",
                 "with links that <state> has elsewhere: taken where their own <pose> says, the "
                 "state is left out",
                 place);
    }
    if (IsScaled(*model)) {
      notes->Add("model",
                 "that <state> has in another size (<scale>): taken in the size that is written, "
                 "the state is left out",
                 place);
    }
  }
  for (const char* change : {"insertions", "deletions"}) {
    if (const XMLElement* element = state.FirstChildElement(change))
      notes->Add("element", fmt::format("<{}> in <state> left out", change),
                 fmt::format("{}:{}", path, element->GetLineNum()));
  }
}

}  // namespace hires::world
