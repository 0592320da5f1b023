#include "world/quick_sdf.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <sdf/InterfaceElements.hh>
#include <sdf/Param.hh>
#include <sdf/parser.hh>

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

bool IsKnownVersion(const XmlFileInventory& file) {
  static const std::set<std::string> known{"1.6", "1.7", "1.8", "1.9"};
  return file.root == "sdf" && known.count(file.version) > 0;
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

/// Has it only what PutInPlace knows how to carry over?
bool IsPlain(const sdf::ElementPtr& include) {
  const std::set<std::string> known{"uri", "name", "pose", "static"};
  const auto& attributes = include->GetAttributes();
  const std::vector<sdf::ElementPtr> children = ChildrenOf(include);
  return std::none_of(attributes.begin(), attributes.end(),
                      [](const sdf::ParamPtr& attribute) { return attribute->GetSet(); }) &&
         std::all_of(children.begin(), children.end(), [&](const sdf::ElementPtr& child) {
           return known.count(child->GetName()) > 0;
         });
}

/// The included `model` under the name, pose and <static> of its <include>.
sdf::ElementPtr PutInPlace(const sdf::ElementPtr& model, const sdf::ElementPtr& include) {
  sdf::ElementPtr placed = model->Clone();
  placed->SetIncludeElement(include);
  if (include->HasElement("name")) {
    placed->GetAttribute("name")->SetFromString(include->Get<std::string>("name"));
  }
  for (const char* part : {"pose", "static"}) {
    if (include->HasElement(part)) placed->GetElement(part)->Copy(include->GetElement(part));
  }
  return placed;
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

QuickReader::QuickReader(const ResourceFinder& finder, const XmlInventory& inventory)
    : finder_(finder), inventory_(inventory) {
  config_.SetFindCallback(
      [this](const std::string& uri) { return finder_.FindModel(uri, uri) + kLeaveForLater; });
  // With such a parser, libsdformat leaves <include> elements alone whose file has a foreign
  // ending. It would be called by sdf::Root::Load; by then no <include> is left.
  config_.RegisterCustomModelParser(
      [](const sdf::NestedInclude&, sdf::Errors&) -> sdf::InterfaceModelPtr { return nullptr; });
}

sdf::SDFPtr QuickReader::Read(const std::string& path) {
  const auto read = [&](const sdf::SDFPtr& document, sdf::Errors* errors) {
    return sdf::readFile(path, config_, document, *errors);
  };
  return ReadBy(read, path);
}

sdf::SDFPtr QuickReader::ReadPart(const std::string& text, const std::string& path) {
  const auto read = [&](const sdf::SDFPtr& document, sdf::Errors* errors) {
    if (!sdf::readString(text, config_, document, *errors)) return false;
    SetFilePath(document->Root(), path);
    return true;
  };
  return ReadBy(read, path);
}

sdf::SDFPtr QuickReader::ReadBy(const ReadInto& read, const std::string& path) {
  const auto file = inventory_.find(path);
  if (file == inventory_.end() || !IsKnownVersion(file->second)) return nullptr;
  const auto document = std::make_shared<sdf::SDF>();
  document->Root(SchemaFor(file->second.elements)->Clone());
  sdf::Errors errors;
  if (!read(document, &errors) || !errors.empty()) return nullptr;
  return ResolveIncludes(document->Root()) ? document : nullptr;
}

bool QuickReader::ResolveIncludes(const sdf::ElementPtr& parent) {
  const std::vector<sdf::ElementPtr> children = ChildrenOf(parent);
  const auto is_include = [](const auto& child) { return child->GetName() == "include"; };
  if (std::any_of(children.begin(), children.end(), is_include)) {
    return ReplaceIncludes(parent, children);
  }
  return std::all_of(children.begin(), children.end(),
                     [this](const auto& child) { return ResolveIncludes(child); });
}

/// Keeps the order, as names of kinds of objects depend on it.
bool QuickReader::ReplaceIncludes(const sdf::ElementPtr& parent,
                                  const std::vector<sdf::ElementPtr>& children) {
  for (const sdf::ElementPtr& child : children) parent->RemoveChild(child);
  for (const sdf::ElementPtr& child : children) {
    const bool is_include = child->GetName() == "include";
    const sdf::ElementPtr wanted = is_include ? Included(child) : child;
    if (wanted == nullptr || (!is_include && !ResolveIncludes(child))) return false;
    Insert(wanted, parent);
  }
  return true;
}

sdf::ElementPtr QuickReader::Included(const sdf::ElementPtr& include) {
  if (!IsPlain(include)) return nullptr;
  const std::string uri = include->Get<std::string>("uri");
  const sdf::ElementPtr model = ModelIn(finder_.FindModel(uri, uri));
  return model == nullptr ? nullptr : PutInPlace(model, include);
}

sdf::ElementPtr QuickReader::ModelIn(const std::string& path) {
  const auto [known, is_new] = documents_.emplace(path, nullptr);
  if (is_new) known->second = Read(path);
  if (known->second == nullptr) return nullptr;
  const std::vector<sdf::ElementPtr> top = ChildrenOf(known->second->Root());
  return top.size() == 1 && top[0]->GetName() == "model" ? top[0] : nullptr;
}

}  // namespace hires::world
