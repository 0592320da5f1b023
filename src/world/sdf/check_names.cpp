#include "world/sdf/check_names.h"

#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <set>
#include <vector>

#include "hires/base/short_text.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "world/sdf/prune_sdf.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

class NamesChecker {
 public:
  NamesChecker(XMLElement* scope, const std::string& path, const FileOfInclude& file_of,
               LoadNotes* notes)
      : scope_(scope), path_(path), file_of_(file_of), notes_(notes) {}

  void CheckEqualNames() {
    for (XMLElement* child = scope_->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string kind = KindOf(*child), name = NameOf(*child);
      if (!name.empty()) names_.insert(name);
      is_open_ = is_open_ || child->FirstChildElement(kMerged) != nullptr;
      if (kind.empty() || name.empty()) continue;
      const auto [first, is_new] = lines_.emplace(std::make_pair(kind, name), child->GetLineNum());
      if (is_new) continue;
      notes_->AddProblem(fmt::format(
          "{}:{}: {} '{}' has the name of another, in line {}; {}", path_, child->GetLineNum(),
          kind, name, first->second,
          child->Name() == std::string("include") ? "give it a <name> of its own" : "rename one"));
      Rename(name, child);
    }
  }

  /// A joint whose ends are not there becomes a kBrokenJoint with the reason, for libsdformat
  /// would refuse the whole file for it.
  void CheckJoints() {
    if (is_open_) return;  // a merged model brings names
    for (XMLElement* child = scope_->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (child->Name() != std::string("joint")) continue;
      for (const char* end : {"parent", "child"}) TakeFirstLink(child->FirstChildElement(end));
      const std::string why = WhyBroken(*child);
      if (why.empty()) continue;
      const std::string name = NameOf(*child);
      names_.erase(name);
      child->DeleteChildren();
      child->SetName(kBrokenJoint);
      child->SetText(base::Shortened(fmt::format("with a joint {}{}",
                                                 name.empty() ? "" : "'" + name + "' ", why))
                         .c_str());  // a name may be a file long
      child->SetAttribute(kPlace, fmt::format("{}:{}", path_, child->GetLineNum()).c_str());
    }
  }

  void CheckWhatPosesCountFrom() {
    if (is_open_) return;  // a merged model brings names
    for (XMLElement* child = scope_->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      Check(child, "attached_to");
      CheckPose(child);
      if (child->Name() != std::string("link")) continue;
      for (XMLElement* part = child->FirstChildElement(); part != nullptr;
           part = part->NextSiblingElement()) {
        CheckPose(part);
      }
    }
  }

 private:
  static std::string KindOf(const XMLElement& element) {
    const std::string name = element.Name();
    if (name == "include") return "model";
    return name == "link" || name == "model" || name == "joint" || name == "frame" ? name : "";
  }

  std::string NameOf(const XMLElement& part) const { return NameOfPart(part, file_of_); }

  static void Rename(const std::string& name, XMLElement* element) {
    const std::string other = fmt::format("{}_of_line_{}", name, element->GetLineNum());
    if (element->Name() != std::string("include")) {
      element->SetAttribute("name", other.c_str());
      return;
    }
    XMLElement* own = element->FirstChildElement("name");
    if (own == nullptr) {
      own = element->GetDocument()->NewElement("name");
      element->InsertEndChild(own);
    }
    own->SetText(other.c_str());
  }

  /// For the model's own frame, which lies on its canonical link, as libsdformat takes no such end.
  void TakeFirstLink(XMLElement* end) const {
    if (TrimmedText(end) != "__model__") return;
    const char* canonical = scope_->Attribute("canonical_link");
    const std::vector<std::string> links = LinksIn(*scope_);
    if (canonical == nullptr && links.empty()) return;
    end->SetText(canonical != nullptr ? canonical : links.front().c_str());
  }

  /// Reads after "with a joint 'hinge' "; "" if both ends are there.
  std::string WhyBroken(const XMLElement& joint) const {
    std::string ends[2];
    for (const bool is_child : {false, true}) {
      const char* end = is_child ? "child" : "parent";
      std::string& name = ends[is_child];
      name = TrimmedText(joint.FirstChildElement(end));
      if (name.empty()) return fmt::format("without a <{}>", end);
      if (!IsThere(name, *scope_)) {
        const bool is_told = scope_->FirstChildElement(kBrokenJoint) == nullptr;  // the first is
        const std::vector<std::string> likely =
            base::LikelyNames(name, is_told ? LinksIn(*scope_) : std::vector<std::string>());
        return fmt::format("whose <{}> '{}' is not there{}", end, name,
                           likely.empty() ? "" : " (was '" + likely.front() + "' meant?)");
      }
    }
    return ends[0] == ends[1] ? fmt::format("from '{0}' to '{0}' itself", ends[0]) : "";
  }

  /// What joints connect: links, models, frames, and what is in models ("cabinet::box").
  bool IsThere(const std::string& name, const XMLElement& scope) const {
    if (name == "world" || name.rfind("__", 0) == 0) return true;
    if (&scope == scope_ && names_.count(name) > 0) return true;
    const std::size_t cut = name.find("::");
    const std::string first = name.substr(0, cut);
    for (const auto* child = scope.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (child->FirstChildElement(kMerged) != nullptr) return true;  // brings names
      const std::string own = NameOf(*child);
      if (own == name) return true;
      if (cut == std::string::npos || own != first) continue;
      return IsIn(*child, name.substr(cut + 2));
    }
    return false;
  }

  /// @param name  as joints inside of that model would name it.
  bool IsIn(const XMLElement& model, const std::string& name) const {
    if (model.Name() == std::string("model")) return IsThere(name, model);
    if (model.Name() != std::string("include") || name.find("::") != std::string::npos) return true;
    const std::set<std::string>& parts = file_of_(model).part_names;
    return parts.empty() || parts.count(name) > 0 || name.rfind("__", 0) == 0;
  }

  static std::vector<std::string> LinksIn(const XMLElement& model) {
    std::vector<std::string> names;
    for (const auto* link = model.FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      if (const char* name = link->Attribute("name")) names.push_back(name);
    }
    return names;
  }

  void CheckPose(XMLElement* element) {
    if (XMLElement* pose = element->FirstChildElement("pose")) Check(pose, "relative_to");
  }

  void Check(XMLElement* element, const char* attribute) {
    const char* written = element->Attribute(attribute);
    const std::string whole = written == nullptr ? "" : written;
    const std::string name = whole.substr(0, whole.find("::"));
    const bool is_reserved = name == "world" || name.rfind("__", 0) == 0;
    if (name.empty() || is_reserved || names_.count(name) > 0) return;
    notes_->AddProblem(fmt::format(
        "{}:{}: {} of a <{}>: {}", path_, element->GetLineNum(), attribute, element->Name(),
        base::UnknownName("name", name, {names_.begin(), names_.end()})));
    element->DeleteAttribute(attribute);
  }

  XMLElement* scope_;
  const std::string& path_;
  const FileOfInclude& file_of_;
  LoadNotes* notes_;
  std::set<std::string> names_;
  bool is_open_{false};
  std::map<std::pair<std::string, std::string>, int> lines_;  // by kind and name
};

}  // namespace

void CheckNames(XMLElement* scope, const std::string& path, const std::string& version,
                const FileOfInclude& file_of, LoadNotes* notes) {
  const std::string kind = scope->Name();
  if (kind != "world" && kind != "model") return;
  NamesChecker checker(scope, path, file_of, notes);
  checker.CheckEqualNames();
  if (kind == "model") checker.CheckJoints();
  int minor = 0;
  constexpr int kFirst = 7;  // SDF 1.7 has relative_to
  if (std::sscanf(version.c_str(), "1.%d", &minor) == 1 && minor >= kFirst)
    checker.CheckWhatPosesCountFrom();
}

}  // namespace hires::world
