#include "world/quick_sdf.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <sdf/Error.hh>
#include <sdf/InterfaceElements.hh>
#include <sdf/Param.hh>
#include <sdf/parser.hh>

#include "world/sdf/prune_sdf.h"

namespace hires::world {
namespace {

/// Parts of the schema that are large, optional, and that libsdformat looks for by HasElement only
/// (it would ask others for their default values).
const std::set<std::string>& LargeOptionalParts() {
  static const std::set<std::string> parts{
      "actor",    "audio_sink", "audio_source", "battery", "gripper",
      "gui",      "heightmap",  "joint",        "light",   "particle_emitter",
      "polyline", "population", "projector",    "road",    "sensor",
      "state",    "visual",     "world"};
  return parts;
}

sdf::ElementPtr FullSchema() {
  static const sdf::ElementPtr schema = [] {
    const auto document = std::make_shared<sdf::SDF>();
    sdf::init(document);
    return document->Root();
  }();
  return schema;
}

bool IsRequired(const sdf::ElementPtr& description) {
  return description->GetRequired() == "1" || description->GetRequired() == "+";
}

/// An element like `full` that describes no children.
sdf::ElementPtr WithoutChildren(const sdf::ElementPtr& full) {
  const auto bare = std::make_shared<sdf::Element>();
  bare->SetName(full->GetName());
  bare->SetRequired(full->GetRequired());
  bare->SetDescription(full->GetDescription());
  bare->SetCopyChildren(full->GetCopyChildren());
  bare->SetReferenceSDF(full->ReferenceSDF());
  for (const sdf::ParamPtr& attribute : full->GetAttributes()) {
    bare->AddAttribute(attribute->GetKey(), attribute->GetTypeName(),
                       attribute->GetDefaultAsString(), attribute->GetRequired(),
                       attribute->GetDescription());
  }
  return bare;
}

/// `full` itself where nothing is to go.
sdf::ElementPtr Trimmed(const sdf::ElementPtr& full, const std::set<std::string>& dropped) {
  bool is_same = true;
  std::vector<sdf::ElementPtr> kept;
  for (unsigned i = 0; i < full->GetElementDescriptionCount(); ++i) {
    const sdf::ElementPtr child = full->GetElementDescription(i);
    const bool goes = dropped.count(child->GetName()) > 0 && !IsRequired(child);
    if (!goes) kept.push_back(Trimmed(child, dropped));
    is_same = is_same && !goes && kept.back() == child;
  }
  if (is_same || full->GetValue() != nullptr) return full;
  const sdf::ElementPtr trimmed = WithoutChildren(full);
  for (const sdf::ElementPtr& child : kept) trimmed->AddElementDescription(child);
  return trimmed;
}

/// What libsdformat converts older files to may have elements that these do not name.
bool IsConverted(const SdfFile& file) {
  static const std::set<std::string> current{"1.6", "1.7", "1.8", "1.9"};
  return current.count(file.version) == 0;
}

std::vector<sdf::ElementPtr> ChildrenOf(const sdf::ElementPtr& element) {
  std::vector<sdf::ElementPtr> children;
  for (auto child = element->GetFirstElement(); child != nullptr; child = child->GetNextElement()) {
    children.push_back(child);
  }
  return children;
}

void Insert(const sdf::ElementPtr& child, const sdf::ElementPtr& parent) {
  child->SetParent(parent);
  parent->InsertElement(child);
}

/// The included `model` under the name, pose and <static> of its <include>.
sdf::ElementPtr PutInPlace(const sdf::ElementPtr& model, const sdf::ElementPtr& include) {
  sdf::ElementPtr placed = model->Clone();
  placed->SetIncludeElement(include);
  if (include->HasElement("name")) {
    placed->GetAttribute("name")->SetFromString(include->Get<std::string>("name"));
  }
  if (include->HasElement("placement_frame")) {
    placed->GetAttribute("placement_frame")
        ->SetFromString(include->Get<std::string>("placement_frame"));
  }
  for (const char* part : {"pose", "static"}) {
    if (include->HasElement(part)) placed->GetElement(part)->Copy(include->GetElement(part));
  }
  return placed;
}

bool IsMerged(const sdf::ElementPtr& include) { return include->HasElement(kMerged); }

/// Names that other elements of a model can name.
std::set<std::string> NamesIn(const sdf::ElementPtr& model) {
  std::set<std::string> names;
  for (const sdf::ElementPtr& child : ChildrenOf(model)) {
    if (child->HasAttribute("name")) names.insert(child->Get<std::string>("name"));
  }
  return names;
}

/// The names that a merged model brings to the model that it is merged into, and the name that it
/// has there, as it stays a model of its own here.
struct MergedNames {
  std::set<std::string> names;
  std::string scope;
};

/// What is called so from the model that it is merged into.
std::string ByScope(const MergedNames& merged, const std::string& name) {
  const bool is_part = merged.names.count(name.substr(0, name.find("::"))) > 0;
  return is_part ? merged.scope + "::" + name : name;
}

/// The same from beside that model.
std::string ByScopeIn(const std::string& model, const MergedNames& merged,
                      const std::string& name) {
  const std::string start = model + "::";
  const bool is_in_it = name.compare(0, start.size(), start) == 0;
  return is_in_it ? start + ByScope(merged, name.substr(start.size())) : name;
}

using Renaming = std::function<std::string(const std::string&)>;

void Rename(const Renaming& renamed, const sdf::ParamPtr& value) {
  if (value == nullptr) return;
  const std::string name = value->GetAsString(), other = renamed(name);
  if (other != name) value->SetFromString(other);
}

/// Of all that names something of a world or model; what stands in a model in it does not, but for
/// the model's own pose.
void RenameIn(const Renaming& renamed, const sdf::ElementPtr& element) {
  for (const char* attribute : {"relative_to", "attached_to", "placement_frame", "canonical_link"})
    Rename(renamed, element->GetAttribute(attribute));
  for (const sdf::ElementPtr& child : ChildrenOf(element)) {
    const std::string name = child->GetName();
    if (name == "parent" || name == "child") Rename(renamed, child->GetValue());
    if (name != "model") {
      RenameIn(renamed, child);
    } else if (child->HasElement("pose")) {
      Rename(renamed, child->GetElement("pose")->GetAttribute("relative_to"));
    }
  }
}

/// Ending of what is left for later by libsdformat.
constexpr char kLeaveForLater[] = ".include";

/// libsdformat knows no file for a text.
void SetFilePath(const sdf::ElementPtr& element, const std::string& path) {
  element->SetFilePath(path);
  for (const sdf::ElementPtr& child : ChildrenOf(element)) SetFilePath(child, path);
}

}  // namespace

sdf::ElementPtr SchemaFor(const std::set<std::string>& elements) {
  static std::mutex mutex;
  static std::map<std::set<std::string>, sdf::ElementPtr> schemas;  // by what was dropped
  std::set<std::string> dropped;
  const std::set<std::string>& parts = LargeOptionalParts();
  std::set_difference(parts.begin(), parts.end(), elements.begin(), elements.end(),
                      std::inserter(dropped, dropped.end()));
  const std::lock_guard<std::mutex> lock(mutex);
  sdf::ElementPtr& schema = schemas[dropped];
  if (schema == nullptr) schema = Trimmed(FullSchema(), dropped);
  return schema;
}

QuickReader::QuickReader(const SdfFiles& files, LoadNotes* notes) : files_(files), notes_(notes) {
  config_.SetFindCallback([](const std::string& uri) { return uri + kLeaveForLater; });
  // With such a parser, libsdformat leaves <include> elements alone whose file has a foreign
  // ending. It would be called by sdf::Root::Load; by then no <include> is left.
  config_.RegisterCustomModelParser(
      [](const sdf::NestedInclude&, sdf::Errors&) -> sdf::InterfaceModelPtr { return nullptr; });
}

sdf::SDFPtr QuickReader::Read(const std::string& path) {
  return ReadPart(files_.at(path).text, path);
}

sdf::SDFPtr QuickReader::ReadPart(const std::string& text, const std::string& path) {
  const SdfFile& file = files_.at(path);
  const auto document = std::make_shared<sdf::SDF>();
  document->Root(SchemaFor(IsConverted(file) ? LargeOptionalParts() : file.elements)->Clone());
  sdf::Errors errors;
  const bool is_read = sdf::readString(text, config_, document, errors);
  AddErrors(errors, path, notes_);
  if (!is_read) return nullptr;
  SetFilePath(document->Root(), path);
  ResolveIncludes(document->Root(), path);
  return document;
}

/// Keeps the order, as names of kinds of objects depend on it.
void QuickReader::ResolveIncludes(const sdf::ElementPtr& parent, const std::string& path) {
  const std::vector<sdf::ElementPtr> children = ChildrenOf(parent);
  const auto is_include = [](const auto& child) { return child->GetName() == "include"; };
  const bool has_include = std::any_of(children.begin(), children.end(), is_include);
  if (has_include) {
    for (const sdf::ElementPtr& child : children) parent->RemoveChild(child);
  }
  for (const sdf::ElementPtr& child : children) {
    if (!is_include(child)) ResolveIncludes(child, path);
    const sdf::ElementPtr wanted = is_include(child) ? Included(child, path) : child;
    if (wanted != nullptr && has_include) Insert(wanted, parent);
  }
  for (const sdf::ElementPtr& child : children) {
    if (is_include(child) && IsMerged(child)) {
      NamePartsOf(child, path, parent);
    } else if (child->GetName() == "model") {
      NamePartsBeside(child, parent);
    }
  }
}

/// Names by their scope what a merged model brings to the model that it is merged into.
void QuickReader::NamePartsOf(const sdf::ElementPtr& include, const std::string& path,
                              const sdf::ElementPtr& parent) {
  const auto& includes = files_.at(path).includes;
  const auto found = includes.find(include->Get<std::string>("uri"));
  const sdf::ElementPtr model = found == includes.end() ? nullptr : ModelIn(found->second);
  if (model == nullptr || parent->GetName() != "model") return;
  const std::string scope = include->HasElement("name") ? include->Get<std::string>("name")
                                                        : model->Get<std::string>("name");
  const MergedNames merged{NamesIn(model), scope};
  RenameIn([&](const std::string& name) { return ByScope(merged, name); }, parent);
  merged_[parent].push_back({merged.names, merged.scope});
}

/// The same for what names them from beside the model that they are merged into.
void QuickReader::NamePartsBeside(const sdf::ElementPtr& model, const sdf::ElementPtr& parent) {
  const auto found = merged_.find(model);
  if (found == merged_.end()) return;
  const std::string name_of_model = model->Get<std::string>("name");
  for (const auto& [names, scope] : found->second) {
    const MergedNames merged{names, scope};
    RenameIn([&](const std::string& name) { return ByScopeIn(name_of_model, merged, name); },
             parent);
  }
}

sdf::ElementPtr QuickReader::Included(const sdf::ElementPtr& include, const std::string& path) {
  const auto& includes = files_.at(path).includes;
  const auto found = includes.find(include->Get<std::string>("uri"));
  const sdf::ElementPtr model = found == includes.end() ? nullptr : ModelIn(found->second);
  return model == nullptr ? nullptr : PutInPlace(model, include);
}

sdf::ElementPtr QuickReader::ModelIn(const std::string& path) {
  const auto [known, is_new] = documents_.emplace(path, nullptr);
  if (is_new) known->second = Read(path);
  if (known->second == nullptr) return nullptr;
  const std::vector<sdf::ElementPtr> top = ChildrenOf(known->second->Root());
  const auto is_model = [](const auto& element) { return element->GetName() == "model"; };
  const auto model = std::find_if(top.begin(), top.end(), is_model);
  return model == top.end() ? nullptr : *model;
}

void AddErrors(const sdf::Errors& errors, const std::string& path, LoadNotes* notes) {
  bool has_echo = false;
  for (const sdf::Error& error : errors) {
    // Each element around a wrong one reports it again, the innermost one first.
    const bool is_echo = error.Message().find("Error reading element") == 0 ||
                         error.Message().find("Failed to load a world") == 0;
    if (is_echo && has_echo) continue;
    has_echo = has_echo || is_echo;
    const bool has_file =
        error.FilePath() && error.FilePath()->find("data-string") == std::string::npos;
    std::string line = has_file ? *error.FilePath() : path;
    if (error.LineNumber()) line += ":" + std::to_string(*error.LineNumber());
    notes->AddProblem(line + ": " + error.Message());
  }
}

}  // namespace hires::world
