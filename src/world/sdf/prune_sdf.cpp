#include "world/sdf/prune_sdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sdf/SDFImpl.hh>
#include <set>

#include "base/trimmed.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "world/sdf/check_values.h"
#include "world/sdf/mend_collisions.h"
#include "world/sdf/state_notes.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

/// What is done with the children of an element, by their names; others are no SDF.
struct Rule {
  std::set<std::string> kept;
  std::set<std::string> unsaid;  ///< left out without a word
};

const std::map<std::string, Rule>& Rules() {
  static const std::map<std::string, Rule> rules{
      {"sdf", {{"world", "model"}, {"light"}}},
      {"world",
       {{"model", "frame", "include", "gravity"},
        {"light", "physics", "scene", "gui", "plugin", "audio", "wind", "magnetic_field",
         "atmosphere", "spherical_coordinates", "road", "particle_emitter", "projector", "sensor",
         "pose", "static"}}},
      {"model",
       {{"static", "link", "joint", "model", "include", "frame", "pose"},
        {"plugin", "gripper", "self_collide", "allow_auto_disable", "enable_wind", "sensor",
         "light", "visual"}}},
      {"link",
       {{"pose", "collision"},
        {"sensor", "light", "enable_wind", "self_collide", "must_be_base_link", "velocity_decay",
         "audio_sink", "audio_source", "battery", "projector", "particle_emitter", "plugin",
         "damping"}}},
      {"collision",
       {{"pose", "geometry", "surface"},
        {"laser_retro", "max_contacts", "auto_inertia_params", "mass", "plugin", "material"}}},
      {"mesh", {{"uri", "scale", "submesh"}, {"convex_decomposition", "filename"}}},
      {"frame", {{"pose"}, {}}},
      {"include", {{"uri", "name", "pose", "static", "placement_frame"}, {"plugin"}}},
      {"joint", {{"parent", "child", "pose"}, {}}},
      {"surface", {{"friction", "bounce"}, {}}},
      {"friction", {{"ode"}, {}}},
      {"ode", {{"mu", "mu2"}, {}}},
      {"bounce", {{"restitution_coefficient"}, {}}},
  };
  return rules;
}

/// Parents whose other children are values for some engine or other, and no things in the world.
bool HasOnlyValues(const std::string& parent) {
  static const std::set<std::string> parents{"joint", "surface", "friction", "ode", "bounce"};
  return parents.count(parent) > 0;
}

bool IsTrue(const std::string& text) { return text == "1" || base::ToLower(text) == "true"; }

XMLElement* Insert(const char* name, const std::string& text, XMLElement* parent) {
  XMLElement* element = parent->GetDocument()->NewElement(name);
  if (!text.empty()) element->SetText(text.c_str());
  parent->InsertEndChild(element);
  return element;
}

void SetTextOf(const char* child, const std::string& text, XMLElement* parent) {
  if (XMLElement* element = parent->FirstChildElement(child)) element->SetText(text.c_str());
}

class Pruner {
 public:
  Pruner(const std::string& path, SdfFile* file, LoadNotes* notes)
      : path_(path), file_(file), notes_(notes) {}

  void PruneAll(XMLElement* root) {
    CollectCountedFrom(*root);
    Prune(root);
  }

 private:
  void Prune(XMLElement* parent) {
    Prepare(parent);
    const auto rule = Rules().find(parent->Name());
    XMLElement* next = nullptr;
    for (XMLElement* child = parent->FirstChildElement(); child != nullptr; child = next) {
      next = child->NextSiblingElement();
      if (rule == Rules().end() || Stays(*child, *parent, rule->second)) {
        Prune(child);
      } else {
        parent->DeleteChild(child);
      }
    }
    FillEmptyModel(parent);
  }

  std::string PlaceOf(const XMLElement& element) const {
    const char* name = element.Attribute("name");
    return fmt::format("{}:{}{}", path_, element.GetLineNum(),
                       name == nullptr ? "" : fmt::format(" '{}'", name));
  }

  bool Stays(const XMLElement& child, const XMLElement& parent, const Rule& rule) {
    const std::string name = child.Name();
    if (name.find(':') != std::string::npos) {
      if (parent.Name() == std::string("include") && name == "experimental:params")
        notes_->Add("include", "whose <experimental:params> are left out", PlaceOf(parent));
      return name.rfind(kShapePrefix, 0) == 0;
    }
    if (IsUselessJoint(child, parent)) return false;
    if (IsSecond(child, parent)) return false;
    if (IsLeftBesideWorld(child, parent)) return false;
    if (rule.kept.count(name) > 0) return true;
    if (rule.unsaid.count(name) == 0 && !HasOnlyValues(parent.Name()))
      SayLeftOut(child, parent, rule);
    return false;
  }

  /// Of what stands still joints say nothing, be it that poses count from them.
  bool IsUselessJoint(const XMLElement& child, const XMLElement& parent) const {
    const char* name = child.Attribute("name");
    if (child.Name() != std::string("joint") || parent.Name() != std::string("model")) return false;
    return IsInStatic(parent) && counted_from_.count(name == nullptr ? "" : name) == 0;
  }

  static bool IsInStatic(const XMLElement& model) {
    for (const auto* at = &model; at != nullptr && at->Name() == std::string("model");
         at = at->Parent()->ToElement()) {
      if (IsTrue(TrimmedText(at->FirstChildElement("static")))) return true;
    }
    return false;
  }

  /// What there is one of, as libsdformat takes it.
  bool IsSecond(const XMLElement& child, const XMLElement& parent) {
    static const std::set<std::string> single{"pose", "static", "surface", "uri", "scale"};
    const std::string name = child.Name();
    if (single.count(name) == 0 || child.PreviousSiblingElement(child.Name()) == nullptr)
      return false;
    notes_->Add("element",
                fmt::format("<{}> more in a <{}> left out: the first counts", name, parent.Name()),
                PlaceOf(child));
    return true;
  }

  /// By a slip, behind </world>. One model stays, as the file may be an object's.
  bool IsLeftBesideWorld(const XMLElement& child, const XMLElement& parent) {
    const std::string name = child.Name();
    if (parent.Name() != std::string("sdf") || parent.FirstChildElement("world") == nullptr)
      return false;
    if (name == "model") {
      file_->models_beside_world.push_back(PlaceOf(child));
      return file_->models_beside_world.size() > 1;
    }
    if (name != "include" && name != "frame" && name != "joint") return false;
    NoteBesideWorld(name, PlaceOf(child), notes_);
    return true;
  }

  void CollectCountedFrom(const XMLElement& element) {
    for (const char* attribute : {"relative_to", "attached_to"}) {
      const char* written = element.Attribute(attribute);
      const std::string name = written == nullptr ? "" : written;
      if (!name.empty()) counted_from_.insert(name.substr(name.rfind(':') + 1));
    }
    for (const auto* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      CollectCountedFrom(*child);
    }
  }

  void SayLeftOut(const XMLElement& child, const XMLElement& parent, const Rule& rule) {
    const std::string name = child.Name(), within = parent.Name();
    if (name == "actor") {
      notes_->Add("actor", "left out: nobody walks, and nobody stands in a robot's way",
                  PlaceOf(child));
    } else if (name == "population") {
      const int count =
          std::max(1, std::atoi(TrimmedText(child.FirstChildElement("model_count")).c_str()));
      notes_->Add("model", "of a <population> left out, as where they stand is left to chance",
                  PlaceOf(child), count);
    } else if (within == "world" && name == "joint") {
      AddWorldJoint(child);
    } else if (within == "world" && name == "state") {
      NoteState(child, parent, path_, notes_);
    } else {
      std::vector<std::string> known(rule.kept.begin(), rule.kept.end());
      const std::vector<std::string> likely =
          name == "origin" ? std::vector<std::string>{"pose"} : base::LikelyNames(name, known);
      notes_->Add("element",
                  fmt::format("<{}> in <{}> left out, as SDF knows none there{}", name, within,
                              likely.empty() ? "" : " (was <" + likely.front() + "> meant?)"),
                  PlaceOf(child));
    }
  }

  void AddWorldJoint(const XMLElement& joint) {
    const char* type = joint.Attribute("type");
    file_->world_joints.push_back({TrimmedText(joint.FirstChildElement("parent")),
                                   TrimmedText(joint.FirstChildElement("child")),
                                   type != nullptr && type == std::string("fixed"),
                                   PlaceOf(joint)});
  }

  /// What is to be put otherwise before children are judged.
  void Prepare(XMLElement* element) {
    const std::string name = element->Name();
    TakeOldOrigin(element);
    CheckValueOf(element, path_, notes_);
    if (name == "sdf") TakeVersion(element);
    if (name == "pose") TakeOldFrame(element);
    if (name == "world") TakeOldGravity(element);
    if (name == "link") {
      MendCollisions(element, path_, notes_);
      PrepareLink(element);
    }
    if (name == "collision") {
      if (XMLElement* density = element->FirstChildElement("density")) density->SetName(kDensity);
    }
    if (name == "geometry") PrepareGeometry(element);
    if (name == "joint") PrepareJoint(element);
    if (name == "mesh") {
      element->DeleteAttribute("optimization");
      SetTextOf("uri", TrimmedText(element->FirstChildElement("uri")), element);
    }
    if (name == "include") {
      for (const char* child : {"uri", "name"})
        SetTextOf(child, TrimmedText(element->FirstChildElement(child)), element);
      const char* merge = element->Attribute("merge");
      if (merge != nullptr && IsTrue(merge)) Insert(kMerged, "", element);
      element->DeleteAttribute("merge");
    }
  }

  void TakeVersion(XMLElement* root) {
    const char* written = root->Attribute("version");
    file_->version = written == nullptr ? "" : written;
    if (file_->version.empty()) {
      notes_->Add("file", "without a version of SDF read as " + sdf::SDF::Version(), path_);
      file_->version = sdf::SDF::Version();
      root->SetAttribute("version", file_->version.c_str());
    }
    int minor = 0, newest = 0;
    char more = 0;
    if (std::sscanf(file_->version.c_str(), "1.%d%c", &minor, &more) != 1) return;
    if (std::sscanf(sdf::SDF::Version().c_str(), "1.%d", &newest) != 1 || minor <= newest) return;
    notes_->Add("file", fmt::format("of SDF {} read as {}", file_->version, sdf::SDF::Version()),
                path_);
    file_->version = sdf::SDF::Version();
    root->SetAttribute("version", file_->version.c_str());
  }

  /// Up to SDF 1.2 poses stand in an attribute.
  static void TakeOldOrigin(XMLElement* element) {
    XMLElement* origin = element->FirstChildElement("origin");
    const char* pose = origin == nullptr ? nullptr : origin->Attribute("pose");
    if (pose == nullptr || element->FirstChildElement("pose") != nullptr) return;
    origin->SetName("pose");
    origin->SetText(std::string(pose).c_str());
    origin->DeleteAttribute("pose");
  }

  /// Up to SDF 1.6 poses count from a `frame`, which libsdformat turns into relative_to; later it
  /// passes the attribute over, and warns of each.
  void TakeOldFrame(XMLElement* pose) {
    const char* frame = pose->Attribute("frame");
    if (frame == nullptr || IsUpTo(6)) return;
    if (*frame != '\0') {
      notes_->Add(
          "pose",
          "whose attribute frame is passed over, as SDF has none from 1.7 on: it counts from "
          "its relative_to, else from what it stands in (write relative_to if it is meant)",
          PlaceOf(*pose));
    }
    pose->DeleteAttribute("frame");
  }

  bool IsUpTo(int last_minor) const {
    int minor = 0;
    return std::sscanf(file_->version.c_str(), "1.%d", &minor) == 1 && minor <= last_minor;
  }

  /// Up to SDF 1.5 gravity stands in <physics>.
  void TakeOldGravity(XMLElement* world) const {
    if (!IsUpTo(5)) return;
    const XMLElement* physics = world->FirstChildElement("physics");
    const XMLElement* gravity =
        physics == nullptr ? nullptr : physics->FirstChildElement("gravity");
    if (gravity != nullptr && world->FirstChildElement("gravity") == nullptr)
      Insert("gravity", TrimmedText(gravity), world);
  }

  static void PrepareLink(XMLElement* link) {
    bool is_seen = false, floats = false;
    XMLElement* next = nullptr;
    for (XMLElement* child = link->FirstChildElement(); child != nullptr; child = next) {
      next = child->NextSiblingElement();
      const std::string name = child->Name();
      is_seen = is_seen || name == "visual";
      floats = floats || (name == "gravity" && !IsTrue(TrimmedText(child))) ||
               (name == "kinematic" && IsTrue(TrimmedText(child)));
      if (name == "inertial") child->SetName(kInertial);
      if (name == "visual" || name == "gravity" || name == "kinematic") link->DeleteChild(child);
    }
    if (is_seen) Insert(kVisual, "", link);
    if (floats) Insert(kFloats, "", link);
  }

  /// Shapes that libsdformat does not know in all versions are read by ShapesOf.
  static void PrepareGeometry(XMLElement* geometry) {
    static const std::set<std::string> own{"box", "cylinder", "sphere", "plane", "mesh", "empty"};
    bool is_other = false;
    for (XMLElement* child = geometry->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string name = child->Name();
      if (own.count(name) > 0 || name.find(':') != std::string::npos) continue;
      child->SetName((kShapePrefix + name).c_str());
      is_other = true;
    }
    if (is_other && geometry->FirstChildElement("empty") == nullptr) Insert("empty", "", geometry);
  }

  /// Where things stand at joint zero does not depend on what a joint lets move.
  static void PrepareJoint(XMLElement* joint) {
    const char* type = joint->Attribute("type");
    Insert(kJointType, type == nullptr ? "" : type, joint);
    joint->SetAttribute("type", "fixed");
    XMLElement* parent = joint->FirstChildElement("parent");
    XMLElement* child = joint->FirstChildElement("child");
    if (parent != nullptr &&
        TrimmedText(child) == "world") {  // the same joint, the other way round
      child->SetText(TrimmedText(parent).c_str());
      parent->SetText("world");
    }
  }

  const std::string& path_;
  SdfFile* file_;
  LoadNotes* notes_;
  std::set<std::string> counted_from_;  // last parts of names that poses and frames give
};

}  // namespace

std::string TrimmedText(const XMLElement* element) {
  const char* text = element == nullptr ? nullptr : element->GetText();
  return text == nullptr ? "" : base::Trimmed(text);
}

std::string NameOfPart(const XMLElement& part, const FileOfInclude& file_of) {
  if (part.Name() == std::string("include")) {
    const std::string own = TrimmedText(part.FirstChildElement("name"));
    return own.empty() ? file_of(part).model_name : own;
  }
  const char* name = part.Attribute("name");
  return name == nullptr ? "" : name;
}

void FillEmptyModel(XMLElement* model) {
  if (model->Name() != std::string("model")) return;
  for (const char* part : {"link", "model", "include"}) {
    if (model->FirstChildElement(part) != nullptr) return;
  }
  Insert("link", "", model)->SetAttribute("name", "hires_nothing");
}

void NoteBesideWorld(const std::string& element, const std::string& place, LoadNotes* notes) {
  notes->Add("element",
             fmt::format("<{}> beside <world> left out, as it stands in no world (move it into "
                         "<world>)",
                         element),
             place);
}

void PruneSdf(XMLElement* root, const std::string& path, SdfFile* file, LoadNotes* notes) {
  Pruner(path, file, notes).PruneAll(root);
  for (const auto* top = root->FirstChildElement(); top != nullptr;
       top = top->NextSiblingElement()) {
    file->num_worlds += top->Name() == std::string("world") ? 1 : 0;
    if (top->Name() != std::string("model")) continue;
    const char* name = top->Attribute("name");
    if (++file->num_models == 1 && name != nullptr) file->model_name = name;
  }
}

}  // namespace hires::world
