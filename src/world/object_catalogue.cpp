#include "hires/world/object_catalogue.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "world/liquid.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

bool IsPlainName(const std::string& name) {
  return !name.empty() && name[0] != '.' && name.find('/') == std::string::npos;
}

bool IsPath(const std::string& name) {
  const std::string ending = base::ToLower(fs::path(name).extension().string());
  return ending == ".sdf" || ending == ".urdf" || ending == ".yaml" ||
         name.find('/') != std::string::npos;
}

/// Model folders that hold an object: those with a model.sdf.
std::map<std::string, std::string> FoldersByLowerName(const fs::path& models) {
  std::map<std::string, std::string> folders;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(models, none)) {
    const std::string name = entry.path().filename().string();
    if (fs::exists(entry.path() / "model.sdf")) folders[base::ToLower(name)] = name;
  }
  return folders;
}

std::string ModelFile(const fs::path& models, const std::string& folder) {
  return (models / folder / "model.sdf").string();
}

fs::path ModelsBeside(const std::string& catalogue_path) {
  return fs::absolute(catalogue_path).parent_path() / "models";
}

/// The model.sdf that an instance of `catalogue` or one of the `folders` stands for.
std::string FindModelFile(const std::string& name, const std::string& catalogue_path,
                          const std::map<std::string, std::string>& catalogue,
                          const std::map<std::string, std::string>& folders) {
  const std::string lower = base::ToLower(name);
  std::string wanted = lower;
  std::vector<std::string> known;
  for (const auto& [instance, folder] : catalogue) {
    known.push_back(instance);
    if (base::ToLower(instance) == lower) wanted = base::ToLower(folder);
  }
  for (const auto& [lower_folder, folder] : folders) known.push_back(folder);
  const auto found = folders.find(wanted);
  if (found != folders.end()) return ModelFile(ModelsBeside(catalogue_path), found->second);
  if (wanted == lower) {
    throw base::ConfigError(
        fmt::format("{}: {}", catalogue_path, base::UnknownName("object", name, known)));
  }
  throw base::ConfigError(fmt::format("{}: {} stands for a model that is not there: {}",
                                      catalogue_path, name,
                                      base::UnknownName("folder", wanted, known)));
}

// What the file says besides instances: of model folders, which concept of the ontology they are,
// and what liquid they hold.
constexpr char kConcepts[] = "concepts", kLiquids[] = "liquids";

/// What the catalogue says of model folders, by lower-case name; it may say nothing.
struct FolderNotes {
  std::map<std::string, std::string> concepts;
  std::map<std::string, Liquid> liquids;
};

FolderNotes LoadFolderNotes(const std::string& catalogue_path,
                            const std::map<std::string, std::string>& folders) {
  FolderNotes notes;
  base::ParamReader in = base::ParamReader::FromFile(catalogue_path);
  for (const char* key : {kConcepts, kLiquids}) {
    if (!in.Has(key)) continue;
    base::ParamReader block = in.Sub(key);
    for (const std::string& folder : block.Keys()) {
      if (folders.count(base::ToLower(folder)) == 0) {
        std::vector<std::string> known;
        for (const auto& one : folders) known.push_back(one.second);
        block.Fail(folder, base::UnknownName("folder", folder, known));
      }
      if (key == kConcepts) {
        notes.concepts[base::ToLower(folder)] = block.GetString(folder);
      } else {
        notes.liquids[base::ToLower(folder)] = ReadLiquid(block.Sub(folder));
      }
    }
  }
  return notes;
}

/// @param file  the model.sdf of a folder.
ObjectModel LoadWithNotes(const std::string& file, const FolderNotes& notes) {
  ObjectModel model = LoadObjectModel(file);
  const std::string folder = base::ToLower(fs::path(file).parent_path().filename().string());
  const auto found = notes.concepts.find(folder);
  if (found != notes.concepts.end()) model.concept_name = found->second;
  const auto liquid = notes.liquids.find(folder);
  if (liquid != notes.liquids.end()) model.liquid = liquid->second;
  return model;
}

}  // namespace

std::map<std::string, std::string> LoadObjectCatalogue(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  std::map<std::string, std::string> catalogue;
  std::map<std::string, std::string> seen;  // lower case -> as in the file
  for (const std::string& name : in.Keys()) {
    if (name == kConcepts || name == kLiquids) continue;
    const std::string folder = in.GetString(name);
    if (!IsPlainName(folder)) in.Fail(name, "wanted the name of a folder in models/");
    const auto [other, is_new] = seen.emplace(base::ToLower(name), name);
    if (!is_new) {
      in.Fail(name,
              fmt::format("and '{}' is there too (case does not count); keep one", other->second));
    }
    catalogue[name] = folder;
  }
  return catalogue;
}

ObjectModel FindObjectModel(const std::string& name_or_path, const std::string& catalogue_path) {
  if (IsPath(name_or_path)) return LoadObjectModel(name_or_path);
  const auto folders = FoldersByLowerName(ModelsBeside(catalogue_path));
  return LoadWithNotes(
      FindModelFile(name_or_path, catalogue_path, LoadObjectCatalogue(catalogue_path), folders),
      LoadFolderNotes(catalogue_path, folders));
}

std::map<std::string, std::shared_ptr<const ObjectModel>> LoadCatalogueModels(
    const std::string& catalogue_path) {
  const std::map<std::string, std::string> catalogue = LoadObjectCatalogue(catalogue_path);
  const std::map<std::string, std::string> folders =
      FoldersByLowerName(ModelsBeside(catalogue_path));
  const FolderNotes notes = LoadFolderNotes(catalogue_path, folders);
  std::map<std::string, std::shared_ptr<const ObjectModel>> by_file, by_instance;
  for (const auto& [instance, folder] : catalogue) {
    const std::string file = FindModelFile(instance, catalogue_path, catalogue, folders);
    std::shared_ptr<const ObjectModel>& model = by_file[file];
    if (model == nullptr) model = std::make_shared<const ObjectModel>(LoadWithNotes(file, notes));
    by_instance[instance] = model;
  }
  return by_instance;
}

}  // namespace hires::world
