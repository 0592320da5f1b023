#include "hires/world/object_catalogue.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

bool IsPlainName(const std::string& name) {
  return !name.empty() && name[0] != '.' && name.find('/') == std::string::npos;
}

bool IsPath(const std::string& name) {
  const std::string ending = base::ToLower(fs::path(name).extension().string());
  return ending == ".sdf" || ending == ".urdf" || name.find('/') != std::string::npos;
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

}  // namespace

std::map<std::string, std::string> LoadObjectCatalogue(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  std::map<std::string, std::string> catalogue;
  std::map<std::string, std::string> seen;  // lower case -> as in the file
  for (const std::string& name : in.Keys()) {
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
  const fs::path models = fs::absolute(catalogue_path).parent_path() / "models";
  const std::map<std::string, std::string> folders = FoldersByLowerName(models);
  const std::string lower = base::ToLower(name_or_path);
  std::string wanted = lower;
  std::vector<std::string> known;
  for (const auto& [instance, folder] : LoadObjectCatalogue(catalogue_path)) {
    known.push_back(instance);
    if (base::ToLower(instance) == lower) wanted = base::ToLower(folder);
  }
  for (const auto& [lower_folder, folder] : folders) known.push_back(folder);
  const auto found = folders.find(wanted);
  if (found != folders.end())
    return LoadObjectModel((models / found->second / "model.sdf").string());
  if (wanted == lower) {
    throw base::ConfigError(
        fmt::format("{}: {}", catalogue_path, base::UnknownName("object", name_or_path, known)));
  }
  throw base::ConfigError(fmt::format("{}: {} stands for a model that is not there: {}",
                                      catalogue_path, name_or_path,
                                      base::UnknownName("folder", wanted, known)));
}

}  // namespace hires::world
